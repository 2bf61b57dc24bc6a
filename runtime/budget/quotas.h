/* Quotas: how many points each SuperCluster retains. */
#ifndef T3R_QUOTAS_H
#define T3R_QUOTAS_H

#include "budget.h"

/* Shares the budget among the clusters, whose points and deferred points are counted. The group of all deferred points
 * follows the last cluster and gets what the others don't use. The sum is at most Z even if the counts are wrong. */
void t3r_set_quotas(t3r_cluster *clusters, const t3r_budget_settings *settings);

#endif
