/* SPDX-License-Identifier: Apache-2.0 */
#include "stage_hash.h"

#include "core/fixed.h"
#include "kernels/hash_writer.h"
#include "pointmap/pointmap.h"
#include "superclusters/superclusters.h"

static bool no_hook(const t3r_runtime *rt)
{
    return rt->hooks.stage_hash == NULL;
}

static void begin(const t3r_runtime *rt, t3r_hash_writer *w)
{
    t3r_hash_begin(w, rt->kernels.hash_bytes);
}

static void report(const t3r_runtime *rt, t3r_stage stage, t3r_hash_writer *w)
{
    rt->hooks.stage_hash(rt->hooks.user, stage, t3r_hash_end(w));
}

static size_t pixels_of(const t3r_runtime *rt)
{
    return T3R_PIXELS_(rt->config.width, rt->config.height);
}

static void write_frame(const t3r_runtime *rt, t3r_hash_writer *w)
{
    for (int i = 0; i < 3; i++) {
        t3r_write_u64(w, (uint64_t)rt->frame.origin_q32[i]);
    }
    t3r_write_u32(w, (uint32_t)rt->frame.exponent);
}

/* Pixels written at the same time, at most two bytes each. */
#define PIXELS (T3R_HASH_RUN / 2)

static uint32_t run_at(size_t i, size_t count)
{
    return (uint32_t)T3R_MIN(count - i, (size_t)PIXELS);
}

/* Writes depths, 0 unless reliably measured. */
static void write_measured(const t3r_runtime *rt, const t3r_view *view, t3r_hash_writer *w)
{
    for (size_t i = 0; i < pixels_of(rt); i += PIXELS) {
        const uint32_t run = run_at(i, pixels_of(rt));
        uint16_t depth[PIXELS];
        for (uint32_t j = 0; j < run; j++) {
            depth[j] = t3r_is_reliable(view->validity[i + j]) ? view->depth[i + j] : 0;
        }
        t3r_write_u16s(w, depth, run);
    }
}

#define VALIDITIES (2 * T3R_MARK_LENT) /* a source and marks */

static void write_confidence(const t3r_runtime *rt, const t3r_view *view, t3r_hash_writer *w)
{
    uint8_t confidence[VALIDITIES];
    for (uint32_t validity = 0; validity < VALIDITIES; validity++) {
        confidence[validity] = t3r_confidence_of((uint8_t)validity);
    }
    for (size_t i = 0; i < pixels_of(rt); i += PIXELS) {
        const uint32_t run = run_at(i, pixels_of(rt));
        uint8_t *room = t3r_hash_room(w, run);
        for (uint32_t j = 0; j < run; j++) {
            room[j] = confidence[view->validity[i + j] % VALIDITIES];
        }
    }
}

void t3r_hash_image(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    t3r_hash_writer w;
    begin(rt, &w);
    for (uint32_t v = first; v < end; v++) {
        for (int c = 0; c < 3; c++) {
            t3r_write_bytes(&w, views[v].colour[c], pixels_of(rt));
        }
        write_measured(rt, &views[v], &w);
    }
    report(rt, T3R_STAGE_IMAGE, &w);
}

void t3r_hash_depth(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    t3r_hash_writer w;
    begin(rt, &w);
    for (uint32_t v = first; v < end; v++) {
        t3r_write_u16s(&w, views[v].depth, pixels_of(rt));
        write_confidence(rt, &views[v], &w);
    }
    report(rt, T3R_STAGE_DEPTH, &w);
}

/* The pointmap is a function of fully hashed planes; evaluating all of it again would take longer than any earlier
 * stage. */
#define POINTMAP_STEP 4

