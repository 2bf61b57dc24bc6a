/* SPDX-License-Identifier: Apache-2.0 */
/* Rows of frames, and the blur. */
#include "checks.h"
#include "guarded.h"

enum { MOST = 700 };

static uint8_t *random_bytes(uint64_t *seed, size_t count)
{
    uint8_t *bytes = guarded_take(count, 1);
    for (size_t i = 0; i < count; i++) {
        bytes[i] = (uint8_t)any_value(seed, 0, 255);
    }
    return bytes;
}

/* Whether the colour follows BT.601 of SPEC.md, in doubles that hold it exactly. */
static bool is_rgb(int y, int u, int v, uint8_t r, uint8_t g, uint8_t b)
{
    const double luma = 9539.0 * (y - 16),
                 want[3] = {luma + 13075.0 * (v - 128), luma - 3209.0 * (u - 128) - 6660.0 * (v - 128),
                            luma + 16525.0 * (u - 128)};
    const uint8_t got[3] = {r, g, b};
    for (int c = 0; c < 3; c++) {
        if (got[c] != fmin(fmax(floor(want[c] / 8192 + 0.5), 0), 255)) {
            return false;
        }
    }
    return true;
}

const char *check_packed_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST) / 2 * 2, y_at = unit_random(seed) % 2, u_at = 1 - y_at;
    const uint8_t *in = random_bytes(seed, 2 * (size_t)count);
    uint8_t *r = guarded_take(count, 1), *g = guarded_take(count, 1), *b = guarded_take(count, 1);
    kernels->packed_row(in, count, y_at, u_at, r, g, b);
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t *pair = in + i / 2 * 4;
        if (!is_rgb(pair[y_at + i % 2 * 2], pair[u_at], pair[u_at + 2], r[i], g[i], b[i])) {
            return "a pixel differs";
        }
    }
    return NULL;
}

const char *check_nv12_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST) / 2 * 2;
    const uint8_t *luma = random_bytes(seed, count), *chroma = random_bytes(seed, count);
    uint8_t *r = guarded_take(count, 1), *g = guarded_take(count, 1), *b = guarded_take(count, 1);
    kernels->nv12_row(luma, chroma, count, r, g, b);
    for (uint32_t i = 0; i < count; i++) {
        if (!is_rgb(luma[i], chroma[i / 2 * 2], chroma[i / 2 * 2 + 1], r[i], g[i], b[i])) {
            return "a pixel differs";
        }
    }
    return NULL;
}

const char *check_triple_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST);
    const uint8_t *in = random_bytes(seed, 3 * (size_t)count);
    uint8_t *a = guarded_take(count, 1), *b = guarded_take(count, 1), *c = guarded_take(count, 1);
    kernels->triple_row(in, count, a, b, c);
    for (uint32_t i = 0; i < count; i++) {
        if (a[i] != in[3 * i] || b[i] != in[3 * i + 1] || c[i] != in[3 * i + 2]) {
            return "a pixel differs";
        }
    }
    return NULL;
}

/* Sums unit by unit: sample u / sample_units is in box u / box_units. */
const char *check_box_sums(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t samples = (uint32_t)unit_between(seed, 1, 200), boxes = (uint32_t)unit_between(seed, 1, 200);
    const uint32_t split = (uint32_t)unit_between(seed, 0, samples);
    const uint8_t *run = random_bytes(seed, samples);
    uint32_t *sums = guarded_take(boxes * sizeof *sums, 4), want[200] = {0};
    memset(sums, 0, boxes * sizeof *sums);
    t3r_box_walk at = kernels->box_sums((t3r_box_walk){0, samples}, run, split, boxes, samples, sums);
    at = kernels->box_sums(at, run + split, samples - split, boxes, samples, sums);
    for (uint32_t unit = 0; unit < samples * boxes; unit++) {
        want[unit / samples] += run[unit / boxes];
    }
    return at.box == boxes && at.left == samples && SAME(sums, want, boxes) ? NULL : "a sum differs";
}

const char *check_weigh_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST), weight = (uint32_t)any_value(seed, 0, 2048);
    uint32_t *total = guarded_take(count * 4, 4), *sums = guarded_take(count * 4, 4), want[MOST];
    for (uint32_t i = 0; i < count; i++) {
        total[i] = (uint32_t)any_value(seed, 0, 1 << 30);
        sums[i] = (uint32_t)any_value(seed, 0, 1 << 20);
        want[i] = total[i] + weight * sums[i];
    }
    kernels->weigh_row(total, sums, weight, count);
    return SAME(total, want, count) ? NULL : "a total differs";
}

const char *check_divide_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST), area = (uint32_t)any_value(seed, 1, 1 << 24);
    uint32_t *total = guarded_take(count * 4, 4);
    uint8_t *out = guarded_take(count, 1), want[MOST];
    for (uint32_t i = 0; i < count; i++) {
        total[i] = (uint32_t)any_value(seed, 0, (int64_t)255 * area);
        want[i] = (uint8_t)floor(total[i] / (double)area + 0.5);
    }
    kernels->divide_row(total, area, count, out);
    for (uint32_t i = 0; i < count; i++) {
        if (total[i] != 0) {
            return "a total is left";
        }
    }
    return SAME(out, want, count) ? NULL : "a quotient differs";
}

static uint16_t *random_words(uint64_t *seed, size_t count)
{
    uint16_t *words = guarded_take(count * 2, 2);
    for (size_t i = 0; i < count; i++) {
        words[i] = (uint16_t)any_value(seed, 0, 65535);
    }
    return words;
}

const char *check_blur_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t width = 1 + any_length(seed, MOST);
    const uint16_t *row = random_words(seed, width);
    uint16_t *out = guarded_take(width * sizeof *out, 2);
    kernels->blur_row(row, width, out);
    for (int64_t x = 0; x < width; x++) {
        uint32_t sum = 12;
        for (int64_t a = -2; a <= 2; a++) { /* a box of five samples, applied twice */
            for (int64_t b = -2; b <= 2; b++) {
                int64_t place = x + a + b;
                sum += row[place < 0 ? 0 : place >= width ? width - 1 : place];
            }
        }
        if (out[x] != sum / 25) {
            return "a sample differs";
        }
    }
    return NULL;
}

const char *check_blur_column(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t width = 1 + any_length(seed, MOST);
    const uint16_t *rows[T3R_BLUR_TAPS];
    for (uint32_t i = 0; i < T3R_BLUR_TAPS; i++) {
        rows[i] = i > 0 && unit_random(seed) % 3 == 0 ? rows[i - 1] : random_words(seed, width);
    }
    uint16_t *out = guarded_take(width * sizeof *out, 2);
    kernels->blur_column(rows, width, out);
    for (uint32_t x = 0; x < width; x++) {
        uint32_t sum = 12;
        for (uint32_t a = 0; a < 5; a++) {
            for (uint32_t b = 0; b < 5; b++) {
                sum += rows[a + b][x];
            }
        }
        if (out[x] != sum / 25) {
            return "a sample differs";
        }
    }
    return NULL;
}
