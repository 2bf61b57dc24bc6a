/* SPDX-License-Identifier: Apache-2.0 */
/* The readers and writers of scene files as a WebAssembly module with a C library, called by a worker of the page. Each
 * instance reads or writes one file, in the module's memory. */
#include <stdio.h>
#include <stdlib.h>

#include "answer.h"
#include "bundle.h"
#include "host/reason.h"
#include "host/whole_file.h"
#include "mcap/reader_limits.h"
#include "module/carried.h"
#include "scene/scene_file.h"
#include "scene/store/scene_store.h"
#include "start_view.h"

page_answer answer;
static t3r_camera start;

/* Returns memory for bytes that the page passes in; 0: there is none. */
EXPORT(room) void *files_room(uint32_t bytes)
{
    return malloc(bytes);
}

EXPORT(text) const char *files_text(void)
{
    return answer.text;
}

EXPORT(bytes) const char *files_bytes(void)
{
    return answer.bytes;
}

EXPORT(count) uint32_t files_count(void)
{
    return (uint32_t)answer.count;
}

/* Returns the most bytes that a compressed file of this size may unpack to. */
EXPORT(unpacked_most) double files_unpacked_most(double packed)
{
    return (double)t3r_limit_unpacked((uint64_t)packed);
}

/* ---- files in memory --------------------------------------------------------------------------------------------- */

void answer_remark(const char *text)
{
    const int length = snprintf(answer.text + answer.length, sizeof answer.text - answer.length, "%s%s",
                                answer.length > 0 ? "; " : "", text);
    answer.length += length > 0 && (size_t)length < sizeof answer.text - answer.length ? (size_t)length : 0;
}

static void add_remark(void *user, const char *text)
{
    (void)user;
    answer_remark(text);
}

static int begin(t3r_whole_file *file, const char *path, char *error, size_t error_bytes)
{
    *file = (t3r_whole_file){.stream = open_memstream(&answer.bytes, &answer.count), .path = path};
    return file->stream != NULL ? 0 : t3r_reason(error, error_bytes, "%s: out of memory", path);
}

int t3r_whole_file_commit(t3r_whole_file *file, uint64_t *bytes, char *error, size_t error_bytes)
{
    const int failed = ferror(file->stream);
    (void)bytes;
    return fclose(file->stream) == 0 && !failed ? 0 : t3r_reason(error, error_bytes, "%s: out of memory", file->path);
}

void t3r_whole_file_abandon(t3r_whole_file *file)
{
    fclose(file->stream);
}

static const scene_caller page = {.remark = add_remark, .begin = begin};

/* ---- reading and writing ----------------------------------------------------------------------------------------- */

/* Turns a file, whose name ends in its suffix, into a bundle of its scene. Invalid Gaussians are left out. Returns 0,
 * or -1 with the reason as text. */
EXPORT(read) int32_t files_read(const char *name, const uint8_t *bytes, uint32_t count)
{
    scene_file scene;
    if (scene_file_parse(name, bytes, count, T3R_SCENE_DROP_INVALID, &scene, answer.text, sizeof answer.text) != 0) {
        return -1;
    }
    answer.gaussians = scene.count;
    scene_store_remark(&page, name, &scene.remarks);
    const bundle data = {.config = t3r_default_config(START_VIEW_WIDTH, START_VIEW_HEIGHT, 0, scene.count),
                         .scene = &scene};
    answer.bytes = (char *)bundle_bytes(&data, &answer.count);
    return answer.bytes != NULL && start_view(&scene, START_VIEW_WIDTH, START_VIEW_HEIGHT, &start) == 0
               ? 0
               : t3r_reason(answer.text, sizeof answer.text, "out of memory for %u Gaussians", (unsigned)scene.count);
}

EXPORT(gaussians) uint32_t files_gaussians(void)
{
    return answer.gaussians;
}

double answer_camera(const t3r_camera *c, uint32_t index)
{
    const int32_t pixels[] = {c->fx_q16, c->fy_q16, c->cx_q16, c->cy_q16};
    return index < 4     ? pixels[index] / 65536.0
           : index < 7   ? (double)c->position_q32[index - 4] / 4294967296.0
           : index < 11  ? c->rotation_q30[index - 7] / 1073741824.0
           : index == 11 ? c->width
                         : c->height;
}

/* Returns a number of the camera from which a scene that was read is first seen: answer_camera(). */
EXPORT(start) double files_start(uint32_t index)
{
    return answer_camera(&start, index);
}

/* Writes a carried scene as a file in the format of the name's suffix. Returns 0, or -1 with the reason as text. */
EXPORT(write) int32_t files_write(const char *name, const carried *in)
{
    const scene_file scene = {.frame = in->frame,
                              .gaussians = (t3r_gaussian *)(uintptr_t)in->gaussians, /* only read */
                              .count = in->count,
                              .degree = in->degree,
                              .mip = in->mip != 0,
                              .harmonics_q12 = carried_harmonics(in)};
    char error[512] = "";
    return scene_store_write(name, &scene, 0, NULL, &page, error, sizeof error) == 0
               ? 0
               : t3r_reason(answer.text, sizeof answer.text, "%s", error);
}