void t3r_hash_pointmap(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    t3r_hash_writer w;
    begin(rt, &w);
    write_frame(rt, &w);
    for (uint32_t v = first; v < end; v++) {
        t3r_pointmap map = t3r_pointmap_of(&views[v], rt->frame.exponent);
        for (uint32_t y = 0; y < views[v].height; y += POINTMAP_STEP) {
            for (uint32_t x = 0; x < views[v].width; x += POINTMAP_STEP) {
                int32_t values[9] = {0};
                (void)t3r_point(&map, x, y, values);
                (void)t3r_tangents(&map, x, y, values + 3, values + 6);
                for (int i = 0; i < 9; i++) {
                    t3r_write_u32(&w, (uint32_t)values[i]);
                }
            }
        }
    }
    for (uint32_t v = first; v < end; v++) {
        for (int c = 0; c < 3; c++) {
            t3r_write_u16(&w, rt->gain_q14[v][c]);
        }
        write_confidence(rt, &views[v], &w);
    }
    report(rt, T3R_STAGE_POINTMAP, &w);
}

void t3r_hash_wavelet(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    t3r_hash_writer w;
    begin(rt, &w);
    for (uint32_t v = first; v < end; v++) {
        t3r_write_u16s(&w, views[v].texture, pixels_of(rt));
    }
    report(rt, T3R_STAGE_WAVELET, &w);
}

#define NO_LABEL UINT16_MAX /* of pixels without depth */

static void write_labels(const t3r_runtime *rt, const t3r_view *view, t3r_hash_writer *w)
{
    for (size_t i = 0; i < pixels_of(rt); i += PIXELS) {
        const uint32_t run = run_at(i, pixels_of(rt));
        const uint8_t *low = view->label + i, *validity = view->validity + i;
        uint16_t label[PIXELS];
        for (uint32_t j = 0; j < run; j++) {
            const uint16_t there = (uint16_t)t3r_label(low[j], validity[j]);
            label[j] = t3r_has_depth(validity[j]) ? there : NO_LABEL;
        }
        t3r_write_u16s(w, label, run);
    }
}

void t3r_hash_superclusters(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    t3r_hash_writer w;
    begin(rt, &w);
    const t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    for (uint32_t k = 0; k < rt->config.clusters; k++) {
        for (int d = 0; d < T3R_DIMENSIONS; d++) {
            t3r_write_u32(&w, (uint32_t)clusters[k].centre_q19[d]);
        }
        t3r_write_u32(&w, clusters[k].points);
    }
    for (uint32_t v = first; v < end; v++) {
        write_labels(rt, &views[v], &w);
    }
    report(rt, T3R_STAGE_SUPERCLUSTERS, &w);
}

void t3r_hash_budget(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    t3r_hash_writer w;
    begin(rt, &w);
    for (uint32_t v = first; v < end; v++) {
        for (size_t i = 0; i < (pixels_of(rt) + 31) / 32; i++) {
            t3r_write_u32(&w, views[v].mask[i]);
        }
    }
    report(rt, T3R_STAGE_BUDGET, &w);
}

void t3r_hash_scene(const t3r_runtime *rt, t3r_stage stage)
{
    if (no_hook(rt)) {
        return;
    }
    t3r_hash_writer w;
    begin(rt, &w);
    write_frame(rt, &w);
    t3r_write_u32(&w, rt->gaussians);
    if (rt->build.head == T3R_HEAD_LEARNED) {
        t3r_write_u32(&w, rt->head_crc);
    }
    const t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    for (uint32_t i = 0; i < rt->gaussians; i++) {
        const t3r_gaussian *g = &scene[i];
        for (int k = 0; k < 3; k++) {
            t3r_write_u32(&w, (uint32_t)g->position_q20[k]);
        }
        for (int k = 0; k < 9; k++) {
            t3r_write_u16(&w, (uint16_t)g->factor[k]);
        }
        t3r_write_u8(&w, (uint8_t)g->factor_exponent);
        t3r_write_u8(&w, g->view);
        for (int k = 0; k < 3; k++) {
            t3r_write_u16(&w, g->colour_q7[k]);
        }
        t3r_write_u16(&w, g->opacity_q15);
        t3r_write_u8(&w, g->confidence);
    }
    report(rt, stage, &w);
}
