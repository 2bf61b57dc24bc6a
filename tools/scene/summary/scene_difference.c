/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/summary/scene_difference.h"

#include <math.h>
#include <string.h>

#include "host/reason.h"
#include "scene/gaussian_shape.h"
#include "scene/scene_file.h"
#include "scene/scene_rows.h"

#define COLOUR_STEP (1.0 / 32640)
#define HARMONICS_STEP (1.0 / 4096)

/* One of the two scenes, in the file's doubles and in fixed point. */
typedef struct side {
    scene_rows rows;
    scene_turn turn; /* to the scene's axes */
    scene_file scene;
} side;

static int open_side(side *s, const scene_rows *rows, char *error, size_t error_bytes)
{
    *s = (side){.rows = *rows, .turn = scene_turn_between(rows->axes, SCENE_AXES_AS_THEY_ARE, T3R_UP_UNKNOWN)};
    return scene_file_from_rows(&s->rows, &s->scene, error, error_bytes);
}

/* Reads a row in the scene's axes and in world units. Coefficients that the file lacks are 0. */
static int read_row(const side *s, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    *row = (scene_row){.rest = {{0}}};
    if (scene_rows_read(&s->rows, index, row, error, error_bytes) != 0) {
        return -1;
    }
    scene_turn_apply(&s->turn, row->position, row->rotation, s->rows.degree, row->rest);
    for (int axis = 0; axis < 3 && s->rows.has_frame && s->rows.local; axis++) {
        row->position[axis] += ldexp((double)s->rows.frame.origin_q32[axis], -32);
    }
    return 0;
}

static bool is_step_apart(double x, double y, double step)
{
    return nearbyint(x / step) != nearbyint(y / step);
}

/* Whether two rows differ where the fixed point clamps. */
static bool rows_differ(const scene_row *p, const scene_row *q, double position_step)
{
    bool differ = false;
    for (int i = 0; i < 3; i++) {
        differ = differ || is_step_apart(p->position[i], q->position[i], position_step) ||
                 is_step_apart(HARMONICS_ZERO * p->harmonic[i], HARMONICS_ZERO * q->harmonic[i], COLOUR_STEP);
    }
    for (uint32_t i = 0; i < 3 * HARMONICS_REST_MOST; i++) {
        differ = differ || is_step_apart(p->rest[i / 3][i % 3], q->rest[i / 3][i % 3], HARMONICS_STEP);
    }
    return differ;
}

static double covariance_difference(const t3r_gaussian *a, int a_exponent, const t3r_gaussian *b, int b_exponent)
{
    double p[9], q[9], most = 0, difference = 0;
    gaussian_covariance(a, p);
    gaussian_covariance(b, q);
    for (int i = 0; i < 9; i++) {
        const double x = ldexp(p[i], 2 * a_exponent), y = ldexp(q[i], 2 * b_exponent);
        most = fmax(most, fmax(fabs(x), fabs(y)));
        difference = fmax(difference, fabs(x - y));
    }
    return most > 0 ? difference / most : 0;
}

/* Raises the largest differences by those of two rows. */
static void add_rows(scene_difference *d, const scene_row *p, const scene_row *q)
{
    double square = 0;
    for (int i = 0; i < 3; i++) {
        const double distance = p->position[i] - q->position[i];
        square += distance * distance;
        d->colour = fmax(d->colour, 255 * HARMONICS_ZERO * fabs(p->harmonic[i] - q->harmonic[i]));
    }
    d->position = fmax(d->position, sqrt(square));
    d->opacity = fmax(d->opacity, fabs(scene_row_opacity(p) - scene_row_opacity(q)));
    for (uint32_t i = 0; i < 3 * HARMONICS_REST_MOST; i++) {
        d->harmonics = fmax(d->harmonics, fabs(p->rest[i / 3][i % 3] - q->rest[i / 3][i % 3]));
    }
}

static int compare(const side *a, const side *b, scene_difference *d, char *error, size_t error_bytes)
{
    const t3r_scene_frame *frame = &a->scene.frame, *other = &b->scene.frame;
    const bool same_frame = memcmp(frame->origin_q32, other->origin_q32, sizeof frame->origin_q32) == 0 &&
                            frame->exponent == other->exponent;
    const double position_step = ldexp(1, (frame->exponent > other->exponent ? frame : other)->exponent - 20);
    *d = (scene_difference){.count = {a->scene.count, b->scene.count},
                            .degree = {a->scene.degree, b->scene.degree},
                            .mip = {a->scene.mip, b->scene.mip}};
    for (uint32_t i = 0; i < d->count[0] && i < d->count[1]; i++) {
        const t3r_gaussian *g = &a->scene.gaussians[i], *h = &b->scene.gaussians[i];
        scene_row p, q;
        if (read_row(a, i, &p, error, error_bytes) != 0 || read_row(b, i, &q, error, error_bytes) != 0) {
            return -1;
        }
        if (same_frame && memcmp(g, h, sizeof *g) == 0 && !rows_differ(&p, &q, position_step)) { /* no padding in g */
            continue;
        }
        d->first = d->different == 0 ? i : d->first;
        d->different++;
        d->covariance = fmax(d->covariance, covariance_difference(g, frame->exponent, h, other->exponent));
        add_rows(d, &p, &q);
    }
    return 0;
}

/* Gives rows without a frame the frame of the others, so that both have the same steps. */
static scene_rows with_frame(const scene_rows *rows, const t3r_scene_frame *frame)
{
    scene_rows framed = *rows;
    if (!rows->has_frame) {
        framed.has_frame = true;
        framed.frame = *frame;
    }
    return framed;
}

typedef struct comparison {
    const char *const *path;
    int flags;
    const scene_rows *first;
    scene_difference *out;
} comparison;

static int take_second(void *user, const scene_rows *rows, char *error, size_t error_bytes)
{
    const comparison *c = user;
    const scene_rows first = rows->has_frame ? with_frame(c->first, &rows->frame) : *c->first;
    side pair[2] = {{.turn = {0}}};
    char reason[256] = "";
    int result = open_side(&pair[0], &first, reason, sizeof reason);
    const bool is_second = result == 0;
    if (result == 0) {
        const scene_rows second = with_frame(rows, &pair[0].scene.frame);
        result = open_side(&pair[1], &second, reason, sizeof reason);
    }
    if (result == 0) {
        result = compare(&pair[0], &pair[1], c->out, reason, sizeof reason);
    }
    scene_file_free(&pair[0].scene);
    scene_file_free(&pair[1].scene);
    return result == 0 ? 0 : t3r_reason(error, error_bytes, "%s: %s", c->path[is_second], reason);
}

static int take_first(void *user, const scene_rows *rows, char *error, size_t error_bytes)
{
    comparison *c = user;
    c->first = rows;
    return scene_file_take(c->path[1], c->flags, &(scene_sink){take_second, c}, error, error_bytes);
}

int scene_difference_of(const char *const path[2], int flags, scene_difference *out, char *error, size_t error_bytes)
{
    comparison c = {.path = path, .flags = flags, .out = out};
    return scene_file_take(path[0], flags, &(scene_sink){take_first, &c}, error, error_bytes);
}

bool scene_difference_none(const scene_difference *difference)
{
    return difference->different == 0 && difference->count[0] == difference->count[1] &&
           difference->mip[0] == difference->mip[1];
}
