/* SPDX-License-Identifier: Apache-2.0 */
/* The host library: what a program on Linux needs beside the runtime, in floats and on the heap.
 *
 *     t3r_host *host;
 *     t3r_config config = t3r_default_config(256, 256, 2, 13107);
 *     t3r_host_open(&host, &config, 0, error, sizeof error);       // arena, vectors, a thread per processor
 *     t3r_runtime *rt = t3r_host_runtime(host);                    // for all calls of trim3r.h
 *     t3r_scene_write("room.spz", &scene, 0, error, sizeof error); // after t3r_reconstruct(rt, NULL, &scene)
 *     t3r_host_close(host);
 *
 * trim3r_capture.h has cameras and recordings. Functions that return a t3r_status write a text into error[] unless it
 * is NULL: why the call failed, "" after T3R_OK. It is cut at error_bytes: 512 hold all but long paths. They print
 * nothing, catch no signals and keep no state, so any threads may call them at the same time for different objects. An
 * inline call passes what the program was compiled with to the call of the same name with the suffix _as, which returns
 * T3R_ERR_INTERFACE if the library has other headers or features. */
#ifndef TRIM3R_HOST_H
#define TRIM3R_HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"
#include "trim3r_capture.h"
#include "trim3r_program.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Values of t3r_status besides those of trim3r.h; only error[] has a text for them. */
enum {
    T3R_HOST_ERR_FILE = -100,  /* a file cannot be read, understood or written */
    T3R_HOST_ERR_SYSTEM = -101 /* the system refuses memory or a thread */
};

/* ---- processor and threads ---------------------------------------------------------------------------------- */

/* Returns the T3R_CPU_... features that the processor and its operating system have, for t3r_set_cpu(); 0 on an unknown
 * processor. */
uint32_t t3r_cpu_features(void);
/* Returns the number of processors that this process may use, 1..T3R_MAX_THREADS. */
uint32_t t3r_cpu_count(void);

#define T3R_MAX_THREADS T3R_MAX_WORKERS

/* A fixed set of threads for t3r_hooks.parallel_for. Results do not depend on which thread runs which index, because
 * the runtime's tasks write to separate places. */
typedef struct t3r_threads t3r_threads;

/* Starts a pool of `count` threads, 1..T3R_MAX_THREADS, of which the caller is one. Returns NULL when the system
 * refuses a thread or memory runs out. */
t3r_threads *t3r_threads_start(uint32_t count);
/* Joins all threads; in a child of fork() only those that it started. NULL is allowed. */
void t3r_threads_stop(t3r_threads *threads);
uint32_t t3r_threads_count(const t3r_threads *threads);

typedef void t3r_thread_task(void *context, uint32_t index, uint32_t worker);

/* Runs task(context, 0..count-1, worker) and returns when all are done; `worker` is the thread's number, 0 for the
 * caller, so t3r_config.workers must be at least the number of threads. Allocates nothing, but the first call in a
 * child of fork() starts threads of its own. Not reentrant: a task must not call it. `threads` comes first and untyped,
 * so that this function can be the hook itself, with hooks.user = the pool. */
void t3r_threads_run(void *threads, uint32_t count, t3r_thread_task *task, void *context);

/* ---- cameras in doubles ------------------------------------------------------------------------------------- */

/* A camera before fixed point. */
typedef struct t3r_recorded_camera {
    uint32_t width, height; /* of the picture that the intrinsics are for; 0 x 0: any, as in t3r_camera */
    double fx, fy, cx, cy;  /* pixels; pixel (0, 0) is the centre of the top-left pixel */
    t3r_distortion distortion;
    double coefficients[5];
    double position[3]; /* world units */
    double rotation[4]; /* w x y z, camera to world */
} t3r_recorded_camera;

/* A rectangle of whole pixels. */
typedef struct t3r_crop {
    uint32_t x, y, width, height;
} t3r_crop;

/* The convention of a pose. */
typedef enum t3r_axes {
    T3R_AXES_OPENCV = 0,    /* x right, y down, z forward: the axes of every pose in trim3r */
    T3R_AXES_OPENGL = 1,    /* x right, y up, z backward */
    T3R_WORLD_TO_CAMERA = 2 /* added: the pose is the inverse one, as of OpenCV's solvePnP() and of COLMAP */
} t3r_axes;

