/* SPDX-License-Identifier: Apache-2.0 */
#include "drawn_case.h"

#include <string.h>

#include "core/fixed.h"
#include "rgbd_frame.h"
#include "weights_maker.h"

enum { LEAST_SIDE = 16, FREQUENT_SIDES = 13, MOST_CHANNELS_DRAWN = 5, MOST_BRIDGE = 64, MOST_GAUSSIANS = 400u };

/* Draws mostly small sides, because a build's time grows with its pixels. */
static uint32_t take_working_side(input *in, uint32_t least)
{
    const uint32_t extra = below(in, 16) == 15 ? 64 - LEAST_SIDE - FREQUENT_SIDES : 0;
    return least + extra + below(in, FREQUENT_SIDES);
}

/* Draws from a few of the points to more than a small picture has; the time of blending grows with the number. */
static uint32_t take_gaussians(input *in, uint32_t points)
{
    const uint32_t shift = below(in, 8), share_q7 = 1 + take8(in), drawn = 1 + (points >> shift) * share_q7 / 128;
    return T3R_MIN(drawn, MOST_GAUSSIANS);
}

static t3r_allocation allocation_for(t3r_allocation drawn, bool streams)
{
    return streams && drawn == T3R_ALLOCATE_GIVEN ? T3R_ALLOCATE_DENSITY : drawn;
}

/* Returns the head's need, or more, or the default; bits of `drawn` above the lowest eight choose the kind. */
static uint32_t head_column_bytes_for(const drawn_case *c, const t3r_config *k, uint32_t drawn)
{
    const uint32_t kind = drawn >> 8, more = drawn & 255;
    const uint32_t needed = t3r_head_column_bytes(c->weights, c->weights_bytes, k->width);
    return kind == 0 ? T3R_MAX(needed, T3R_HEAD_COLUMN_BYTES) : needed + (kind == 1 ? more : 0);
}

/* Returns the largest settings that keep a case small. */
static t3r_config most_drawn(void)
{
    t3r_config most = most_settings();
    most.clusters = 43;
    most.cluster_batches = 3;
    most.head_column_bytes = 767;
    most.refine = 2;
    most.depth = 0; /* by the case, as stream is */
    most.bridge_radius = MOST_BRIDGE - 1;
    most.stream = 0;
    most.half_life = 3;
    most.remember = 3;
    most.workers = 1;
    most.tile_splats = 159;
    most.seed = 255;
    return most;
}

static t3r_config take_case(input *in, const drawn_case *c, bool stereo)
{
    const bool streams = c->tells == STREAM;
    const uint32_t least = stereo ? T3R_STEREO_LEAST_SIDE : LEAST_SIDE;
    const uint32_t width = take_working_side(in, least), height = take_working_side(in, least);
    const uint32_t drawn = 1 + below(in, 4), views = stereo && drawn == 1 ? 2 : drawn;
    const uint32_t gaussians = take_gaussians(in, width * height * views), budget = take_gaussians(in, gaussians);
    t3r_config k = t3r_default_config(width, height, views, gaussians);
    k.gaussians = T3R_MIN(budget, gaussians);
    k.render_width = LEAST_SIDE + below(in, 2 * FREQUENT_SIDES);
    k.render_height = LEAST_SIDE + below(in, 2 * FREQUENT_SIDES);
    const t3r_config most = most_drawn();
    take_settings(in, SETTING_AT(wavelet), &most, &k);
    k.clusters = k.clusters < 40 ? 1 + k.clusters : 0;
    k.allocate = allocation_for(k.allocate, streams);
    k.head_column_bytes = head_column_bytes_for(c, &k, k.head_column_bytes);
    k.depth = stereo ? T3R_DEPTH_STEREO : T3R_DEPTH_SENSOR;
    k.warm = (k.warm && streams) || c->tells == SLIDE;
    k.stream = streams;
    k.tile_splats = k.tile_splats < 40 ? k.tile_splats : 0;
    return k;
}

