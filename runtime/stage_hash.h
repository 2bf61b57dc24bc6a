/* SPDX-License-Identifier: Apache-2.0 */
/* Hashes of each stage's output, for replays that expect the same bits (SPEC.md, "Hash"). Each does nothing unless the
 * stage_hash hook is set; views `first` to `end` - 1 are hashed. */
#ifndef T3R_STAGE_HASH_H
#define T3R_STAGE_HASH_H

#include "state/state.h"

void t3r_hash_image(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end);
void t3r_hash_depth(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end);
void t3r_hash_pointmap(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end);
void t3r_hash_wavelet(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end);
void t3r_hash_superclusters(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end);
void t3r_hash_budget(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end);
void t3r_hash_scene(const t3r_runtime *rt, t3r_stage stage); /* after head, or after refine */

#endif
