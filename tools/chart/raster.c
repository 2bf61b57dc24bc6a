#include "chart/raster.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include <librsvg/rsvg.h>

#include "picture.h"
#include "reason.h"

#define SIDE_MOST 16384.0

/* Cairo's pixels (a word each, red in bits 16..23) to R G B; the picture's own ground covers all of it. */
static int write_surface(const char *path, cairo_surface_t *surface, uint32_t width, uint32_t height, char *error,
                         size_t error_bytes)
{
    cairo_surface_flush(surface);
    const unsigned char *data = cairo_image_surface_get_data(surface);
    int stride = cairo_image_surface_get_stride(surface);
    uint8_t *rgb = malloc((size_t)width * height * 3);
    if (rgb == NULL) {
        return t3r_reason(error, error_bytes, "%s: out of memory", path);
    }
    for (uint32_t y = 0; y < height; y++) {
        const uint32_t *row = (const uint32_t *)(const void *)(data + (size_t)y * (size_t)stride);
        uint8_t *out = rgb + (size_t)y * width * 3;
        for (uint32_t x = 0; x < width; x++) {
            out[3 * x] = (uint8_t)(row[x] >> 16);
            out[3 * x + 1] = (uint8_t)(row[x] >> 8);
            out[3 * x + 2] = (uint8_t)row[x];
        }
    }
    picture p = {.width = width, .height = height, .channels = 3, .bits = 8, .samples = rgb};
    int failed = picture_write_png(path, &p, error, error_bytes);
    free(rgb);
    return failed;
}

static int draw(const char *path, RsvgHandle *handle, double scale, char *error, size_t error_bytes)
{
    double wide, high;
    if (!rsvg_handle_get_intrinsic_size_in_pixels(handle, &wide, &high) || !(wide * scale <= SIDE_MOST) ||
        !(high * scale <= SIDE_MOST)) {
        return t3r_reason(error, error_bytes, "%s: a picture of more than 16384 pixels a side", path);
    }
    uint32_t width = (uint32_t)ceil(wide * scale), height = (uint32_t)ceil(high * scale);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)width, (int)height);
    cairo_t *cairo = cairo_create(surface);
    RsvgRectangle all = {0, 0, wide * scale, high * scale};
    GError *why = NULL;
    int failed = 0;
    if (!rsvg_handle_render_document(handle, cairo, &all, &why)) {
        failed = t3r_reason(error, error_bytes, "%s: %s", path, why->message);
        g_error_free(why);
    } else if (cairo_status(cairo) != CAIRO_STATUS_SUCCESS) {
        failed = t3r_reason(error, error_bytes, "%s: %s", path, cairo_status_to_string(cairo_status(cairo)));
    }
    cairo_destroy(cairo);
    if (failed == 0) {
        failed = write_surface(path, surface, width, height, error, error_bytes);
    }
    cairo_surface_destroy(surface);
    return failed;
}

int chart_raster_png(const char *path, const char *svg, size_t bytes, double scale, char *error, size_t error_bytes)
{
    GError *why = NULL;
    RsvgHandle *handle = rsvg_handle_new_from_data((const guint8 *)svg, bytes, &why);
    if (handle == NULL) {
        t3r_reason(error, error_bytes, "%s: %s", path, why->message);
        g_error_free(why);
        return -1;
    }
    int failed = draw(path, handle, scale, error, error_bytes);
    g_object_unref(handle);
    return failed;
}
