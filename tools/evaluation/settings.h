/* SPDX-License-Identifier: Apache-2.0 */
/* The settings of an evaluation that are not the default, as text for tables and for picture names. */
#ifndef TRIM3R_TOOLS_EVALUATION_SETTINGS_H
#define TRIM3R_TOOLS_EVALUATION_SETTINGS_H

#include "reconstruction/reconstruction.h"

#define EVALUATION_SETTINGS_BYTES 160

/* Writes "flying-off gamma-0.5": the settings without a column of their own. "default" if there are none. */
void evaluation_settings_rest(const reconstruction_options *settings, char text[EVALUATION_SETTINGS_BYTES]);

/* Writes "_moment_refine-0_clusters-50_flying-off": all non-default settings; the head if it is `named`. Returns an
 * exit status of cli.h. */
int evaluation_settings_suffix(const reconstruction_options *settings, bool named,
                               char text[EVALUATION_SETTINGS_BYTES]);

#endif
