/* SPDX-License-Identifier: Apache-2.0 */
#include <string.h>

#include "study/stress/perturbation.h"

static void paint(stress_capture *capture, double percent, uint8_t r, uint8_t g, uint8_t b)
{
    size_t rows = (size_t)(capture->height * percent / 100 + 0.5);
    for (uint32_t v = 0; v < capture->views; v++) {
        for (size_t i = 0; i < rows * capture->width; i++) {
            uint8_t *pixel = &capture->view[v].rgb[i * 3];
            pixel[0] = r;
            pixel[1] = g;
            pixel[2] = b;
        }
    }
}

bool perturb_black(stress_capture *capture, double percent, uint32_t seed)
{
    (void)seed;
    paint(capture, percent, 0, 0, 0);
    return true;
}

bool perturb_white_frame(stress_capture *capture, double percent, uint32_t seed)
{
    (void)seed;
    paint(capture, percent, 255, 255, 255);
    return true;
}

bool perturb_one_colour(stress_capture *capture, double percent, uint32_t seed)
{
    (void)seed;
    paint(capture, percent, 200, 40, 120);
    return true;
}

bool perturb_identical(stress_capture *capture, double kind, uint32_t seed)
{
    (void)seed;
    size_t pixels = (size_t)capture->width * capture->height;
    for (uint32_t v = 1; v < capture->views && kind > 0; v++) {
        memcpy(capture->view[v].rgb, capture->view[0].rgb, pixels * 3);
        if (kind < 3) {
            memcpy(capture->view[v].depth, capture->view[0].depth, pixels * sizeof(uint16_t));
        }
        if (kind < 2) {
            capture->view[v].camera = capture->view[0].camera;
        }
    }
    return true;
}

static void mirror(stress_capture *capture, uint32_t v, bool depth_too)
{
    uint32_t width = capture->width;
    for (uint32_t y = 0; y < capture->height; y++) {
        uint8_t *rgb = &capture->view[v].rgb[(size_t)y * width * 3];
        uint16_t *depth = &capture->view[v].depth[(size_t)y * width];
        for (uint32_t x = 0; x < width / 2; x++) {
            uint32_t other = width - 1 - x;
            uint8_t pixel[3];
            memcpy(pixel, rgb + 3 * x, 3);
            memcpy(rgb + 3 * x, rgb + 3 * other, 3);
            memcpy(rgb + 3 * other, pixel, 3);
            if (depth_too) {
                uint16_t steps = depth[x];
                depth[x] = depth[other];
                depth[other] = steps;
            }
        }
    }
}

bool perturb_mirrored(stress_capture *capture, double kind, uint32_t seed)
{
    (void)seed;
    if (kind > 0) {
        for (uint32_t v = kind >= 3 ? 0 : capture->views - 1; v < capture->views; v++) {
            mirror(capture, v, kind >= 2);
        }
    }
    return true;
}
