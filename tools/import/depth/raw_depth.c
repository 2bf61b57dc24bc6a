#include "import/depth/raw_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/file_bytes.h"
#include "host/little_floats.h"
#include "host/reason.h"
#include "trim3r.h"

enum { HEADER_BYTES_MOST = 32 };

/* The numbers of a file. */
typedef struct numbers {
    const uint8_t *at;
    uint32_t width, height;
} numbers;

static size_t count_of(const numbers *n)
{
    return (size_t)n->width * n->height;
}

static float number_of(const numbers *n, size_t index)
{
    return t3r_load_float(n->at + 4 * index);
}

/* Reads "123&" at *at, which moves past it; 0: there is no number of 1..T3R_MAX_SIDE. */
static uint32_t read_side(const uint8_t *bytes, size_t count, size_t *at)
{
    uint32_t side = 0;
    while (*at < count && bytes[*at] >= '0' && bytes[*at] <= '9' && side <= T3R_MAX_SIDE) {
        side = 10 * side + (uint32_t)(bytes[(*at)++] - '0');
    }
    return *at < count && bytes[(*at)++] == '&' && side <= T3R_MAX_SIDE ? side : 0;
}

/* Returns NULL, or what is wrong. */
static const char *find_numbers(const uint8_t *bytes, size_t count, const raw_depth *raw, numbers *out)
{
    size_t at = 0;
    *out = (numbers){bytes, raw->width, raw->height};
    if (raw->kind == RAW_DEPTH_COLMAP) {
        out->width = read_side(bytes, count, &at);
        out->height = read_side(bytes, count, &at);
        if (out->width == 0 || out->height == 0 || read_side(bytes, count, &at) != 1) {
            return "it does not begin with width&height&1& of a depth map";
        }
        out->at += at;
    }
    return count - at < count_of(out) * 4   ? "fewer bytes than its sides need"
           : count - at > count_of(out) * 4 ? "more bytes than its sides need"
                                            : NULL;
}

uint16_t raw_depth_step(float length, double unit)
{
    const double steps = nearbyint((double)length / unit);
    return steps >= 1 && steps <= UINT16_MAX ? (uint16_t)steps : 0;
}

int raw_depth_parse(const uint8_t *bytes, size_t count, const raw_depth *raw, picture *out, char *error,
                    size_t error_bytes)
{
    numbers n;
    const char *wrong = find_numbers(bytes, count, raw, &n);
    uint16_t *samples = wrong == NULL ? malloc(count_of(&n) * sizeof *samples + 1) : NULL;
    if (samples == NULL) {
        return t3r_reason(error, error_bytes, "%s", wrong != NULL ? wrong : "out of memory");
    }
    for (size_t i = 0; i < count_of(&n); i++) {
        samples[i] = raw_depth_step(number_of(&n, i), raw->unit);
    }
    *out = (picture){.width = n.width, .height = n.height, .channels = 1, .bits = 16, .samples = samples};
    return 0;
}

static uint8_t *read_bytes(const char *path, const raw_depth *raw, size_t *count, char *error, size_t error_bytes)
{
    const size_t most = raw->kind == RAW_DEPTH_PLAIN ? (size_t)raw->width * raw->height * 4
                                                     : (size_t)T3R_MAX_SIDE * T3R_MAX_SIDE * 4 + HEADER_BYTES_MOST;
    return t3r_file_bytes(path, most, count, error, error_bytes);
}

int raw_depth_read(const char *path, const raw_depth *raw, picture *out, char *error, size_t error_bytes)
{
    size_t count;
    char reason[128];
    uint8_t *bytes = read_bytes(path, raw, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    const int status = raw_depth_parse(bytes, count, raw, out, reason, sizeof reason);
    free(bytes);
    return status == 0 ? 0 : t3r_reason(error, error_bytes, "%s: %s", path, reason);
}

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

double raw_depth_median(const char *path, const raw_depth *raw)
{
    size_t count, kept = 0;
    numbers n;
    uint8_t *bytes = read_bytes(path, raw, &count, NULL, 0);
    float *values = NULL;
    if (bytes != NULL && find_numbers(bytes, count, raw, &n) == NULL) {
        values = malloc(count_of(&n) * sizeof *values + 1);
    }
    for (size_t i = 0; values != NULL && i < count_of(&n); i++) {
        const float value = number_of(&n, i);
        if (value > 0 && isfinite(value)) {
            values[kept++] = value;
        }
    }
    if (kept > 0) {
        qsort(values, kept, sizeof *values, ascending);
    }
    const double median = kept > 0 ? (double)values[kept / 2] : 0;
    free(values);
    free(bytes);
    return median;
}
