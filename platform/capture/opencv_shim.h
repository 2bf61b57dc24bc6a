/* SPDX-License-Identifier: Apache-2.0 */
/* The interface of OpenCV's module, in C. */
#ifndef T3R_PLATFORM_OPENCV_SHIM_H
#define T3R_PLATFORM_OPENCV_SHIM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct t3r_opencv_film t3r_opencv_film;

typedef struct t3r_opencv_picture {
    const uint8_t *data; /* valid until the next read */
    uint32_t width, height, stride;
    uint32_t channels, bytes; /* per pixel; per channel */
    double position_ms;       /* as the back end reports it; often 0 */
} t3r_opencv_picture;

typedef struct t3r_opencv_request {
    const char *url;          /* a number alone is a device */
    const char *name;         /* the URL's name in messages */
    const char *backend;      /* NULL = OpenCV's choice */
    uint32_t width, height;   /* for devices; 0 = unchanged */
    uint32_t rate_millihertz; /* for devices; 0 = unchanged */
    const char *fourcc;       /* for devices; NULL = unchanged */
    uint32_t timeout_ms;      /* for back ends that have one: FFMPEG, GStreamer */
    bool unchanged;           /* keep samples as stored: for depth */
} t3r_opencv_request;

typedef struct t3r_opencv_shim {
    const char *version;
    t3r_opencv_film *(*open)(const t3r_opencv_request *request, char *error, size_t error_bytes);
    /* Reads a picture. Returns 1: a picture; 0: the end, or a device delivered nothing in time; -1: failed with a
     * reason. */
    int (*read)(t3r_opencv_film *film, t3r_opencv_picture *picture, char *error, size_t error_bytes);
    void (*close)(t3r_opencv_film *film);
    const char *(*backend)(const t3r_opencv_film *film);
    double (*rate)(const t3r_opencv_film *film); /* frames a second as reported; 0 = unknown */
    bool (*live)(const t3r_opencv_film *film);   /* a device, not a film that ends */
} t3r_opencv_shim;

extern const t3r_opencv_shim t3r_shim;

#ifdef __cplusplus
}
#endif
#endif
