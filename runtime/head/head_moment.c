/* A head without weights, by closed-form moment matching: every pixel of the view joins
 * the retained pixel that is nearest in position and colour; a splat takes its pixels' mean, covariance and colour. */
#include "depth/depth.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "fitted_widths.h"
#include "head.h"

#define REACH 15 /* pixels join within +-15 */
#define NONE (-128)
#define COLOUR_WEIGHT_SHIFT 7 /* squared colour distance over 128 counts as squared pixels */
#define SPREAD_Q12 14336      /* 3.5: a cell's second moment to the variance of the splat that fills it */

typedef struct assignment {
    int8_t *offset; /* dx, dy a pixel to the retained pixel it joined; dx = NONE: none yet */
    const t3r_view *view;
} assignment;

/* Cost of pixel (x, y) joining the retained pixel at (x + dx, y + dy). */
static uint32_t cost_of(const t3r_view *view, uint32_t x, uint32_t y, int32_t dx, int32_t dy)
{
    size_t here = (size_t)y * view->width + x;
    size_t there = (size_t)((int64_t)here + (int64_t)dy * view->width + dx);
    uint32_t colour = 0;
    for (int c = 0; c < 3; c++) {
        int32_t d = view->colour[c][here] - view->colour[c][there];
        colour += (uint32_t)(d * d);
    }
    uint32_t edge = t3r_same_surface(view->depth[there], view->depth[here]) ? 0 : 4096;
    return (uint32_t)(dx * dx + dy * dy) + (colour >> COLOUR_WEIGHT_SHIFT) + edge;
}

/* The retained pixel that one has joined, and what that costs. */
typedef struct choice {
    int32_t dx, dy;
    uint32_t cost;
} choice;

/* Offers pixel (x, y) what its neighbour (x + sx, y + sy) joined. */
static void propagate(const assignment *j, choice *to, uint32_t x, uint32_t y, int32_t sx, int32_t sy)
{
    int64_t nx = (int64_t)x + sx, ny = (int64_t)y + sy;
    if (nx < 0 || ny < 0 || nx >= j->view->width || ny >= j->view->height) {
        return;
    }
    const int8_t *from = j->offset + 2 * ((size_t)ny * j->view->width + (size_t)nx);
    if (from[0] == NONE) {
        return;
    }
    const int32_t dx = from[0] + sx, dy = from[1] + sy;
    if (t3r_abs32(dx) > REACH || t3r_abs32(dy) > REACH) {
        return;
    }
    if ((dx == to->dx && dy == to->dy) || (uint32_t)(dx * dx + dy * dy) >= to->cost) {
        return; /* as most do: what the pixel has, or one too far away whatever its colour */
    }
    const uint32_t cost = cost_of(j->view, x, y, dx, dy);
    if (cost < to->cost) {
        *to = (choice){dx, dy, cost};
    }
}

static void choose(const assignment *j, uint32_t x, uint32_t y, int32_t side)
{
    int8_t *own = j->offset + 2 * ((size_t)y * j->view->width + x);
    choice to = {own[0], own[1], own[0] == NONE ? UINT32_MAX : cost_of(j->view, x, y, own[0], own[1])};
    propagate(j, &to, x, y, side, 0);
    propagate(j, &to, x, y, 0, side);
    propagate(j, &to, x, y, side, side);
    propagate(j, &to, x, y, -side, side);
    own[0] = (int8_t)to.dx;
    own[1] = (int8_t)to.dy;
}

/* Four raster sweeps, two each way. */
static void assign_pixels(const t3r_head_input *input)
{
    const t3r_view *view = input->map.view;
    assignment j = {input->work, view};
    size_t pixels = (size_t)view->width * view->height;
    for (size_t i = 0; i < pixels; i++) {
        bool kept = t3r_retained(view, i);
        j.offset[2 * i] = kept ? 0 : NONE;
        j.offset[2 * i + 1] = 0;
    }
    for (int sweep = 0; sweep < 4; sweep++) {
        bool down = sweep % 2 == 0;
        for (size_t n = 0; n < pixels; n++) {
            size_t i = down ? n : pixels - 1 - n;
            uint32_t x = (uint32_t)(i % view->width), y = (uint32_t)(i / view->width);
            if (!t3r_has_depth(view->validity[i]) || t3r_retained(view, i) ||
                t3r_is_deferred(view, i, input->settings)) {
                continue;
            }
            choose(&j, x, y, down ? -1 : 1);
        }
    }
}

