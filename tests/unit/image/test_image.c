/* SPDX-License-Identifier: Apache-2.0 */
/* Frames to planes: refusals, formats against the real BT.601, the area average against exact sums. */
#include "unit/unit.h"

#include "image/image.h"

static const uint8_t some[64];

static t3r_frame plain_frame(void)
{
    t3r_frame frame = {T3R_PIXEL_RGB24, 4, 4, {some, NULL}, {12, 0}, NULL, 0, 0, 0, 0};
    return frame;
}

TEST(refusals)
{
    t3r_frame frame = plain_frame();
    assert_int_equal(t3r_image_check(&frame), T3R_OK);
    assert_int_equal(t3r_image_check(NULL), T3R_ERR_ARGUMENT);

#define REFUSED(change)                                                                                                \
    do {                                                                                                               \
        frame = plain_frame();                                                                                         \
        change;                                                                                                        \
        assert_int_equal(t3r_image_check(&frame), T3R_ERR_FRAME);                                                      \
    } while (0)
    REFUSED(frame.format = T3R_PIXEL_FORMAT_COUNT);
    REFUSED(frame.format = (t3r_pixel_format)-1);
    REFUSED(frame.width = 1);
    REFUSED(frame.height = 0);
    REFUSED(frame.width = T3R_MAX_SIDE + 1; frame.stride_bytes[0] = 20000);
    REFUSED(frame.height = UINT32_MAX);
    REFUSED(frame.width = UINT32_MAX);
    REFUSED(frame.planes[0] = NULL);
    REFUSED(frame.stride_bytes[0] = 11);
    REFUSED(frame.stride_bytes[0] = 1u << 19);
    REFUSED(frame.stride_bytes[0] = UINT32_MAX);
    REFUSED(frame.format = T3R_PIXEL_YUYV; frame.width = 3);
    REFUSED(frame.format = T3R_PIXEL_UYVY; frame.stride_bytes[0] = 7);
    REFUSED(frame.format = T3R_PIXEL_NV12);
    REFUSED(frame.format = T3R_PIXEL_NV12; frame.planes[1] = some; frame.stride_bytes[1] = 3);
    REFUSED(frame.format = T3R_PIXEL_NV12; frame.planes[1] = some; frame.stride_bytes[1] = 4; frame.height = 3);
#undef REFUSED
    frame = plain_frame();
    frame.format = T3R_PIXEL_NV12;
    frame.planes[1] = some;
    frame.stride_bytes[1] = 4;
    assert_int_equal(t3r_image_check(&frame), T3R_OK);
}

static t3r_frame deep_frame(void)
{
    t3r_frame frame = plain_frame();
    frame.depth = some;
    frame.depth_width = 4;
    frame.depth_height = 4;
    frame.depth_stride_bytes = 8;
    frame.depth_unit_q40 = 1099511628;
    return frame;
}

TEST(depth_refusals)
{
    t3r_frame frame = deep_frame();
    assert_int_equal(t3r_image_check(&frame), T3R_OK);
#define REFUSED(change)                                                                                                \
    do {                                                                                                               \
        frame = deep_frame();                                                                                          \
        change;                                                                                                        \
        assert_int_equal(t3r_image_check(&frame), T3R_ERR_FRAME);                                                      \
    } while (0)
    REFUSED(frame.depth_width = 1);
    REFUSED(frame.depth_width = T3R_MAX_SIDE + 1; frame.depth_stride_bytes = 20000);
    REFUSED(frame.depth_height = 0);
    REFUSED(frame.depth_stride_bytes = 7);
    REFUSED(frame.depth_stride_bytes = UINT32_MAX);
    REFUSED(frame.depth_unit_q40 = 0);
    REFUSED(frame.depth_unit_q40 = UINT64_MAX);
#undef REFUSED
}

static double clamped(double x)
{
    return x < 0 ? 0 : x > 255 ? 255 : x;
}

