/* SPDX-License-Identifier: Apache-2.0 */
#include "study/troubles/trouble.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define DARKENED 8.0      /* levels are divided by it */
#define STOPS 1.5         /* of a step and of a ramp of exposure */
#define DISPLAY_GAMMA 2.2 /* levels are not linear in light */
#define JUMP_METRES 0.7
#define ABSURD_METRES 1e6
#define HAND_METRES 0.15
#define HAND_HALF 0.55 /* half axes of the hand over the picture's sides */
#define HAND_EDGE 0.15 /* width of its soft edge over its half axes */

/* ---- pixels ------------------------------------------------------------------------------------------------------ */

static uint8_t level(double value)
{
    return (uint8_t)(value <= 0 ? 0 : value >= 255 ? 255 : value + 0.5);
}

static void scale_levels(troubled_frame *f, double factor)
{
    for (size_t i = 0; i < (size_t)f->recorded.width * f->recorded.height * 3; i++) {
        f->rgb[i] = level(f->rgb[i] * factor);
    }
}

static void black(troubled_frame *f)
{
    scale_levels(f, 0);
}

static void dark(troubled_frame *f)
{
    scale_levels(f, 1 / DARKENED);
}

static void step(troubled_frame *f)
{
    scale_levels(f, pow(2, STOPS / DISPLAY_GAMMA));
}

static void ramp(troubled_frame *f)
{
    const double part = f->since + 1 < f->until ? (f->since + 1.0) / f->until : 1;
    scale_levels(f, pow(2, part * STOPS / DISPLAY_GAMMA));
}

/* ---- a hand ------------------------------------------------------------------------------------------------------ */

/* Returns the distance from the hand's centre at that share of the picture's sides: 1 on its rim. */
static double from_hand(double x, double y)
{
    return hypot((x - 0.45) / HAND_HALF, (y - 0.55) / HAND_HALF);
}

/* Paints a hand out of focus: a smooth blob in the colour of skin. */
static void paint_hand(troubled_frame *f)
{
    static const double skin[3] = {196, 144, 120};
    const uint32_t width = f->recorded.width, height = f->recorded.height;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height, r = from_hand(u, v);
            const double cover = r < 1 ? 1 : r < 1 + HAND_EDGE ? 1 - (r - 1) / HAND_EDGE : 0;
            const double shade = 0.9 + 0.2 * sin(5 * u + 0.3 * f->since) * cos(4 * v);
            for (int c = 0; c < 3; c++) {
                uint8_t *sample = &f->rgb[((size_t)y * width + x) * 3 + (size_t)c];
                *sample = level(*sample * (1 - cover) + skin[c] * shade * cover);
            }
        }
    }
}

/* Gives the hand's pixels a depth; 0 steps = none. */
static void set_hand_depth(troubled_frame *f, double metres)
{
    const uint32_t width = f->recorded.depth_width, height = f->recorded.depth_height;
    for (uint32_t y = 0; y < height && f->depth != NULL; y++) {
        for (uint32_t x = 0; x < width; x++) {
            const double r = from_hand((x + 0.5) / width, (y + 0.5) / height);
            if (r < 1 + HAND_EDGE) {
                f->depth[(size_t)y * width + x] = (uint16_t)(metres * (1 + 0.2 * r * r) / f->depth_unit + 0.5);
            }
        }
    }
}

static void hand(troubled_frame *f)
{
    paint_hand(f);
    set_hand_depth(f, HAND_METRES);
}

static void blind_hand(troubled_frame *f)
{
    paint_hand(f);
    set_hand_depth(f, 0);
}

/* ---- depth and pose ---------------------------------------------------------------------------------------------- */

static void no_depth(troubled_frame *f)
{
    f->depth = NULL;
}

static void no_pose(troubled_frame *f)
{
    f->recorded.unposed = true;
}

static void jump(troubled_frame *f)
{
    f->recorded.camera.position[0] += JUMP_METRES;
}

static void nan_pose(troubled_frame *f)
{
    f->recorded.camera.position[1] = NAN;
}

static void absurd_pose(troubled_frame *f)
{
    f->recorded.camera.position[2] += ABSURD_METRES;
}

/* ---- the table --------------------------------------------------------------------------------------------------- */

enum { GAP, BACK };

static const trouble troubles[] = {
    [GAP] = {"gap", "the frames are missing", false, NULL},
    [BACK] = {"back", "time jumps back: the frames before are shown once more", false, NULL},
    {"hand", "a hand over the lens, out of focus, with depth", false, hand},
    {"blind-hand", "a hand over the lens, too near for depth", false, blind_hand},
    {"black", "black pictures", false, black},
    {"dark", "an eighth of the levels", false, dark},
    {"step", "1.5 stops more exposure, from the first of the frames on", true, step},
    {"ramp", "1.5 stops more exposure, rising over the frames", true, ramp},
    {"jump", "poses are 0.7 m off, from the first of the frames on", true, jump},
    {"flick", "poses are 0.7 m off", false, jump},
    {"nan-pose", "poses are not finite", false, nan_pose},
    {"absurd-pose", "poses are a million metres off", false, absurd_pose},
    {"no-depth", "frames without depth", false, no_depth},
    {"no-pose", "frames without a pose", false, no_pose},
};

const trouble *trouble_at(uint32_t index)
{
    return index < sizeof troubles / sizeof *troubles ? &troubles[index] : NULL;
}

uint32_t trouble_source(const trouble *what, uint32_t index, uint32_t frames, uint32_t first, uint32_t count)
{
    uint32_t source = index;
    if (what == &troubles[GAP] && index >= first) {
        source = index + count;
    } else if (what == &troubles[BACK] && index >= first) {
        source = index - count;
    }
    return source < frames ? source : UINT32_MAX;
}

void trouble_apply(const trouble *what, troubled_frame *frame, uint32_t index, uint32_t first, uint32_t count)
{
    if (what->apply != NULL && index >= first && (index < first + count || what->lasts)) {
        frame->since = index - first;
        frame->until = count;
        what->apply(frame);
    }
}
