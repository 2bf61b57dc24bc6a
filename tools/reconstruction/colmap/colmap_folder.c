/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/colmap/colmap_folder.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/files/whole_file.h"
#include "geometry/quaternion.h"
#include "host/reason.h"
#include "pictures/picture.h"
#include "scene/scene_file.h"

#define NOWHERE UINT32_MAX

typedef struct observation {
    uint32_t index; /* among its view's observations; NOWHERE = the point is not observed */
    double x, y;    /* pixels, the top-left pixel's centre at (0.5, 0.5) */
} observation;

/* World to camera. */
typedef struct pose {
    double quaternion[4]; /* unit, w x y z, w >= 0 */
    double rotation[9];   /* the same, row-major */
    double translation[3];
} pose;

typedef struct writer {
    whole_folder *folder;
    const colmap_model *model;
    pose poses[T3R_MAX_VIEWS];
    uint32_t points;       /* the first Gaussians, which are of surfaces */
    observation *observed; /* of each point */
    char *error;
    size_t error_bytes;
} writer;

/* Returns the point relative to the world's origin, or to the scene frame's. */
static void point_of(const writer *w, uint32_t index, double point[3])
{
    const t3r_scene_frame *frame = &w->model->scene->frame;
    for (int i = 0; i < 3; i++) {
        double origin = w->model->local ? 0 : ldexp((double)frame->origin_q32[i], -32);
        point[i] = origin + ldexp(w->model->scene->gaussians[index].position_q20[i], frame->exponent - 20);
    }
}

static pose pose_of(const writer *w, const t3r_camera *camera)
{
    pose p;
    const int sign = camera->rotation_q30[0] < 0 ? -1 : 1;
    double centre[3];
    for (int i = 0; i < 4; i++) { /* the conjugate is the inverse */
        p.quaternion[i] = (i == 0 ? sign : -sign) * (double)camera->rotation_q30[i];
    }
    quaternion_normalise(p.quaternion);
    quaternion_matrix(p.quaternion, p.rotation);
    for (int i = 0; i < 3; i++) {
        const int64_t origin = w->model->local ? w->model->scene->frame.origin_q32[i] : 0;
        centre[i] = -ldexp((double)(camera->position_q32[i] - origin), -32);
    }
    matrix_apply(p.rotation, centre, p.translation);
    return p;
}

/* Projects Gaussian `index` into view v; false behind the camera or outside the picture. */
static bool project(const writer *w, uint32_t index, uint32_t v, observation *at)
{
    const colmap_view *view = &w->model->views[v];
    double point[3], in[3];
    point_of(w, index, point);
    matrix_apply(w->poses[v].rotation, point, in);
    for (int i = 0; i < 3; i++) {
        in[i] += w->poses[v].translation[i];
    }
    at->x = ldexp(view->camera.fx_q16 * (in[0] / in[2]) + view->camera.cx_q16, -16) + 0.5;
    at->y = ldexp(view->camera.fy_q16 * (in[1] / in[2]) + view->camera.cy_q16, -16) + 0.5;
    return in[2] > 0 && at->x >= 0 && at->x < view->width && at->y >= 0 && at->y < view->height;
}

static void observe(writer *w)
{
    uint32_t counts[T3R_MAX_VIEWS] = {0};
    for (uint32_t i = 0; i < w->points; i++) {
        uint32_t v = w->model->scene->gaussians[i].view;
        bool seen = w->model->sourced && v < w->model->view_count && project(w, i, v, &w->observed[i]);
        w->observed[i].index = seen ? counts[v]++ : NOWHERE;
    }
}

static void write_cameras(FILE *file, const writer *w)
{
    fputs("# CAMERA_ID MODEL WIDTH HEIGHT FX FY CX CY\n", file);
    for (uint32_t v = 0; v < w->model->view_count; v++) {
        const colmap_view *view = &w->model->views[v];
        fprintf(file, "%" PRIu32 " PINHOLE %" PRIu32 " %" PRIu32 " %.17g %.17g %.17g %.17g\n", v + 1, view->width,
                view->height, ldexp(view->camera.fx_q16, -16), ldexp(view->camera.fy_q16, -16),
                ldexp(view->camera.cx_q16, -16) + 0.5, ldexp(view->camera.cy_q16, -16) + 0.5);
    }
}

