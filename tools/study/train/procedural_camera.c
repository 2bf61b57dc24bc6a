/* SPDX-License-Identifier: Apache-2.0 */
#include "procedural.h"

#include <string.h>

void look_draw(camera_look *made, generator *g)
{
    float noisy = draw(g);
    made->exposure = 1.0f;
    for (int i = 0; i < 3; i++) {
        made->balance[i] = 1.0f + 0.03f * draw_normal(g);
    }
    made->vignette = draw_chance(g, 0.6f) ? draw_in(g, 0.0f, 0.4f) : 0.0f;
    made->blur = draw_in(g, 0.2f, 0.6f);
    made->sharpen = draw_chance(g, 0.6f) ? draw_in(g, 0.0f, 0.8f) : 0.0f;
    made->contrast = draw_in(g, 0.3f, 1.3f);
    made->shot_noise = 0.02f * noisy * noisy * noisy * noisy + 0.001f;
    made->read_noise = 0.25f * made->shot_noise;
    made->saturation = draw_in(g, 0.8f, 1.3f);
}

float look_exposure(const float *linear, int width, int height, float key)
{
    /* Lightness in half stops from 2^-12, without a logarithm per pixel */
    uint32_t bins[64] = {0}, count = (uint32_t)(width * height), above = 0;
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        float y = 0.3f * linear[3 * i] + 0.6f * linear[3 * i + 1] + 0.1f * linear[3 * i + 2];
        int exponent;
        float mantissa = frexpf(clampf(y, 0x1p-12f, 0x1p12f), &exponent);
        int bin = 2 * (exponent + 12) + (mantissa >= 0.70710678f);
        bins[bin]++;
        sum += (double)exponent + 2.0 * (double)mantissa - 2.5; /* log2 within 0.09, its mean error within 0.03 */
    }
    int top = 63;
    while (top > 0 && (above += bins[top]) < count / 50) {
        top--;
    }
    float white = exp2f(0.5f * (float)(top + 1) - 12.5f);
    float gain = key / exp2f((float)(sum / count) + 0.5f);
    return minf(gain, maxf(1.1f / white, 0.6f * gain)); /* a window may burn out before the room gets too dark */
}

/* Computes a running mean of 2 r + 1 samples, borders repeated; from and to do not overlap */
static void running_mean(const float *from, float *to, int count, int stride, int r)
{
    float scale = 1.0f / (float)(2 * r + 1), sum = from[0] * (float)(r + 1);
    for (int i = 1; i <= r; i++) {
        sum += from[(i < count ? i : count - 1) * stride];
    }
    for (int i = 0; i < count; i++) {
        to[i * stride] = sum * scale;
        int enter = i + r + 1 < count ? i + r + 1 : count - 1, leave = i - r > 0 ? i - r : 0;
        sum += from[enter * stride] - from[leave * stride];
    }
}

/* Runs a column pass row by row, so that memory is read in order; sums has a row's length */
static void running_mean_rows(const float *from, float *to, int row, int rows, int r, float *sums)
{
    float scale = 1.0f / (float)(2 * r + 1);
    for (int i = 0; i < row; i++) {
        sums[i] = from[i] * (float)(r + 1);
    }
    for (int y = 1; y <= r; y++) {
        const float *add = from + (y < rows ? y : rows - 1) * row;
        for (int i = 0; i < row; i++) {
            sums[i] += add[i];
        }
    }
    for (int y = 0; y < rows; y++) {
        const float *enter = from + (y + r + 1 < rows ? y + r + 1 : rows - 1) * row;
        const float *leave = from + (y - r > 0 ? y - r : 0) * row;
        for (int i = 0; i < row; i++) {
            to[y * row + i] = sums[i] * scale;
            sums[i] += enter[i] - leave[i];
        }
    }
}

/* Blurs with weights [1 - 2 k, k] of variance sigma^2, for sigma below a pixel */
static void small_blur(float *data, float *scratch, int width, int height, int channels, float sigma)
{
    float k = minf(0.5f * sigma * sigma, 0.25f);
    int row = width * channels;
    for (int y = 0; y < height; y++) {
        float *line = data + y * row, *out = scratch + y * row;
        for (int c = 0; c < channels; c++) {
            out[c] = line[c] + k * (line[channels + c] - line[c]);
            out[row - channels + c] =
                line[row - channels + c] + k * (line[row - 2 * channels + c] - line[row - channels + c]);
        }
        for (int i = channels; i < row - channels; i++) {
            out[i] = line[i] + k * (line[i - channels] + line[i + channels] - 2.0f * line[i]);
        }
    }
    for (int y = 0; y < height; y++) {
        const float *up = scratch + (y ? y - 1 : 0) * row, *here = scratch + y * row;
        const float *down = scratch + (y + 1 < height ? y + 1 : y) * row;
        for (int i = 0; i < row; i++) {
            data[y * row + i] = here[i] + k * (up[i] + down[i] - 2.0f * here[i]);
        }
    }
}

