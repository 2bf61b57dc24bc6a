/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes that are fine-tuned on the context views. Both functions return an exit status of cli.h and add to *account
 * what they take. */
#ifndef TRIM3R_TOOLS_RIVALS_TUNED_SCENE_H
#define TRIM3R_TOOLS_RIVALS_TUNED_SCENE_H

#include "study/rivals/source.h"

/* Makes a rival's scene of the unpruned one. It has colours of degree 0, without the harmonics of a scene from a
 * file. */
int tuned_scene_of_rival(rival_source *source, method_kind kind, const reconstruction_options *options,
                         scene_file *scene, reconstruction_account *account);

/* Builds a scene of ours and fine-tunes it as it is. */
int tuned_scene_of_ours(rival_source *source, const reconstruction_options *options, scene_file *scene,
                        reconstruction_account *account);

#endif
