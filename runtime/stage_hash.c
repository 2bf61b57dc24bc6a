#include "stage_hash.h"

#include "core/hash.h"
#include "pointmap/pointmap.h"
#include "superclusters/superclusters.h"

static void report(const t3r_runtime *rt, t3r_stage stage, uint64_t hash)
{
    rt->hooks.stage_hash(rt->hooks.user, stage, hash);
}

static bool no_hook(const t3r_runtime *rt)
{
    return rt->hooks.stage_hash == NULL;
}

static size_t pixels_of(const t3r_runtime *rt)
{
    return T3R_PIXELS_(rt->config.width, rt->config.height);
}

static uint64_t hash_frame(const t3r_runtime *rt)
{
    uint64_t hash = T3R_HASH_START;
    for (int i = 0; i < 3; i++) {
        hash = t3r_hash_u64(hash, (uint64_t)rt->frame.origin_q32[i]);
    }
    return t3r_hash_u32(hash, (uint32_t)rt->frame.exponent);
}

static uint64_t hash_confidence(const t3r_runtime *rt, const t3r_view *view, uint64_t hash)
{
    for (size_t i = 0; i < pixels_of(rt); i++) {
        hash = t3r_hash_u8(hash, t3r_confidence_of(view->validity[i]));
    }
    return hash;
}

void t3r_hash_image(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    uint64_t hash = T3R_HASH_START;
    for (uint32_t v = first; v < end; v++) {
        for (int c = 0; c < 3; c++) {
            hash = t3r_hash_bytes(hash, views[v].colour[c], pixels_of(rt));
        }
        for (size_t i = 0; i < pixels_of(rt); i++) {
            bool measured = t3r_is_reliable(views[v].validity[i]);
            hash = t3r_hash_u16(hash, measured ? views[v].depth[i] : 0);
        }
    }
    report(rt, T3R_STAGE_IMAGE, hash);
}

void t3r_hash_depth(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    uint64_t hash = T3R_HASH_START;
    for (uint32_t v = first; v < end; v++) {
        hash = t3r_hash_u16s(hash, views[v].depth, pixels_of(rt));
        hash = hash_confidence(rt, &views[v], hash);
    }
    report(rt, T3R_STAGE_DEPTH, hash);
}

/* The pointmap is a function of planes that are hashed whole; to evaluate all of it again would take longer than any
 * stage before it. */
#define POINTMAP_STEP 4

void t3r_hash_pointmap(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    uint64_t hash = hash_frame(rt);
    for (uint32_t v = first; v < end; v++) {
        t3r_pointmap map = t3r_pointmap_of(&views[v], rt->frame.exponent);
        for (uint32_t y = 0; y < views[v].height; y += POINTMAP_STEP) {
            for (uint32_t x = 0; x < views[v].width; x += POINTMAP_STEP) {
                int32_t values[9] = {0};
                (void)t3r_point(&map, x, y, values);
                (void)t3r_tangents(&map, x, y, values + 3, values + 6);
                for (int i = 0; i < 9; i++) {
                    hash = t3r_hash_u32(hash, (uint32_t)values[i]);
                }
            }
        }
    }
    for (uint32_t v = first; v < end; v++) {
        for (int c = 0; c < 3; c++) {
            hash = t3r_hash_u16(hash, rt->gain_q14[v][c]);
        }
        hash = hash_confidence(rt, &views[v], hash);
    }
    report(rt, T3R_STAGE_POINTMAP, hash);
}

void t3r_hash_wavelet(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    uint64_t hash = T3R_HASH_START;
    for (uint32_t v = first; v < end; v++) {
        hash = t3r_hash_u16s(hash, views[v].texture, pixels_of(rt));
    }
    report(rt, T3R_STAGE_WAVELET, hash);
}

void t3r_hash_superclusters(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    uint64_t hash = T3R_HASH_START;
    const t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    for (uint32_t k = 0; k < rt->config.clusters; k++) {
        for (int d = 0; d < T3R_DIMENSIONS; d++) {
            hash = t3r_hash_u32(hash, (uint32_t)clusters[k].centre_q19[d]);
        }
        hash = t3r_hash_u32(hash, clusters[k].points);
    }
    for (uint32_t v = first; v < end; v++) {
        hash = t3r_hash_u16s(hash, views[v].label, pixels_of(rt));
    }
    report(rt, T3R_STAGE_SUPERCLUSTERS, hash);
}

void t3r_hash_budget(const t3r_runtime *rt, const t3r_view *views, uint32_t first, uint32_t end)
{
    if (no_hook(rt)) {
        return;
    }
    uint64_t hash = T3R_HASH_START;
    for (uint32_t v = first; v < end; v++) {
        for (size_t i = 0; i < (pixels_of(rt) + 31) / 32; i++) {
            hash = t3r_hash_u32(hash, views[v].mask[i]);
        }
    }
    report(rt, T3R_STAGE_BUDGET, hash);
}

void t3r_hash_scene(const t3r_runtime *rt, t3r_stage stage)
{
    if (no_hook(rt)) {
        return;
    }
    uint64_t hash = t3r_hash_u32(hash_frame(rt), rt->gaussians);
    if (rt->build.head == T3R_HEAD_LEARNED) {
        hash = t3r_hash_u32(hash, rt->head_crc);
    }
    const t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    for (uint32_t i = 0; i < rt->gaussians; i++) {
        const t3r_gaussian *g = &scene[i];
        for (int k = 0; k < 3; k++) {
            hash = t3r_hash_u32(hash, (uint32_t)g->position_q20[k]);
        }
        for (int k = 0; k < 9; k++) {
            hash = t3r_hash_u16(hash, (uint16_t)g->factor[k]);
        }
        hash = t3r_hash_u8(t3r_hash_u8(hash, (uint8_t)g->factor_exponent), g->view);
        for (int k = 0; k < 3; k++) {
            hash = t3r_hash_u16(hash, g->colour_q7[k]);
        }
        hash = t3r_hash_u8(t3r_hash_u16(hash, g->opacity_q15), g->confidence);
    }
    report(rt, stage, hash);
}