/* Draws layers of every kind, two sources, phases; few channels, sometimes an odd number. */
static void take_weights(input *in, drawn_case *c)
{
    const uint16_t a = (uint16_t)(3 + below(in, MOST_CHANNELS_DRAWN)),
                   b = (uint16_t)(3 + below(in, MOST_CHANNELS_DRAWN));
    const uint8_t wide = (uint8_t)(1 + below(in, 6)), narrow = (uint8_t)(1 + below(in, 5));
    const uint8_t phases = (uint8_t)(below(in, 2) == 0 ? 1 : 4);
    const made_layer shape[] = {
        {T3R_LAYER_CONV, 1, {T3R_SOURCE_FEATURES, T3R_SOURCE_NONE}, wide, 2, 1, a},
        {T3R_LAYER_DEPTHWISE, 1, {1, T3R_SOURCE_NONE}, narrow, 1, 1, a},
        {T3R_LAYER_CONV, 2, {2, T3R_SOURCE_NONE}, 3, 2, 1, b},
        {T3R_LAYER_CONV, 1, {2, 3}, narrow, 1, 1, b},
        {T3R_LAYER_POINT, 0, {4, T3R_SOURCE_FEATURES}, 1, 1, phases, a},
        {T3R_LAYER_POINT, 0, {5, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS},
    };
    const uint32_t bits = below(in, 4), seed = take8(in);
    c->weights = make_weights(shape, sizeof shape / sizeof *shape, bits & 1 ? 16 : 8, bits & 2 ? 16 : 8, seed,
                              &c->weights_bytes);
    REQUIRE(t3r_weights_error(c->weights, c->weights_bytes) == NULL);
}

/* Draws blobs with ties, one plane for all views. */
static void take_importance(input *in, drawn_case *c)
{
    const uint32_t cell = 1 + below(in, 9), seed = take8(in), width = c->config.width, height = c->config.height;
    c->importance = allocate((size_t)width * height * sizeof *c->importance);
    for (uint32_t i = 0; i < width * height; i++) {
        c->importance[i] = (uint16_t)(t3r_mix32(seed << 16 | i / width / cell << 8 | i % width / cell) % 50 * 1000);
    }
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        c->planes[v] = c->importance;
    }
}

static t3r_request take_request(input *in, const drawn_case *c)
{
    const uint32_t parts = take8(in), loss_q8 = 1 + below(in, T3R_MAX_LOSS_Q8);
    const bool bounds = parts % 16 == 7 && c->config.keep_analysis && c->config.refine > 0;
    const uint32_t drawn = take_gaussians(in, c->config.max_gaussians);
    t3r_request request = {.gaussians = T3R_MIN(drawn, c->config.max_gaussians),
                           .max_loss_q8 = bounds ? loss_q8 : 0,
                           .allocate = T3R_ALLOCATE_CONFIGURED + 1 + below(in, T3R_ALLOCATE_COUNT - 1),
                           .head = T3R_HEAD_CONFIGURED + 1 + below(in, T3R_HEAD_COUNT - 1)};
    if (parts & 32) {
        request.gaussians = 0;
    }
    if (parts & 64) {
        request.allocate = T3R_ALLOCATE_CONFIGURED;
    }
    if (parts & 128) {
        request.head = T3R_HEAD_CONFIGURED;
    }
    const t3r_allocation allocation = request.allocate != 0 ? request.allocate : c->config.allocate;
    if (allocation == T3R_ALLOCATE_GIVEN) {
        request.importance = c->planes;
        request.importance_stride_bytes = c->config.width * 2;
    }
    return request;
}

static scenery take_scenery(input *in)
{
    scenery s = {.cell = 1 + below(in, 8), .contrast = take8(in), .distance = 400 + 8u * take8(in)};
    s.relief = below(in, 4) * s.distance / 8;
    const uint32_t noise = below(in, 200), lost = below(in, 80), black = below(in, 96);
    s.noise = noise < 100 ? noise : 0;
    s.lost = lost < 40 ? 0 : lost - 38;
    s.hole = below(in, 16);
    s.black = black < 12 ? black : 0;
    for (int i = 0; i < 3; i++) {
        s.colours[i] = take8(in);
    }
    s.seed = take8(in);
    return s;
}

