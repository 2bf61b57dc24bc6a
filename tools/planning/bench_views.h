/* Context views of the built-in room: every other frame. */
#ifndef TRIM3R_TOOLS_BENCH_VIEWS_H
#define TRIM3R_TOOLS_BENCH_VIEWS_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

typedef struct bench_views {
    uint32_t width, height, count;
    uint8_t *rgb[T3R_MAX_VIEWS];
    uint16_t *depth[T3R_MAX_VIEWS]; /* millimetres */
    t3r_camera camera[T3R_MAX_VIEWS];
} bench_views;

/* Draws frames 0, 2, ... at that size. False: out of memory. bench_views_free() is due in any case. */
bool bench_views_draw(bench_views *views, uint32_t width, uint32_t height, uint32_t count);
/* Empties the runtime and adds the views. */
t3r_status bench_views_add(const bench_views *views, t3r_runtime *runtime);
void bench_views_free(bench_views *views);

#endif
