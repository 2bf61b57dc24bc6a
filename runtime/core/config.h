/* Whether settings are in range. */
#ifndef T3R_CONFIG_H
#define T3R_CONFIG_H

#include <stdbool.h>

#include "trim3r.h"

/* t3r_config_error() without its texts. */
bool t3r_is_config(const t3r_config *config);

#endif