/* Draws a format; some frames have the working size. NV12 and 4:2:2 have even sides. */
static t3r_frame take_format(input *in, const t3r_config *config)
{
    t3r_frame f = {.format = below(in, T3R_PIXEL_FORMAT_COUNT)};
    const uint32_t wider = below(in, 40), higher = below(in, 40), even = f.format >= T3R_PIXEL_YUYV ? 1 : 0;
    f.width = (config->width + (wider < 20 ? 0 : wider - 20) + even) & ~even;
    f.height = (config->height + (higher < 20 ? 0 : higher - 20) + even) & ~even;
    const bool coarse = below(in, 4) == 3;
    f.depth_width = coarse ? f.width / 2 : f.width;
    f.depth_height = coarse ? f.height / 2 : f.height;
    f.depth_unit_q40 = MILLIMETRE_Q40;
    return f;
}

/* Draws a camera near the origin that looks at the wall, slightly rotated. World units are 2^-4 to 2^4 m. */
static t3r_camera take_pose(input *in, const t3r_frame *frame, uint32_t world_shift)
{
    const uint32_t focal = frame->width * (2 + below(in, 5)) / 4;
    t3r_camera camera = {.fx_q16 = (int32_t)(T3R_MAX(focal, 16u) << 16),
                         .fy_q16 = (int32_t)((T3R_MAX(focal, 16u) << 16) + (below(in, 256) << 8)),
                         .cx_q16 = (int32_t)((frame->width << 15) + (below(in, 256) << 8)),
                         .cy_q16 = (int32_t)((frame->height << 15) - (below(in, 256) << 8)),
                         .rotation_q30 = {1 << 30}};
    for (int i = 0; i < 3; i++) {
        const int64_t step = (int64_t)below(in, 65) - 32; /* up to 0.25 m */
        camera.position_q32[i] = step * (INT64_C(1) << (25 - 2 * (i > 0) - MOST_WORLD_SHIFT + (int)world_shift));
        camera.rotation_q30[1 + i] = ((int32_t)below(in, 33) - 16) * (1 << 21); /* up to 1/32 */
    }
    return camera;
}

static void take_lens(input *in, t3r_camera *camera)
{
    const uint32_t lens = below(in, 16);
    camera->distortion = lens < T3R_DISTORTION_COUNT ? lens : T3R_DISTORTION_NONE;
    for (int i = 0; i < 5; i++) {
        camera->distortion_q24[i] = ((int32_t)take8(in) - 128) * (i < 2 ? 4096 : 128);
    }
}

/* Returns the level of a pixel of that frame: spots of paint are fixed on the wall for all cameras. */
static uint8_t level_at(const drawn_case *c, uint32_t index, uint32_t x, uint32_t y, uint32_t channel, uint32_t depth)
{
    const scenery *s = &c->shows;
    const t3r_camera *camera = &c->camera[index];
    const uint64_t unit_q40 = c->frame.depth_unit_q40;
    int64_t at[2] = {x, y};
    for (int i = 0; i < 2 && depth > 0; i++) { /* |position| < 2^31, fx < 2^24, depth x unit >> 8 > 2^25 */
        at[i] += (camera->position_q32[i] * (camera->fx_q16 >> 8) / (int64_t)(depth * unit_q40 >> 8)) >> 8;
    }
    const uint32_t cell_x = (uint32_t)(at[0] + 1024) / s->cell, cell_y = (uint32_t)(at[1] + 1024) / s->cell;
    const uint32_t noise = t3r_mix32(s->seed << 24 ^ cell_x << 12 ^ cell_y) >> (8 * channel) & 255;
    const uint32_t level = (s->colours[channel] + noise * s->contrast / 256) * c->gain_q7[index] / 128;
    return (uint8_t)T3R_MIN(level, 255u);
}

/* Returns the wall's depth at a pixel of a picture of this width. */
static uint32_t depth_at(const scenery *s, uint32_t x, uint32_t y, uint32_t width)
{
    return s->distance + (x > width / 2 ? s->relief : 0) + y;
}

static uint32_t measured_at(const drawn_case *c, uint32_t index, uint32_t x, uint32_t y)
{
    const scenery *s = &c->shows;
    const uint32_t random = t3r_mix32(index << 24 ^ s->seed << 16 ^ x << 8 ^ y), width = c->frame.depth_width;
    const bool lost = s->lost != 0 && random % s->lost == 0;
    const bool in_hole = x - width / 3 < s->hole && y - c->frame.depth_height / 3 < s->hole;
    if (lost || in_hole || y < s->black) {
        return 0;
    }
    return depth_at(s, x, y, width) + (s->noise == 0 ? 0 : (random >> 8) % s->noise);
}