/* ---- scene files -------------------------------------------------------------------------------------------- */

/* Changes that reading made. */
typedef struct t3r_scene_remarks {
    uint32_t pulled;  /* Gaussians beyond the fixed point, moved to its end */
    uint32_t clipped; /* Gaussians with harmonics beyond 8, which are 8 now */
    uint32_t dropped; /* invalid Gaussians left out */
    double step;      /* between the floats of the file's positions, if over half of `width`; else 0 */
    double width;     /* half of the Gaussians are at most so wide */
    char text[96];    /* what of the file is not read; "": nothing */
} t3r_scene_remarks;

/* The axis of a scene that points up; M: its other end does. */
typedef enum t3r_scene_up {
    T3R_UP_UNKNOWN,
    T3R_UP_X,
    T3R_UP_MX,
    T3R_UP_Y,
    T3R_UP_MY,
    T3R_UP_Z,
    T3R_UP_MZ
} t3r_scene_up;

/* A Gaussian beyond the fixed point: `times` as far from the frame's origin, and as large, as gaussians[index]. */
typedef struct t3r_scene_far {
    uint32_t index;
    double times;
} t3r_scene_far;

/* A scene outside the arena. */
typedef struct t3r_scene_file {
    t3r_scene_frame frame;
    t3r_gaussian *gaussians; /* heap; t3r_scene_free() */
    uint32_t count;
    uint32_t degree;        /* of its harmonics, 0..3 */
    int16_t *harmonics_q12; /* heap; NULL: degree 0. In the layout of t3r_harmonics_colour(), Gaussian by Gaussian */
    bool mip;               /* opacities are those of mip-splatting: t3r_scene_load() draws them so */
    uint32_t finer;         /* t3r_scene_load() for an eye takes a unit of 2^-finer of the frame's; 0: the frame */
    t3r_scene_far *far;     /* heap, by rising index; NULL: none */
    uint32_t far_count;     /* of them */
    t3r_scene_up up;        /* as a comment of the file names it, for the first view */
    t3r_scene_remarks remarks;
} t3r_scene_file;

/* A scene in floats: the caller's arrays, without gaps. */
typedef struct t3r_scene_floats {
    uint32_t count;    /* Gaussians, 1..T3R_MAX_GAUSSIANS */
    uint32_t degree;   /* of the harmonics, 0..3 */
    bool mip;          /* as in t3r_scene_file */
    double *positions; /* count x 3: the means in world units */
    double *scales;    /* count x 3: the standard deviations along the Gaussian's axes in world units, 0 or more */
    double *rotations; /* count x 4: quaternions w x y z of any length, from the Gaussian's axes to the world */
    double *colours;   /* count x 3: red, green, blue of degree 0; a screen shows 0..1 */
    double *opacities; /* count: at the means, 0..1 */
    float *harmonics;  /* count x ((degree + 1)^2 - 1) x 3: the coefficients above degree 0; NULL: degree 0 */
} t3r_scene_floats;

/* Flags of the functions below; 0 or a sum. */
enum {
    T3R_SCENE_LOCAL = 1,       /* writes relative to the frame's origin: metres from the first context camera, say */
    T3R_SCENE_COMMENTS = 2,    /* writes comments with bits epoch and scene frame; some readers reject comments */
    T3R_SCENE_DROP_INVALID = 4 /* reads without the Gaussians that are not valid, one of which refuses the file */
};

/* ---- what a program was compiled with ----------------------------------------------------------------------- */

#define T3R_HOST_TYPES_(X)                                                                                             \
    X(t3r_recorded_camera)                                                                                             \
    X(t3r_crop)                                                                                                        \
    X(t3r_scene_remarks)                                                                                               \
    X(t3r_scene_far)                                                                                                   \
    X(t3r_scene_file)                                                                                                  \
    X(t3r_scene_floats)
