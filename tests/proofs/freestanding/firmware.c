/* SPDX-License-Identifier: Apache-2.0 */
/* A firmware with one head and without a C library; shows what a linker keeps of the runtime and of the shipped heads.
 */
#include <stddef.h>
#include <stdint.h>

#include "memory.h"
#include "trim3r.h"
#include "trim3r_heads.h"

#ifndef HEAD
#define HEAD t3r_head_small
#define HEAD_BYTES t3r_head_small_bytes
#endif

int firmware(void *arena, size_t bytes, const t3r_config *config, const t3r_frame *frame, const t3r_camera *camera,
             const t3r_target *target);

int firmware(void *arena, size_t bytes, const t3r_config *config, const t3r_frame *frame, const t3r_camera *camera,
             const t3r_target *target)
{
    t3r_runtime *rt;
    t3r_scene scene;
    t3r_status status = t3r_init(&rt, arena, bytes, config);
    if (status == T3R_OK) {
        status = t3r_bind_head(rt, HEAD, HEAD_BYTES);
    }
#ifdef SECOND_HEAD
    if (status == T3R_OK) {
        status = t3r_bind_head(rt, SECOND_HEAD, sizeof *config);
    }
#endif
    if (status == T3R_OK) {
        status = t3r_add_view(rt, frame, camera);
    }
    if (status == T3R_OK) {
        status = t3r_reconstruct(rt, NULL, &scene);
    }
    return status == T3R_OK ? t3r_render(rt, camera, target) : status;
}