/* Sums over the pixels that joined (u, v): at most 31^2 of them, so every sum stays below 2^19. */
typedef struct moments {
    int32_t count, x, y, xx, xy, yy, colour[3];
} moments;

static moments gather(const t3r_head_input *input, uint32_t u, uint32_t v, int32_t reach)
{
    const t3r_view *view = input->map.view;
    const int8_t *joined = input->work;
    const int32_t left = T3R_MIN(reach, (int32_t)u), right = T3R_MIN(reach, (int32_t)(view->width - 1 - u));
    const int32_t above = T3R_MIN(reach, (int32_t)v), below = T3R_MIN(reach, (int32_t)(view->height - 1 - v));
    moments m = {0};
    for (int32_t dy = -above; dy <= below; dy++) {
        const size_t middle = (size_t)((int64_t)v + dy) * view->width + u;
        for (int32_t dx = -left; dx <= right; dx++) {
            const size_t i = (size_t)((int64_t)middle + dx);
            if (joined[2 * i] != -dx || joined[2 * i + 1] != -dy) {
                continue;
            }
            m.count++;
            m.x += dx;
            m.y += dy;
            m.xx += dx * dx;
            m.xy += dx * dy;
            m.yy += dy * dy;
            for (int c = 0; c < 3; c++) {
                m.colour[c] += view->colour[c][i];
            }
        }
    }
    return m;
}

/* What a pixel gathers that only it itself joined. */
static moments alone(const t3r_view *view, size_t pixel)
{
    return (moments){.count = 1, .colour = {view->colour[0][pixel], view->colour[1][pixel], view->colour[2][pixel]}};
}

static t3r_footprint footprint_of(const moments *m)
{
    t3r_footprint f = {.opacity_q15 = T3R_HEAD_OPACITY_Q15};
    int64_t n = m->count;
    /* The pixel joined itself: count >= 1. NOLINTNEXTLINE(clang-analyzer-core.DivideZero) */
    f.offset_q12[0] = m->x * 4096 / m->count;
    f.offset_q12[1] = m->y * 4096 / m->count;
    /* Second central moments, plus a pixel's own 1/8, Q12 */
    int64_t xx = (int64_t)m->xx * 4096 / n - (int64_t)f.offset_q12[0] * f.offset_q12[0] / 4096 + 512;
    int64_t yy = (int64_t)m->yy * 4096 / n - (int64_t)f.offset_q12[1] * f.offset_q12[1] / 4096 + 512;
    int64_t xy = (int64_t)m->xy * 4096 / n - (int64_t)f.offset_q12[0] * f.offset_q12[1] / 4096;
    f.xx_q12 = (int32_t)(xx * SPREAD_Q12 / 4096);
    f.yy_q12 = (int32_t)(yy * SPREAD_Q12 / 4096);
    f.xy_q12 = (int32_t)(xy * SPREAD_Q12 / 4096);
    for (int c = 0; c < 3; c++) {
        f.colour_q7[c] = (uint16_t)((m->colour[c] * 128 + m->count / 2) / m->count);
    }
    return f;
}

uint32_t t3r_head_moment(const t3r_head_input *input, uint32_t begin, uint32_t end, t3r_gaussian *out)
{
    const t3r_view *view = input->map.view;
    if (!input->unadapted) {
        assign_pixels(input);
    }
    uint32_t count = 0;
    for (uint32_t v = begin; v < end; v++) {
        if (!t3r_head_goes_on(input)) {
            return T3R_HEAD_STOPPED;
        }
        for (uint32_t u = 0; u < view->width; u++) {
            size_t pixel = (size_t)v * view->width + u;
            if (!t3r_retained(view, pixel)) {
                continue;
            }
            uint32_t reach = T3R_MIN((t3r_spacing_q12(input, pixel) * 2 >> 12) + 2, (uint32_t)REACH);
            moments m = input->unadapted ? alone(view, pixel) : gather(input, u, v, (int32_t)reach);
            t3r_footprint footprint = footprint_of(&m);
            t3r_fit_widths_if_asked(input, u, v, &footprint);
            t3r_lift(input, u, v, &footprint, &out[count++]);
        }
    }
    return count;
}
