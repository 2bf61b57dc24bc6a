/* Quotas: how many points each SuperCluster retains. */
#ifndef T3R_QUOTAS_H
#define T3R_QUOTAS_H

#include "budget.h"

/* Shares the budget among the clusters, whose points and deferred ones are counted. Behind the last cluster stands the
 * group of all deferred points, which gets what the others leave. The sum is at most Z, whatever the clusters say. */
void t3r_set_quotas(t3r_cluster *clusters, const t3r_budget_settings *settings);

#endif
