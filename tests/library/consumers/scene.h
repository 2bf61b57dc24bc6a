/* SPDX-License-Identifier: Apache-2.0 */
/* The scene that every consumer of the library builds, with only the public headers. */
#ifndef T3R_TESTS_CONSUMER_SCENE_H
#define T3R_TESTS_CONSUMER_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

enum { SCENE_SIDE = 64, SCENE_VIEWS = 2, SCENE_BUDGET = 400 };

/* Builds a scene of two synthetic views by the shipped head `small`, and a view of it. Returns all stages' hashes
 * folded into one, or the status on an error, as a number of 64 bits. `cpu` are T3R_CPU_... features, which do not
 * change it. */
uint64_t build_scene(uint32_t cpu);

/* Does the same with a configuration of that size, number of views and budget, in this memory; with `stream` the views
 * are keyframes. */
t3r_status fold_scene(const t3r_config *config, uint32_t cpu, void *memory, size_t bytes, uint64_t *folded);

#endif