/* Returns the bytes of a pixel in the first plane; with NV12 the second plane has equal rows. */
static uint32_t bytes_of_pixel(t3r_pixel_format format)
{
    return format == T3R_PIXEL_RGB24 || format == T3R_PIXEL_BGR24 ? 3
           : format == T3R_PIXEL_YUYV || format == T3R_PIXEL_UYVY ? 2
                                                                  : 1;
}

held_frame frame_of(const drawn_case *c, uint32_t index, uint32_t padding)
{
    held_frame held = {.frame = c->frame};
    t3r_frame *f = &held.frame;
    const uint32_t pixel = bytes_of_pixel(f->format);
    for (int plane = 0; plane < (f->format == T3R_PIXEL_NV12 ? 2 : 1); plane++) {
        f->stride_bytes[plane] = f->width * pixel + padding;
        uint32_t row;
        const size_t bytes = plane_bytes(f, plane, &row);
        held.planes[plane] = allocate(bytes);
        f->planes[plane] = held.planes[plane];
        for (uint32_t y = 0; y < f->height >> plane; y++) {
            for (uint32_t i = 0; i < row && (y << plane) >= c->shows.black; i++) {
                const uint32_t x = i / pixel;
                held.planes[plane][(size_t)y * f->stride_bytes[plane] + i] =
                    level_at(c, index, x, y << plane, i % 3, depth_at(&c->shows, x, y << plane, f->width));
            }
        }
    }
    f->depth_stride_bytes = 2 * f->depth_width + padding;
    held.planes[2] = allocate((size_t)(f->depth_height - 1) * f->depth_stride_bytes + 2 * (size_t)f->depth_width);
    f->depth = held.planes[2];
    for (uint32_t y = 0; y < f->depth_height; y++) {
        uint8_t *row = held.planes[2] + (size_t)y * f->depth_stride_bytes;
        for (uint32_t x = 0; x < f->depth_width; x++) {
            const uint32_t depth = measured_at(c, index, x, y);
            row[2 * x] = (uint8_t)depth;
            row[2 * x + 1] = (uint8_t)(depth >> 8);
        }
    }
    return held;
}

void draw_case(input *in, drawn_case *c)
{
    static const story told[] = {ONE_BUILD, ONE_BUILD, ONE_BUILD, ONE_BUILD, SLIDE, SLIDE, STREAM, STREAM};
    memset(c, 0, sizeof *c);
    const uint32_t kind = below(in, 16);
    c->tells = told[kind % 8];
    take_weights(in, c);
    c->config = take_case(in, c, kind % 8 == 2 || kind % 8 == 3);
    const uint32_t more = 1 + below(in, 2), ablated = take8(in);
    c->frames = c->tells == ONE_BUILD ? c->config.views : T3R_MIN(c->config.views + more, MOST_FRAMES);
    c->ablation = (t3r_ablation){.shuffle = ablated % 8 == 1, .unadapted = ablated % 8 == 2};
    take_importance(in, c);
    c->first = take_request(in, c);
    c->again = take_request(in, c);
    c->again.gaussians = c->config.keep_analysis ? c->again.gaussians : 0;
    c->shows = take_scenery(in);
    c->frame = take_format(in, &c->config);
    const uint32_t world_shift = below(in, 2 * MOST_WORLD_SHIFT + 1);
    c->frame.depth_unit_q40 = c->frame.depth_unit_q40 >> MOST_WORLD_SHIFT << world_shift;
    for (uint32_t i = 0; i < MOST_FRAMES; i++) {
        c->camera[i] = take_pose(in, &c->frame, world_shift);
        c->gain_q7[i] = 96 + below(in, 65);
        take_lens(in, &c->camera[i]);
    }
    c->eye = take_pose(in, &c->frame, world_shift);
    c->eye_width = 1 + below(in, c->config.render_width);
    c->eye_height = 1 + below(in, c->config.render_height);
}

void free_case(drawn_case *c)
{
    free(c->importance);
    free(c->weights);
}
