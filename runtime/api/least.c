/* SPDX-License-Identifier: Apache-2.0 */
/* Builds as few Gaussians as draw the context views well enough: tries numbers of them, and measures each. */
#include "api/least.h"

#include "api/build_checks.h"
#include "core/fixed.h"
#include "state/state.h"

#define FIRST_PART 128u /* the first scene has 1/128 of the budget */
#define STEP_PART 64u   /* the search ends at steps of 1/64 */

/* 10 log10(2), in 1/256 dB an octave, over 2^6: octaves are Q16, below 2^22 */
#define DECIBEL_Q6 49321

typedef struct difference {
    uint64_t error;  /* squared: below 3 x 2^24 x 2^16 */
    uint64_t values; /* that were compared */
} difference;

/* Compares a view with a picture where counted is not 0; NULL: everywhere. */
static difference compare(const t3r_view *view, const t3r_target *picture, const uint8_t *counted)
{
    difference d = {0};
    for (uint32_t y = 0; y < view->height; y++) {
        const uint8_t *row = picture->rgb + (size_t)y * picture->rgb_stride_bytes;
        for (uint32_t x = 0; x < view->width; x++) {
            const size_t pixel = (size_t)y * view->width + x;
            if (counted != NULL && counted[pixel] == 0) {
                continue;
            }
            for (int c = 0; c < 3; c++) {
                const int32_t off = row[3 * x + (uint32_t)c] - view->colour[c][pixel];
                d.error += (uint32_t)(off * off);
            }
            d.values += 3;
        }
    }
    return d;
}

static uint32_t psnr_q8(difference d)
{
    if (d.error == 0) {
        return T3R_MAX_PSNR_Q8;
    }
    const int64_t octaves_q16 = t3r_log2_wide_q16(d.values * (255 * 255)) - t3r_log2_wide_q16(d.error);
    return (uint32_t)t3r_clamp64(octaves_q16 * DECIBEL_Q6 >> 22, 0, T3R_MAX_PSNR_Q8);
}

typedef struct search {
    t3r_runtime *rt;
    t3r_request request;
    uint32_t psnr_q8; /* wanted */
    const t3r_target *picture;
    const uint8_t *const *counted;
    t3r_scene *scene;
    t3r_least *found;
    uint32_t best, best_psnr_q8; /* the number that drew them best, the smallest of several */
} search;

/* Builds so many Gaussians and measures the view that they draw worst. */
static t3r_status try_number(search *s, uint32_t gaussians)
{
    s->request.gaussians = gaussians;
    t3r_status status = t3r_rebuild(s->rt, &s->request, s->scene);
    s->found->builds += status == T3R_OK;
    s->found->psnr_q8 = T3R_MAX_PSNR_Q8;
    for (uint32_t v = 0; v < s->rt->views && status == T3R_OK; v++) {
        const t3r_view view = t3r_view_of(s->rt, v);
        status = t3r_render(s->rt, &s->rt->camera[v], s->picture);
        if (status == T3R_OK) {
            const uint32_t drawn = psnr_q8(compare(&view, s->picture, s->counted != NULL ? s->counted[v] : NULL));
            s->found->psnr_q8 = T3R_MIN(s->found->psnr_q8, drawn);
        }
    }
    if (s->best == 0 || s->found->psnr_q8 > s->best_psnr_q8) {
        s->best = gaussians;
        s->best_psnr_q8 = s->found->psnr_q8;
    }
    return status;
}

static bool is_enough(const search *s)
{
    return s->found->psnr_q8 >= s->psnr_q8;
}

/* Doubles the number until it is enough, at most to `most`; then halves the gap to the last one that is not. Takes the
 * best one if none is enough. */
static t3r_status find_least(search *s, uint32_t most)
{
    uint32_t few = 0, tried = T3R_MAX(most / FIRST_PART, 1u);
    t3r_status status = try_number(s, tried);
    while (status == T3R_OK && !is_enough(s) && tried < most) {
        few = tried;
        tried = T3R_MIN(2 * tried, most);
        status = try_number(s, tried);
    }
    const bool found = status == T3R_OK && is_enough(s);
    uint32_t taken = found ? tried : s->best;
    while (status == T3R_OK && found && taken - few > T3R_MAX(taken / STEP_PART, 1u)) {
        tried = few + (taken - few) / 2;
        status = try_number(s, tried);
        *(is_enough(s) ? &taken : &few) = tried;
    }
    return status == T3R_OK && tried != taken ? try_number(s, taken) : status;
}

t3r_status t3r_rebuild_least_counted(t3r_runtime *rt, const t3r_request *request, uint32_t least_psnr_q8,
                                     const t3r_target *picture, const uint8_t *const *counted, t3r_scene *scene,
                                     t3r_least *found)
{
    T3R_PASS(t3r_least_checks(rt, request, least_psnr_q8, picture, scene, found, NULL));
    *found = (t3r_least){0};
    search s = {
        .rt = rt, .psnr_q8 = least_psnr_q8, .picture = picture, .counted = counted, .scene = scene, .found = found};
    s.request = request != NULL ? *request : (t3r_request){0};
    const uint32_t budget = s.request.gaussians != 0 ? s.request.gaussians : rt->config.gaussians;
    return find_least(&s, T3R_MIN(budget, T3R_MAX(rt->valid_points, 1u)));
}

t3r_status t3r_rebuild_least(t3r_runtime *rt, const t3r_request *request, uint32_t least_psnr_q8,
                             const t3r_target *picture, t3r_scene *scene, t3r_least *found)
{
    return t3r_rebuild_least_counted(rt, request, least_psnr_q8, picture, NULL, scene, found);
}
