/* SPDX-License-Identifier: Apache-2.0 */
/* The interface of libcamera's module, in C. Its callbacks run on a thread of the library; they only store the index,
 * sequence and time stamp of a finished buffer. */
#ifndef T3R_PLATFORM_LIBCAMERA_SHIM_H
#define T3R_PLATFORM_LIBCAMERA_SHIM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define T3R_LIBCAMERA_MOST_BUFFERS 32u

typedef struct t3r_libcamera_stream t3r_libcamera_stream;

typedef struct t3r_libcamera_request {
    const char *camera;     /* an id, or a number from the list */
    uint32_t width, height; /* the camera's nearest size is taken */
    const char *format;     /* YUYV, UYVY, NV12, RGB3, BGR3 or GREY; NULL = the first that it offers */
    uint32_t rate_millihertz;
    uint32_t buffers;
} t3r_libcamera_request;

/* The negotiated format, in the request's names. */
typedef struct t3r_libcamera_agreed {
    char id[128];
    char format[5];
    uint32_t width, height, stride;
    uint32_t buffers;
    struct {
        const uint8_t *plane[2]; /* NV12 has two */
        size_t bytes[2];         /* mapped from there on */
    } buffer[T3R_LIBCAMERA_MOST_BUFFERS];
} t3r_libcamera_agreed;

typedef struct t3r_libcamera_done {
    uint32_t index, sequence;
    uint64_t stamp_ns; /* CLOCK_BOOTTIME */
    uint32_t bytes;
    bool whole; /* the library reports no error */
} t3r_libcamera_done;

typedef struct t3r_libcamera_shim {
    const char *version;
    /* Opens and starts the camera. Returns NULL with a reason on failure. */
    t3r_libcamera_stream *(*open)(const t3r_libcamera_request *request, t3r_libcamera_agreed *agreed, char *error,
                                  size_t error_bytes);
    /* Waits for the next finished buffer. Returns 1: a buffer; 0: none in time; -1: the camera was unplugged; -2: the
     * camera takes no buffers. */
    int (*wait)(t3r_libcamera_stream *stream, uint32_t timeout_ms, t3r_libcamera_done *done);
    /* Queues a buffer again. Returns 0 or -1. */
    int (*queue)(t3r_libcamera_stream *stream, uint32_t index);
    void (*close)(t3r_libcamera_stream *stream);
    /* Passes a line for each camera to `say`. */
    void (*list)(void (*say)(void *user, const char *line), void *user);
} t3r_libcamera_shim;

extern const t3r_libcamera_shim t3r_shim;

#ifdef __cplusplus
}
#endif
#endif
