/* SPDX-License-Identifier: Apache-2.0 */
/* A whole firmware: a depth camera's lines arrive by DMA, two views become Gaussians, and a view between them is drawn
 * for a display of RGB565. The watchdog is fed between lines and in the hook `progress`, a head is read in place from
 * its own partition, and an error is reported in words. docs/firmware.md explains it. */
#include <stdbool.h>

#include "board.h"
#include "report.h"
#include "semihost.h"
#include "stack.h"
#include "trim3r.h"

enum { SIDE = CAMERA_SIDE, VIEWS = 2, BUDGET = 400, TRIES = 3, BASELINE_MM = 60, MILLIMETRE_Q40 = 1099511628 };
#ifndef WATCHDOG_MS
#define WATCHDOG_MS 640 /* 20 million instructions of the emulated processor */
#endif

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_ARENA_BYTES(SIDE, SIDE, VIEWS, BUDGET)];
static uint8_t line[3 * SIDE], picture[SIDE][3 * SIDE], display[SIDE][2 * SIDE];
static uint16_t alpha[SIDE][SIDE];
static char text[T3R_ERROR_BYTES]; /* the sentence of an error */
static volatile uint32_t lines_arrived;

static _Noreturn void stop(const char *call, const char *reason)
{
    report_text("error: ", call, ": ", reason);
    semihost_exit(1); /* a product restarts, or reports to its host */
}

/* The interrupt after a line: nothing else than a count, because no call on the runtime is allowed here. */
static void on_line(uint32_t y)
{
    lines_arrived = y + 1;
}

static int on_progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)user, (void)stage, (void)done, (void)total;
    watchdog_feed();
    return 0;
}

static t3r_camera camera_at(int32_t right_mm)
{
    return (t3r_camera){.width = SIDE,
                        .height = SIDE,
                        .fx_q16 = SIDE << 16,
                        .fy_q16 = SIDE << 16,
                        .cx_q16 = (SIDE - 1) << 15,
                        .cy_q16 = (SIDE - 1) << 15,
                        .position_q32 = {right_mm * (INT64_C(1) << 32) / 1000, 0, 0},
                        .rotation_q30 = {1 << 30, 0, 0, 0}};
}

/* Adds a view line by line. Returns false if a line was overwritten before it was taken; row 0 begins the view anew. */
static bool take_view(t3r_runtime *rt, int32_t right_mm)
{
    const t3r_camera camera = camera_at(right_mm);
    lines_arrived = 0;
    camera_start(right_mm, on_line);
    for (uint32_t y = 0; y < SIDE; y++) {
        while (lines_arrived <= y) {
            camera_wait();
        }
        const camera_line *arrived = &camera_lines[y % CAMERA_LINES];
        (void)t3r_unpack_row(T3R_PACKED_RGB565_BE, arrived->rgb565, SIDE, line);
        const t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                                 .width = SIDE,
                                 .height = SIDE,
                                 .planes = {line},
                                 .stride_bytes = {sizeof line},
                                 .depth = arrived->depth,
                                 .depth_width = SIDE,
                                 .depth_height = SIDE,
                                 .depth_stride_bytes = sizeof arrived->depth,
                                 .depth_unit_q40 = MILLIMETRE_Q40};
        const t3r_status status = t3r_add_rows(rt, &frame, &camera, y, 1, y, 1);
        if (lines_arrived - y >= CAMERA_LINES) {
            return false; /* the DMA writes, or has written, where this line was */
        }
        if (status != T3R_OK) {
            stop("t3r_add_rows", t3r_add_rows_error(status, rt, &frame, &camera, y, 1, y, 1, text, sizeof text));
        }
        watchdog_feed();
    }
    return true;
}

static t3r_runtime *open(void)
{
    t3r_runtime *rt;
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, BUDGET);
    config.head = T3R_HEAD_LEARNED;
    config.refine = 2;
    t3r_status status = t3r_init(&rt, arena, sizeof arena, &config);
    if (status != T3R_OK) {
        stop("t3r_init", t3r_init_error(status, &rt, arena, sizeof arena, &config, text, sizeof text));
    }
    uint32_t room;
    const uint8_t *weights = weights_partition(&room);
    const uint32_t bytes = weights[8] | weights[9] << 8 | weights[10] << 16 | (uint32_t)weights[11] << 24;
    status = t3r_bind_head(rt, weights, bytes < room ? bytes : room); /* a .t3w file has its size at byte 8 */
    if (status != T3R_OK) {
        stop("t3r_bind_head", t3r_bind_head_error(status, rt, weights, bytes < room ? bytes : room, text, sizeof text));
    }
    const t3r_hooks hooks = {.progress = on_progress};
    (void)t3r_set_hooks(rt, &hooks);
    (void)t3r_set_cpu(rt, t3r_cpu_found()); /* DSP or Helium, as compiled */
    return rt;
}

/* Draws a view over blue, and packs it for the display. Returns the sum of its bytes. */
static uint32_t show(t3r_runtime *rt, int32_t right_mm)
{
    static const uint8_t background[3] = {0, 0, 96};
    const t3r_camera camera = camera_at(right_mm);
    const t3r_target target = {.width = SIDE,
                               .height = SIDE,
                               .rgb = picture[0],
                               .rgb_stride_bytes = sizeof picture[0],
                               .alpha_q15 = alpha[0],
                               .alpha_stride_bytes = sizeof alpha[0]};
    const t3r_status status = t3r_render(rt, &camera, &target);
    if (status != T3R_OK) {
        stop("t3r_render", t3r_render_error(status, rt, &camera, &target, text, sizeof text));
    }
    uint32_t sum = 0;
    for (uint32_t y = 0; y < SIDE; y++) {
        (void)t3r_composite_row(picture[y], alpha[y], SIDE, background);
        (void)t3r_pack_row(T3R_PACKED_RGB565, picture[y], NULL, SIDE, display[y]);
        for (uint32_t i = 0; i < sizeof display[y]; i++) {
            sum = sum * 31 + display[y][i];
        }
    }
    return sum;
}

int main(void)
{
    watchdog_start(WATCHDOG_MS);
    t3r_runtime *rt = open();
    for (int32_t view = 0; view < VIEWS; view++) {
        uint32_t tries = 1;
        while (!take_view(rt, view * BASELINE_MM)) {
            if (tries++ == TRIES) {
                stop("camera", "lines come faster than they are taken");
            }
        }
    }
    t3r_scene scene;
    const t3r_status status = t3r_reconstruct(rt, NULL, &scene);
    if (status != T3R_OK) {
        stop("t3r_reconstruct", t3r_reconstruct_error(status, rt, NULL, &scene, text, sizeof text));
    }
    report_number("gaussians", scene.count);
    report_number("points", scene.valid_points);
    report_number("display", show(rt, BASELINE_MM / 2));
    report_number("arena_bytes", sizeof arena);
    report_number("stack_bytes", stack_used_bytes());
    return 0;
}