#define T3R_HOST_FIELDS_(X)                                                                                            \
    X(t3r_recorded_camera, width)                                                                                      \
    X(t3r_recorded_camera, height)                                                                                     \
    X(t3r_recorded_camera, fx)                                                                                         \
    X(t3r_recorded_camera, fy)                                                                                         \
    X(t3r_recorded_camera, cx)                                                                                         \
    X(t3r_recorded_camera, cy)                                                                                         \
    X(t3r_recorded_camera, distortion)                                                                                 \
    X(t3r_recorded_camera, coefficients)                                                                               \
    X(t3r_recorded_camera, position)                                                                                   \
    X(t3r_recorded_camera, rotation)                                                                                   \
    X(t3r_crop, x)                                                                                                     \
    X(t3r_crop, y)                                                                                                     \
    X(t3r_crop, width)                                                                                                 \
    X(t3r_crop, height)                                                                                                \
    X(t3r_scene_remarks, pulled)                                                                                       \
    X(t3r_scene_remarks, clipped)                                                                                      \
    X(t3r_scene_remarks, dropped)                                                                                      \
    X(t3r_scene_remarks, step)                                                                                         \
    X(t3r_scene_remarks, width)                                                                                        \
    X(t3r_scene_remarks, text)                                                                                         \
    X(t3r_scene_far, index)                                                                                            \
    X(t3r_scene_far, times)                                                                                            \
    X(t3r_scene_file, frame)                                                                                           \
    X(t3r_scene_file, gaussians)                                                                                       \
    X(t3r_scene_file, count)                                                                                           \
    X(t3r_scene_file, degree)                                                                                          \
    X(t3r_scene_file, harmonics_q12)                                                                                   \
    X(t3r_scene_file, mip)                                                                                             \
    X(t3r_scene_file, finer)                                                                                           \
    X(t3r_scene_file, far)                                                                                             \
    X(t3r_scene_file, far_count)                                                                                       \
    X(t3r_scene_file, up)                                                                                              \
    X(t3r_scene_file, remarks)                                                                                         \
    X(t3r_scene_floats, count)                                                                                         \
    X(t3r_scene_floats, degree)                                                                                        \
    X(t3r_scene_floats, mip)                                                                                           \
    X(t3r_scene_floats, positions)                                                                                     \
    X(t3r_scene_floats, scales)                                                                                        \
    X(t3r_scene_floats, rotations)                                                                                     \
    X(t3r_scene_floats, colours)                                                                                       \
    X(t3r_scene_floats, opacities)                                                                                     \
    X(t3r_scene_floats, harmonics)
static inline t3r_program t3r_host_program(void)
{
    uint64_t digest = t3r_header_interface();
    T3R_HOST_TYPES_(T3R_DIGEST_TYPE_)
    T3R_HOST_FIELDS_(T3R_DIGEST_FIELD_)
    return t3r_program_of(digest);
}
/* Returns the same for the library: a language that does not compile this header passes it to the calls with _as. */
t3r_program t3r_host_interface(void);

/* ---- a runtime on this host --------------------------------------------------------------------------------- */

typedef struct t3r_host t3r_host;

/* Opens a runtime: allocates its arena of t3r_plan().bytes, starts `threads` threads (0: t3r_cpu_count()), which
 * replace config->workers, and takes the processor's vectors. None of these changes a bit of any output. Returns the
 * statuses of t3r_init() and T3R_HOST_ERR_SYSTEM; *host is NULL then. */
t3r_status t3r_host_open_as(t3r_program program, t3r_host **host, const t3r_config *config, uint32_t threads,
                            char *error, size_t error_bytes);
static inline t3r_status t3r_host_open(t3r_host **host, const t3r_config *config, uint32_t threads, char *error,
                                       size_t error_bytes)
{
    return t3r_host_open_as(t3r_host_program(), host, config, threads, error, error_bytes);
}
/* Returns the runtime, for all calls of trim3r.h. Call t3r_host_set_hooks() instead of t3r_set_hooks(). */
t3r_runtime *t3r_host_runtime(const t3r_host *host);
/* Binds the caller's progress and stage_hash (NULL: none); parallel_for remains the host's. */
t3r_status t3r_host_set_hooks(t3r_host *host, const t3r_hooks *hooks);
/* Returns the arena and its bytes, to be copied or saved between two calls of the runtime. */
const void *t3r_host_arena(const t3r_host *host, size_t *bytes);
/* Opens a runtime in a copy of `saved`, the bytes of an arena, as t3r_attach() does: with its settings, as many threads
 * as its workers, and the processor's vectors. Bind hooks and head again. Returns the statuses of t3r_attach() and
 * T3R_HOST_ERR_SYSTEM; *host is NULL then. */
t3r_status t3r_host_attach_as(t3r_program program, t3r_host **host, const void *saved, size_t bytes, char *error,
                              size_t error_bytes);