/* Computes limited-range BT.601 from its definition: Kr = 0.299, Kb = 0.114. */
static void real_rgb(double y, double u, double v, double rgb[3])
{
    const double kr = 0.299, kb = 0.114, kg = 1 - kr - kb;
    double luma = (y - 16) * 255 / 219, cb = (u - 128) * 255 / 112, cr = (v - 128) * 255 / 112;
    rgb[0] = clamped(luma + cr * (1 - kr));
    rgb[1] = clamped(luma - cb * (1 - kb) * kb / kg - cr * (1 - kr) * kr / kg);
    rgb[2] = clamped(luma + cb * (1 - kb));
}

typedef struct layout {
    t3r_pixel_format format;
    uint32_t y0, u, y1, v;
} layout;

/* Makes each Y with every third U and V, in rows of 256 pixels. */
TEST(packed_formats)
{
    const layout layouts[] = {{T3R_PIXEL_YUYV, 0, 1, 2, 3}, {T3R_PIXEL_UYVY, 1, 0, 3, 2}};
    const uint32_t height = 86;
    uint8_t *packed = unit_array(height, 520);
    uint8_t *planes[3];
    double worst = 0;
    for (int c = 0; c < 3; c++) {
        planes[c] = unit_array(height, 256);
    }
    for (uint32_t l = 0; l < 2; l++) {
        for (uint32_t u = 0; u < 256; u += 3) {
            for (uint32_t row = 0; row < height; row++) {
                for (uint32_t x = 0; x < 128; x++) {
                    uint8_t *pair = packed + row * 520 + x * 4;
                    pair[layouts[l].y0] = (uint8_t)(2 * x);
                    pair[layouts[l].y1] = (uint8_t)(2 * x + 1);
                    pair[layouts[l].u] = (uint8_t)u;
                    pair[layouts[l].v] = (uint8_t)(3 * row);
                }
            }
            t3r_frame frame = {layouts[l].format, 256, height, {packed, NULL}, {520, 0}, NULL, 0, 0, 0, 0};
            assert_int_equal(t3r_image_check(&frame), T3R_OK);
            t3r_image_colour(&t3r_kernels_c, &frame, 256, height, 0, height, planes, NULL);
            for (uint32_t at = 0; at < 256 * height; at++) {
                double rgb[3];
                real_rgb(at % 256, u, 3 * (at / 256), rgb);
                for (int c = 0; c < 3; c++) {
                    worst = fmax(worst, fabs(planes[c][at] - rgb[c]));
                }
            }
        }
    }
    assert_true(worst < 0.55);
    for (int c = 0; c < 3; c++) {
        free(planes[c]);
    }
    free(packed);
}

TEST(nv12)
{
    enum { W = 6, H = 4 };
    uint64_t seed = 5;
    uint8_t *luma = unit_array(H, 7);
    uint8_t *chroma = unit_array(H / 2, 9);
    uint8_t planes[3][W * H];
    uint8_t *out[3] = {planes[0], planes[1], planes[2]};
    for (int i = 0; i < H * 7; i++) {
        luma[i] = (uint8_t)unit_random(&seed);
    }
    for (int i = 0; i < H / 2 * 9; i++) {
        chroma[i] = (uint8_t)unit_random(&seed);
    }
    t3r_frame frame = {T3R_PIXEL_NV12, W, H, {luma, chroma}, {7, 9}, NULL, 0, 0, 0, 0};
    t3r_image_colour(&t3r_kernels_c, &frame, W, H, 0, H, out, NULL);
    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) {
            double rgb[3];
            const uint8_t *pair = chroma + y / 2 * 9 + x / 2 * 2;
            real_rgb(luma[y * 7 + x], pair[0], pair[1], rgb);
            for (int c = 0; c < 3; c++) {
                assert_true(fabs(planes[c][y * W + x] - rgb[c]) < 0.55);
            }
        }
    }
    free(luma);
    free(chroma);
}

