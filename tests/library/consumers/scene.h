/* SPDX-License-Identifier: Apache-2.0 */
/* What every consumer of the library builds, with nothing but the public headers. */
#ifndef T3R_TESTS_CONSUMER_SCENE_H
#define T3R_TESTS_CONSUMER_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

enum { SCENE_SIDE = 64, SCENE_VIEWS = 2, SCENE_BUDGET = 400 };

/* A scene of two made-up views by the shipped head `small`, and a view of it: all stages' hashes folded into one. `cpu`
 * are T3R_CPU_... features, which must not matter. On an error the status, as a number of 64 bits. */
uint64_t build_scene(uint32_t cpu);

/* The same of a configuration of that size, number of views and budget, in this memory; with `stream` the views are
 * keyframes. */
t3r_status fold_scene(const t3r_config *config, uint32_t cpu, void *memory, size_t bytes, uint64_t *folded);

#endif