static inline t3r_status t3r_host_attach(t3r_host **host, const void *saved, size_t bytes, char *error,
                                         size_t error_bytes)
{
    return t3r_host_attach_as(t3r_host_program(), host, saved, bytes, error, error_bytes);
}
/* Frees the runtime with its arena and threads. NULL is allowed. */
void t3r_host_close(t3r_host *host);

/* ---- cameras ------------------------------------------------------------------------------------------------ */

/* Adapts the intrinsics to a picture that is cropped and then resized to width x height, which becomes the camera's
 * size. A crop from (0, 0) of the whole picture only resizes. Lengths are measured from the corner of the top-left
 * pixel, half a pixel before its centre. T3R_ERR_CAMERA: the crop is empty or not inside the picture, the camera has no
 * size, or a side is 0. */
t3r_status t3r_camera_crop_as(t3r_program program, t3r_recorded_camera *camera, const t3r_crop *crop, uint32_t width,
                              uint32_t height, char *error, size_t error_bytes);
static inline t3r_status t3r_camera_crop(t3r_recorded_camera *camera, const t3r_crop *crop, uint32_t width,
                                         uint32_t height, char *error, size_t error_bytes)
{
    return t3r_camera_crop_as(t3r_host_program(), camera, crop, width, height, error, error_bytes);
}

/* Sets the pose by a row-major matrix, camera to world unless `axes` has T3R_WORLD_TO_CAMERA; `axes` is a sum of
 * t3r_axes. T3R_ERR_CAMERA: an entry is not finite, the last row is not 0 0 0 1, the rest is no rotation within 1e-3,
 * or the position is out of range. The camera is then unchanged. */
t3r_status t3r_camera_pose_matrix_as(t3r_program program, t3r_recorded_camera *camera, const double matrix[16],
                                     uint32_t axes, char *error, size_t error_bytes);
static inline t3r_status t3r_camera_pose_matrix(t3r_recorded_camera *camera, const double matrix[16], uint32_t axes,
                                                char *error, size_t error_bytes)
{
    return t3r_camera_pose_matrix_as(t3r_host_program(), camera, matrix, axes, error, error_bytes);
}

/* Does the same by a translation and a quaternion w x y z, whose norm must be 1 within 0.1. */
t3r_status t3r_camera_pose_quaternion_as(t3r_program program, t3r_recorded_camera *camera, const double translation[3],
                                         const double rotation[4], uint32_t axes, char *error, size_t error_bytes);
static inline t3r_status t3r_camera_pose_quaternion(t3r_recorded_camera *camera, const double translation[3],
                                                    const double rotation[4], uint32_t axes, char *error,
                                                    size_t error_bytes)
{
    return t3r_camera_pose_quaternion_as(t3r_host_program(), camera, translation, rotation, axes, error, error_bytes);
}

/* Converts to the runtime's fixed point. The size stays: the runtime refuses a frame or target of another one.
 * T3R_ERR_CAMERA: a number is out of its range; error[] says which. */
t3r_status t3r_camera_fixed_as(t3r_program program, const t3r_recorded_camera *camera, t3r_camera *out, char *error,
                               size_t error_bytes);
static inline t3r_status t3r_camera_fixed(const t3r_recorded_camera *camera, t3r_camera *out, char *error,
                                          size_t error_bytes)
{
    return t3r_camera_fixed_as(t3r_host_program(), camera, out, error, error_bytes);
}

/* ---- scenes ------------------------------------------------------------------------------------------------- */

/* Reads a scene in the format that its first bytes identify, else its suffix: .ply, .compressed.ply, .splat, .spz, .glb
 * and, where the library has WebP, .sog. After T3R_OK error[] holds the changes that reading made, "" for none, and
 * t3r_scene_free() is due. T3R_HOST_ERR_FILE: error[] says what is wrong, and where. */
t3r_status t3r_scene_read_as(t3r_program program, const char *path, int flags, t3r_scene_file *out, char *error,
                             size_t error_bytes);
static inline t3r_status t3r_scene_read(const char *path, int flags, t3r_scene_file *out, char *error,
                                        size_t error_bytes)
{
    return t3r_scene_read_as(t3r_host_program(), path, flags, out, error, error_bytes);
}
void t3r_scene_free(t3r_scene_file *scene);