TEST(plain_formats)
{
    const uint8_t bytes[] = {1, 2, 3, 4, 5, 6, 99, 7, 8, 9, 10, 11, 12, 99};
    uint8_t planes[3][4];
    uint8_t *out[3] = {planes[0], planes[1], planes[2]};
    t3r_frame frame = {T3R_PIXEL_RGB24, 2, 2, {bytes, NULL}, {7, 0}, NULL, 0, 0, 0, 0};
    t3r_image_colour(&t3r_kernels_c, &frame, 2, 2, 0, 2, out, NULL);
    assert_memory_equal(planes[0], ((uint8_t[]){1, 4, 7, 10}), 4);
    assert_memory_equal(planes[2], ((uint8_t[]){3, 6, 9, 12}), 4);
    frame.format = T3R_PIXEL_BGR24;
    t3r_image_colour(&t3r_kernels_c, &frame, 2, 2, 0, 2, out, NULL);
    assert_memory_equal(planes[0], ((uint8_t[]){3, 6, 9, 12}), 4);
    assert_memory_equal(planes[1], ((uint8_t[]){2, 5, 8, 11}), 4);
    frame.format = T3R_PIXEL_GREY;
    t3r_image_colour(&t3r_kernels_c, &frame, 2, 2, 0, 2, out, NULL);
    for (int c = 0; c < 3; c++) {
        assert_memory_equal(planes[c], ((uint8_t[]){1, 2, 7, 8}), 4);
    }
}

static uint64_t overlap(uint64_t i, uint64_t i_units, uint64_t j, uint64_t j_units)
{
    uint64_t start = i * i_units > j * j_units ? i * i_units : j * j_units;
    uint64_t end = (i + 1) * i_units < (j + 1) * j_units ? (i + 1) * i_units : (j + 1) * j_units;
    return end > start ? end - start : 0;
}

/* Computes the box average of one sample by its definition. */
static uint8_t box_average(const uint8_t *grey, uint32_t from_w, uint32_t from_h, uint32_t w, uint32_t h, uint32_t x,
                           uint32_t y)
{
    uint64_t sum = 0;
    uint64_t area = (uint64_t)from_w * from_h;
    for (uint32_t j = 0; j < from_h; j++) {
        uint64_t across = overlap(j, h, y, from_h);
        for (uint32_t i = 0; across != 0 && i < from_w; i++) {
            sum += across * overlap(i, w, x, from_w) * grey[j * from_w + i];
        }
    }
    return (uint8_t)((2 * sum + area) / (2 * area));
}

TEST(average)
{
    uint64_t seed = 11;
    for (int turn = 0; turn < 300; turn++) {
        uint32_t from_w = (uint32_t)unit_between(&seed, 2, 40), from_h = (uint32_t)unit_between(&seed, 2, 40);
        uint32_t w = (uint32_t)unit_between(&seed, 1, 40), h = (uint32_t)unit_between(&seed, 1, 40);
        w = turn % 10 == 0 ? from_w : w; /* one side is unchanged */
        h = turn % 10 == 1 ? from_h : h;
        uint8_t *grey = unit_array(from_w, from_h);
        uint8_t *planes[3];
        void *work = unit_array(t3r_image_work_bytes(w), 1);
        for (uint32_t i = 0; i < from_w * from_h; i++) {
            grey[i] = turn % 3 == 0 ? (uint8_t) - (unit_random(&seed) & 1) : (uint8_t)unit_random(&seed);
        }
        for (int c = 0; c < 3; c++) {
            planes[c] = unit_array(w, h);
        }
        t3r_frame frame = {T3R_PIXEL_GREY, from_w, from_h, {grey, NULL}, {from_w, 0}, NULL, 0, 0, 0, 0};
        t3r_image_colour(&t3r_kernels_c, &frame, w, h, 0, h, planes, work);
        for (uint32_t at = 0; at < w * h; at++) {
            uint8_t exact = box_average(grey, from_w, from_h, w, h, at % w, at / w);
            for (int c = 0; c < 3; c++) {
                assert_int_equal(planes[c][at], exact);
            }
        }
        for (int c = 0; c < 3; c++) {
            memset(planes[c], 0x5a, (size_t)w * h);
        }
        const uint32_t first = from_h / 2; /* the same in two strips */
        t3r_image_colour_strip(&t3r_kernels_c, &frame, w, h, 0, first, planes, work);
        frame.planes[0] = grey + (size_t)first * from_w;
        t3r_image_colour_strip(&t3r_kernels_c, &frame, w, h, first, from_h - first, planes, work);
        for (uint32_t at = 0; at < w * h; at++) {
            assert_int_equal(planes[1][at], box_average(grey, from_w, from_h, w, h, at % w, at / w));
        }
        for (int c = 0; c < 3; c++) {
            free(planes[c]);
        }
        free(work);
        free(grey);
    }
}

