/* SPDX-License-Identifier: Apache-2.0 */
/* The settings of an evaluation in words: those that are not the default, for tables and for names of pictures. */
#ifndef TRIM3R_TOOLS_EVALUATION_SETTINGS_H
#define TRIM3R_TOOLS_EVALUATION_SETTINGS_H

#include "reconstruction/reconstruction.h"

#define EVALUATION_SETTINGS_BYTES 160

/* "flying-off gamma-0.5": those that no column of its own tells. "default" where there are none. */
void evaluation_settings_rest(const reconstruction_options *settings, char text[EVALUATION_SETTINGS_BYTES]);

/* "_moment_refine-0_clusters-50_flying-off": all of them; the head where it is `named`. An exit status of cli.h. */
int evaluation_settings_suffix(const reconstruction_options *settings, bool named,
                               char text[EVALUATION_SETTINGS_BYTES]);

#endif