static void write_images(FILE *file, const writer *w)
{
    fputs("# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME\n# X Y POINT3D_ID ...\n", file);
    for (uint32_t v = 0; v < w->model->view_count; v++) {
        const pose *p = &w->poses[v];
        fprintf(file, "%" PRIu32 " %.17g %.17g %.17g %.17g %.17g %.17g %.17g %" PRIu32 " frame_%06" PRIu32 ".png\n",
                v + 1, p->quaternion[0], p->quaternion[1], p->quaternion[2], p->quaternion[3], p->translation[0],
                p->translation[1], p->translation[2], v + 1, w->model->views[v].frame);
        const char *between = "";
        for (uint32_t i = 0; i < w->points; i++) {
            if (w->observed[i].index != NOWHERE && w->model->scene->gaussians[i].view == v) {
                fprintf(file, "%s%.4f %.4f %" PRIu32, between, w->observed[i].x, w->observed[i].y, i + 1);
                between = " ";
            }
        }
        fputc('\n', file);
    }
}

static void write_points(FILE *file, const writer *w)
{
    fputs("# POINT3D_ID X Y Z R G B ERROR IMAGE_ID POINT2D_IDX\n", file);
    for (uint32_t i = 0; i < w->points; i++) {
        const t3r_gaussian *g = &w->model->scene->gaussians[i];
        double point[3];
        point_of(w, i, point);
        fprintf(file, "%" PRIu32 " %.12g %.12g %.12g", i + 1, point[0], point[1], point[2]);
        for (int c = 0; c < 3; c++) {
            fprintf(file, " %d", (g->colour_q7[c] + 64) >> 7);
        }
        if (w->observed[i].index != NOWHERE) {
            fprintf(file, " 0 %d %" PRIu32 "\n", g->view + 1, w->observed[i].index);
        } else {
            fputs(" -1\n", file);
        }
    }
}

static int write_file(const writer *w, const char *name, void (*write)(FILE *file, const writer *w))
{
    t3r_whole_file file;
    const char *path = whole_folder_file(w->folder, name, w->error, w->error_bytes);
    if (path == NULL || whole_file_begin(&file, path, w->error, w->error_bytes) != 0) {
        return -1;
    }
    write(file.stream, w);
    return t3r_whole_file_commit(&file, NULL, w->error, w->error_bytes);
}

static int write_picture(const writer *w, const colmap_view *view)
{
    char name[40];
    picture p = {.width = view->width, .height = view->height, .channels = 3, .bits = 8, .samples = view->rgb};
    snprintf(name, sizeof name, "images/frame_%06" PRIu32 ".png", view->frame);
    const char *path = whole_folder_file(w->folder, name, w->error, w->error_bytes);
    return path == NULL ? -1 : picture_write_png(path, &p, w->error, w->error_bytes);
}

static int write_all(writer *w)
{
    static const char *const folders[] = {"images", "sparse", "sparse/0"};
    int failed = 0;
    for (size_t i = 0; i < sizeof folders / sizeof folders[0] && failed == 0; i++) {
        failed = whole_folder_make(w->folder, folders[i], w->error, w->error_bytes);
    }
    for (uint32_t v = 0; v < w->model->view_count && failed == 0; v++) {
        w->poses[v] = pose_of(w, &w->model->views[v].camera);
        failed = write_picture(w, &w->model->views[v]);
    }
    if (failed == 0) {
        observe(w);
        failed = write_file(w, "sparse/0/cameras.txt", write_cameras);
    }
    failed = failed == 0 ? write_file(w, "sparse/0/images.txt", write_images) : failed;
    return failed == 0 ? write_file(w, "sparse/0/points3D.txt", write_points) : failed;
}

int colmap_folder_write(whole_folder *folder, const colmap_model *model, char *error, size_t error_bytes)
{
    writer w = {.folder = folder, .model = model, .error = error, .error_bytes = error_bytes};
    w.points = scene_surfaces(model->scene->gaussians, model->scene->count);
    w.observed = malloc(((size_t)w.points + 1) * sizeof *w.observed);
    if (w.observed == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    int failed = write_all(&w);
    free(w.observed);
    return failed;
}