/* Writes a scene in the format of the path's suffix, in the world of its cameras. The file appears when it is whole; a
 * .sog is first read back by a child of fork(). After T3R_OK error[] holds what the format could not hold, "" for
 * nothing. T3R_HOST_ERR_FILE: an earlier file stays. */
t3r_status t3r_scene_write_as(t3r_program program, const char *path, const t3r_scene *scene, int flags, char *error,
                              size_t error_bytes);
static inline t3r_status t3r_scene_write(const char *path, const t3r_scene *scene, int flags, char *error,
                                         size_t error_bytes)
{
    return t3r_scene_write_as(t3r_host_program(), path, scene, flags, error, error_bytes);
}

/* Does the same for a scene outside the arena, with its harmonics as far as the format has them. */
t3r_status t3r_scene_file_write_as(t3r_program program, const char *path, const t3r_scene_file *scene, int flags,
                                   char *error, size_t error_bytes);
static inline t3r_status t3r_scene_file_write(const char *path, const t3r_scene_file *scene, int flags, char *error,
                                              size_t error_bytes)
{
    return t3r_scene_file_write_as(t3r_host_program(), path, scene, flags, error, error_bytes);
}

/* Makes a scene of floats. Its frame has the origin in the middle of the Gaussians. After T3R_OK t3r_scene_free() is
 * due, and out->remarks has the changes. T3R_ERR_ARGUMENT: a number is not finite or out of its range; error[] says
 * which, as "scales[7][2] is -4.2, ...". */
t3r_status t3r_scene_of_floats_as(t3r_program program, const t3r_scene_floats *floats, t3r_scene_file *out, char *error,
                                  size_t error_bytes);
static inline t3r_status t3r_scene_of_floats(const t3r_scene_floats *floats, t3r_scene_file *out, char *error,
                                             size_t error_bytes)
{
    return t3r_scene_of_floats_as(t3r_host_program(), floats, out, error, error_bytes);
}
/* Fills the caller's arrays with a scene of the same count; out->degree may be below the scene's. Rotations have unit
 * length. T3R_ERR_ARGUMENT: another count, or a higher degree. */
t3r_status t3r_floats_of_scene_as(t3r_program program, const t3r_scene_file *scene, t3r_scene_floats *out);
static inline t3r_status t3r_floats_of_scene(const t3r_scene_file *scene, t3r_scene_floats *out)
{
    return t3r_floats_of_scene_as(t3r_host_program(), scene, out);
}

/* Replaces the scene in the arena by one of a file, as a picture of width x height by `eye` sees it: colours of
 * harmonics, opacities of mip-splatting, and in a frame of its own where the scene's cannot show what is near or far.
 * NULL: colours of degree 0, opacities and frame as they are. Returns the statuses of t3r_scene_begin(),
 * t3r_scene_append() and, with an eye, T3R_ERR_CAMERA: it is for another size, or out of range. */
t3r_status t3r_scene_load_as(t3r_program program, t3r_runtime *runtime, const t3r_scene_file *scene,
                             const t3r_camera *eye, uint32_t width, uint32_t height);
static inline t3r_status t3r_scene_load(t3r_runtime *runtime, const t3r_scene_file *scene, const t3r_camera *eye,
                                        uint32_t width, uint32_t height)
{
    return t3r_scene_load_as(t3r_host_program(), runtime, scene, eye, width, height);
}
/* Converts depths of a picture, which t3r_render() drew for the eye of t3r_scene_load(), to world units: a frame of the
 * picture's own compresses what is far. */
t3r_status t3r_scene_depths_as(t3r_program program, const t3r_scene_file *scene, const t3r_camera *eye,
                               const uint32_t *depths_q20, size_t count, double *depths);
static inline t3r_status t3r_scene_depths(const t3r_scene_file *scene, const t3r_camera *eye,
                                          const uint32_t *depths_q20, size_t count, double *depths)
{
    return t3r_scene_depths_as(t3r_host_program(), scene, eye, depths_q20, count, depths);
}

/* ---- files -------------------------------------------------------------------------------------------------- */

/* Writes a file beside its place and renames it when it is whole, so that no reader sees a part of it. Returns T3R_OK,
 * or T3R_HOST_ERR_FILE, and an earlier file stays. */
t3r_status t3r_write_whole(const char *path, const void *bytes, size_t count, char *error, size_t error_bytes);

#ifdef __cplusplus
}
#endif
#endif
