/* SPDX-License-Identifier: Apache-2.0 */
/* The program with the learned head in floats: for any requested network, the float head in the file named by
 * T3R_FLOAT_HEAD gives the outputs, rounded only to their 16 bits. Everything else is the runtime's, so the difference
 * of its score to the program's is the cost of quantization.
 *
 * The linker puts the functions below before the runtime's: --wrap=t3r_head_learned, --wrap=t3r_network_points. One
 * thread, as the library's heads run. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "float_run.h"
#include "head/head.h"
#include "head/head_features.h"
#include "head/network.h"
#include "host/file_bytes.h"

static const double scale[T3R_HEAD_OUTPUTS] = {16384, 16384, 8192, 8192, 16384, 32768, 8192, 8192, 8192};
static const float_plane *outputs; /* of the current view */

t3r_head_rows __real_t3r_head_learned, __wrap_t3r_head_learned;
void __wrap_t3r_network_points(const t3r_network *net, uint32_t y, uint32_t count, const uint32_t *x,
                               const int8_t (*features)[T3R_FEATURES], int16_t (*out)[T3R_HEAD_OUTPUTS]);

static void give_up(const char *why)
{
    fprintf(stderr, "trim3r in floats: %s\n", why);
    exit(1);
}

static const float_head *the_head(void)
{
    static float_head head;
    static int read;
    char error[512];
    size_t count;
    if (!read) {
        const char *path = getenv("T3R_FLOAT_HEAD");
        if (path == NULL) {
            give_up("T3R_FLOAT_HEAD names no file");
        }
        uint8_t *file = t3r_file_bytes(path, SIZE_MAX, &count, error, sizeof error);
        if (file == NULL || float_head_parse(&head, file, count, error, sizeof error) != 0) {
            give_up(error);
        }
        free(file);
        read = 1;
    }
    return &head;
}

uint32_t __wrap_t3r_head_learned(const t3r_head_input *input, uint32_t begin, uint32_t end, t3r_gaussian *out)
{
    const t3r_view *view = input->map.view;
    size_t pixels = (size_t)view->width * view->height, row = (size_t)view->width * T3R_FEATURES;
    int8_t *features = malloc(row * view->height);
    uint8_t *retained = malloc(pixels);
    float_planes planes;
    if (features == NULL || retained == NULL) {
        give_up("out of memory");
    }
    for (uint32_t y = 0; y < view->height; y++) {
        t3r_head_features(input, y, features + y * row);
    }
    for (size_t i = 0; i < pixels; i++) {
        retained[i] = t3r_retained(view, i);
    }
    const float_head *head = the_head();
    if (float_run(&planes, head, features, retained, view->width, view->height) != 0) {
        give_up("out of memory");
    }
    outputs = &planes.planes[head->graph.count];
    uint32_t count = __real_t3r_head_learned(input, begin, end, out);
    float_planes_free(&planes);
    free(retained);
    free(features);
    return count;
}

void __wrap_t3r_network_points(const t3r_network *net, uint32_t y, uint32_t count, const uint32_t *x,
                               const int8_t (*features)[T3R_FEATURES], int16_t (*out)[T3R_HEAD_OUTPUTS])
{
    (void)net;
    (void)features;
    for (uint32_t i = 0; i < count; i++) {
        const float *made = outputs->values + ((size_t)y * outputs->width + x[i]) * outputs->channels;
        for (int o = 0; o < T3R_HEAD_OUTPUTS; o++) {
            out[i][o] = (int16_t)fmin(fmax(floor(made[o] * scale[o] + 0.5), INT16_MIN), INT16_MAX);
        }
    }
}