void blur_planes(float *data, float *scratch, int width, int height, int channels, float sigma)
{
    if (sigma < 0.9f) {
        small_blur(data, scratch, width, height, channels, sigma);
        return;
    }
    /* a mean of n samples has the variance (n^2 - 1) / 12; two in each direction make a tent */
    int r = floori(0.5f * sqrtf(6.0f * sigma * sigma + 1.0f));
    int row = width * channels;
    float sums[3 * 2048 + 2048];
    for (int pass = 0; pass < 2; pass++) {
        for (int y = 0; y < height; y++) {
            for (int c = 0; c < channels; c++) {
                running_mean(data + y * row + c, scratch + y * row + c, width, channels, r);
            }
        }
        running_mean_rows(scratch, data, row, height, r, sums);
    }
}

/* sRGB with an S-curve mixed in, 0..1 to 0..1 over 1024 steps of the square root: fine steps where the curve is steep
 */
enum { TONE_STEPS = 1024 };

static void tone_curve(float *curve, float contrast)
{
    for (int i = 0; i <= TONE_STEPS; i++) {
        float root = (float)i / TONE_STEPS, x = root * root;
        float s = x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f;
        curve[i] = s + contrast * (s * s * (3.0f - 2.0f * s) - s);
    }
}

int pixel_owners(const uint16_t *owner, int width, int x, int y, seen found[SUBSAMPLES * SUBSAMPLES])
{
    int count = 0;
    const float step = 1.0f / SUBSAMPLES, first = 0.5f * step - 0.5f;
    for (int j = 0; j < SUBSAMPLES; j++) {
        const uint16_t *row = owner + (size_t)(y * SUBSAMPLES + j) * width * SUBSAMPLES + x * SUBSAMPLES;
        for (int i = 0; i < SUBSAMPLES; i++) {
            int k = 0;
            while (k < count && found[k].owner != row[i]) {
                k++;
            }
            if (k == count) {
                found[count++] = (seen){.owner = row[i]};
            }
            found[k].count += 1.0f;
            found[k].x += first + step * (float)i;
            found[k].y += first + step * (float)j;
        }
    }
    return count;
}

void develop(const camera_look *look, generator *noise, int width, int height, float *linear, float *scratch,
             uint8_t *image)
{
    float curve[TONE_STEPS + 2];
    int count = width * height;
    tone_curve(curve, look->contrast);
    curve[TONE_STEPS + 1] = curve[TONE_STEPS];
    blur_planes(linear, scratch, width, height, 3, look->blur);
    float half_x = 0.5f * (float)(width - 1), half_y = 0.5f * (float)(height - 1);
    float corner = 1.0f / (half_x * half_x + half_y * half_y);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            float *p = linear + 3 * (y * width + x), dx = (float)x - half_x, dy = (float)y - half_y;
            float away = (dx * dx + dy * dy) * corner;
            float gain = look->exposure * (1.0f - look->vignette * away * (2.0f - away));
            for (int c = 0; c < 3; c++) {
                float v = p[c] * gain * look->balance[c];
                /* shoulder: the brightest stop is compressed instead of cut */
                v = v > 0.8f ? 0.8f + 0.2f * (v - 0.8f) / (v - 0.6f) : v;
                float sigma = look->read_noise + look->shot_noise * sqrtf(maxf(v, 0.0f));
                p[c] = maxf(v + sigma * draw_normal(noise), 0.0f);
            }
        }
    }
    for (int i = 0; i < count; i++) {
        float *p = linear + 3 * i, grey = 0.0f;
        for (int c = 0; c < 3; c++) {
            float at = minf(sqrtf(p[c]), 1.0f) * TONE_STEPS;
            int k = (int)at;
            p[c] = curve[k] + (at - (float)k) * (curve[k + 1] - curve[k]);
            grey += c == 1 ? 0.6f * p[c] : 0.2f * p[c];
        }
        for (int c = 0; c < 3; c++) {
            p[c] = grey + look->saturation * (p[c] - grey);
        }
    }
    if (look->sharpen > 0.0f) {
        float *soft = scratch; /* the unsharp mask is a 3 x 3 binomial, so no further buffer is needed */
        memcpy(soft, linear, (size_t)count * 3 * sizeof *soft);
        for (int y = 1; y + 1 < height; y++) {
            for (int i = 3; i < 3 * (width - 1); i++) {
                const float *p = soft + 3 * y * width + i;
                int row = 3 * width;
                float around = 0.125f * (p[-3] + p[3] + p[-row] + p[row]) +
                               0.0625f * (p[-row - 3] + p[-row + 3] + p[row - 3] + p[row + 3]);
                linear[3 * y * width + i] = p[0] + look->sharpen * (0.75f * p[0] - around);
            }
        }
    }
    for (int i = 0; i < 3 * count; i++) {
        image[i] = (uint8_t)(clampf(linear[i], 0.0f, 1.0f) * 255.0f + 0.5f);
    }
}