/* Rows longer than a chunk, and three different channels. */
TEST(average_wide)
{
    enum { W = 1003, H = 5, w = 77, h = 3 };
    uint64_t seed = 12;
    uint8_t *rgb = unit_array(W * H, 3);
    uint8_t *grey = unit_array(W, H);
    uint8_t *planes[3];
    void *work = unit_array(t3r_image_work_bytes(w), 1);
    for (int c = 0; c < 3; c++) {
        planes[c] = unit_array(w, h);
    }
    for (int i = 0; i < W * H * 3; i++) {
        rgb[i] = (uint8_t)unit_random(&seed);
    }
    t3r_frame frame = {T3R_PIXEL_RGB24, W, H, {rgb, NULL}, {W * 3, 0}, NULL, 0, 0, 0, 0};
    t3r_image_colour(&t3r_kernels_c, &frame, w, h, 0, h, planes, work);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < W * H; i++) {
            grey[i] = rgb[3 * i + c];
        }
        for (uint32_t at = 0; at < w * h; at++) {
            assert_int_equal(planes[c][at], box_average(grey, W, H, w, h, at % w, at / w));
        }
        free(planes[c]);
    }
    free(work);
    free(grey);
    free(rgb);
}

/* The largest possible sums: 4096 x 4096 white pixels. */
TEST(average_largest)
{
    const uint32_t side = T3R_MAX_SIDE;
    uint8_t *grey = unit_array(side, side);
    uint8_t planes[3][9 * 7];
    uint8_t *out[3] = {planes[0], planes[1], planes[2]};
    void *work = unit_array(t3r_image_work_bytes(9), 1);
    memset(grey, 255, (size_t)side * side);
    t3r_frame frame = {T3R_PIXEL_GREY, side, side, {grey, NULL}, {side, 0}, NULL, 0, 0, 0, 0};
    assert_int_equal(t3r_image_check(&frame), T3R_OK);
    t3r_image_colour(&t3r_kernels_c, &frame, 9, 7, 0, 7, out, work);
    for (int i = 0; i < 63; i++) {
        assert_int_equal(planes[0][i], 255);
        assert_int_equal(planes[2][i], 255);
    }
    free(work);
    free(grey);
}

TEST(depth)
{
    enum { W = 13, H = 6 };
    uint64_t seed = 3;
    uint8_t bytes[H][2 * W + 3];
    for (size_t i = 0; i < sizeof bytes; i++) {
        (&bytes[0][0])[i] = (uint8_t)unit_random(&seed);
    }
    const uint32_t sizes[][2] = {{W, H}, {5, 4}, {26, 12}, {1, 1}, {31, 3}};
    t3r_frame frame = deep_frame();
    frame.depth = &bytes[0][0];
    frame.depth_width = W;
    frame.depth_height = H;
    frame.depth_stride_bytes = sizeof bytes[0];
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        uint32_t w = sizes[s][0], h = sizes[s][1];
        uint16_t *out = unit_array((size_t)w * h, sizeof(uint16_t));
        t3r_image_depth(&frame, w, h, 0, h, out);
        for (uint32_t at = 0; at < w * h; at++) {
            int x = (int)floor((at % w + 0.5) * W / w), y = (int)floor((at / w + 0.5) * H / h);
            assert_int_equal(out[at], bytes[y][2 * x] + 256 * bytes[y][2 * x + 1]);
        }
        frame.depth = NULL;
        t3r_image_depth(&frame, w, h, 0, h, out);
        for (uint32_t at = 0; at < w * h; at++) {
            assert_int_equal(out[at], 0);
        }
        frame.depth = &bytes[0][0];
        free(out);
    }
}
