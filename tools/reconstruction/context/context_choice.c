/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/context/context_choice.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "reconstruction/context/context_depth.h"
#include "reconstruction/context/view_surface.h"

#define POINTS_OF_FRAME (SURFACE_CELLS / 4) /* every second cell of every second row */
#define GAIN_LEAST 0.01                     /* of what all points could gain, for one more frame */
#define PARTNER_LEAST 0.15                  /* of a frame's surface, seen from another place by one other frame */
#define ANGLE_NEAR 0.2                      /* radians between two directions in which a point looks alike */
#define ANGLE_LEAST 0.02                    /* radians at a point between two views that give its depth */
#define ANGLE_MOST 0.7                      /* and between two that can be matched */

/* Worth of one more view of a point, by the number of views that have it: by sensor the first shows it, by stereo the
 * second measures it. More views of the same draw new pictures no better, so they alone bring no frame in. */
static const double worth[2][3] = {[T3R_DEPTH_SENSOR] = {1, 0.05, 0}, [T3R_DEPTH_STEREO] = {0.3, 0.7, 0.005}};

/* A point of some candidate's surface. */
typedef struct scene_point {
    double place[3];
    uint32_t views; /* chosen frames that count for it */
    uint32_t first; /* the first of them, an index of candidates */
    uint32_t owner; /* the candidate of whose surface it is */
} scene_point;

typedef struct candidates {
    uint32_t *frames; /* indices in the recording */
    view_surface *surfaces;
    bool *chosen;
    uint32_t count;
    scene_point *points;
    uint32_t point_count;
    bool *seen; /* point_count for each candidate */
    t3r_depth depth;
} candidates;

static void candidates_free(candidates *c)
{
    free(c->frames);
    free(c->surfaces);
    free(c->chosen);
    free(c->points);
    free(c->seen);
}

/* ---- looking --------------------------------------------------------------------------------------------------- */

/* Looks at the frames that can be used: evenly spread ones where there are too many. */
static int look(candidates *c, const t3r_recording *recording, const char *path, uint32_t except)
{
    const uint32_t there = t3r_recording_frame_count(recording);
    const uint32_t step = (there + CONTEXT_CANDIDATES - 1) / CONTEXT_CANDIDATES;
    char why[512] = "it is empty";
    c->frames = calloc(CONTEXT_CANDIDATES, sizeof *c->frames);
    c->surfaces = calloc(CONTEXT_CANDIDATES, sizeof *c->surfaces);
    c->chosen = calloc(CONTEXT_CANDIDATES, sizeof *c->chosen);
    if (c->frames == NULL || c->surfaces == NULL || c->chosen == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    cli_keep_errors(why, sizeof why);
    for (uint32_t i = 0; i < there; i += step) {
        cli_progress("choosing frames", i, there);
        t3r_capture_frame frame;
        const bool read = i != except && recorded_frame_read(recording, path, i, &frame) == CLI_OK;
        const bool usable = read && (c->depth == T3R_DEPTH_STEREO || frame.frame.depth != NULL);
        if (usable &&
            view_surface_make(&c->surfaces[c->count], &frame, path, i, c->depth == T3R_DEPTH_SENSOR) == CLI_OK) {
            c->frames[c->count++] = i;
        } else if (read && !usable) {
            (void)cli_error(CLI_OK, "%s: frame %" PRIu32 " has no depth (--depth stereo needs none)", path, i);
        }
    }
    cli_keep_errors(NULL, 0);
    cli_progress_end();
    const uint32_t least = c->depth == T3R_DEPTH_STEREO ? 2 : 1;
    return c->count >= least
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT,
                           "--context auto finds %" PRIu32 " frames to choose from, and %" PRIu32 " are needed: %s",
                           c->count, least, why);
}

/* Assumes for all frames the depth that the first two neighbours that can be matched have. */
static int assume_depth(candidates *c, const t3r_recording *recording, const char *path)
{
    char why[512] = "";
    double depth = 0;
    cli_keep_errors(why, sizeof why);
    for (uint32_t apart = 1; apart < c->count && apart <= 8 && depth <= 0; apart *= 2) {
        for (uint32_t a = 0; a + apart < c->count && depth <= 0; a += apart) {
            depth = context_depth_of_pair(recording, path, &c->surfaces[a], c->frames[a], c->frames[a + apart]);
        }
    }
    cli_keep_errors(NULL, 0);
    for (uint32_t i = 0; i < c->count; i++) {
        view_surface_assume(&c->surfaces[i], depth);
    }
    return depth > 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "--context auto: %s", why);
}

static double angle_between(const view_surface *a, const view_surface *b, const double place[3])
{
    double along[2][3], dot = 0, squares[2] = {0};
    for (int i = 0; i < 3; i++) {
        along[0][i] = a->camera.position[i] - place[i];
        along[1][i] = b->camera.position[i] - place[i];
        dot += along[0][i] * along[1][i];
        squares[0] += along[0][i] * along[0][i];
        squares[1] += along[1][i] * along[1][i];
    }
    const double cosine = dot / sqrt(squares[0] * squares[1]);
    return acos(fmin(1, fmax(-1, cosine)));
}

/* Takes every second cell of every second row of all frames, and finds which frames see it from a like direction: only
 * these can draw it for the frame that it is of. */
static int make_points(candidates *c)
{
    c->points = calloc((size_t)c->count * POINTS_OF_FRAME, sizeof *c->points);
    c->seen = calloc((size_t)c->count * c->count * POINTS_OF_FRAME, sizeof *c->seen);
    if (c->points == NULL || c->seen == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t i = 0; i < c->count * POINTS_OF_FRAME; i++) {
        const uint32_t at = i % POINTS_OF_FRAME, across = SURFACE_ACROSS / 2;
        const uint32_t cell = at / across * 2 * SURFACE_ACROSS + at % across * 2;
        const uint32_t owner = i / POINTS_OF_FRAME;
        c->points[c->point_count].owner = owner;
        c->point_count += view_surface_point(&c->surfaces[owner], cell, c->points[c->point_count].place);
    }
    for (uint32_t i = 0; i < c->count; i++) {
        for (uint32_t k = 0; k < c->point_count; k++) {
            const scene_point *p = &c->points[k];
            c->seen[(size_t)i * c->point_count + k] =
                view_surface_sees(&c->surfaces[i], p->place) &&
                angle_between(&c->surfaces[i], &c->surfaces[p->owner], p->place) <= ANGLE_NEAR;
        }
    }
    return CLI_OK;
}

/* ---- choosing -------------------------------------------------------------------------------------------------- */

/* Whether two views of a point give its depth by stereo. */
static bool measures(const view_surface *a, const view_surface *b, const double place[3])
{
    const double angle = angle_between(a, b, place);
    return angle >= ANGLE_LEAST && angle <= ANGLE_MOST;
}

/* Whether a further view counts for point i: by stereo the second one must see it from another place. */
static bool counts(const candidates *c, uint32_t i, uint32_t candidate)
{
    const scene_point *p = &c->points[i];
    return c->seen[(size_t)candidate * c->point_count + i] &&
           (c->depth == T3R_DEPTH_SENSOR || p->views != 1 ||
            measures(&c->surfaces[p->first], &c->surfaces[candidate], p->place));
}

static double gain_of(const candidates *c, uint32_t candidate)
{
    double gain = 0;
    for (uint32_t i = 0; i < c->point_count; i++) {
        const uint32_t views = c->points[i].views;
        gain += counts(c, i, candidate) ? worth[c->depth][views < 2 ? views : 2] : 0;
    }
    return gain;
}

static void take(candidates *c, uint32_t candidate)
{
    for (uint32_t i = 0; i < c->point_count; i++) {
        scene_point *p = &c->points[i];
        if (counts(c, i, candidate)) {
            p->first = p->views == 0 ? candidate : p->first;
            p->views++;
        }
    }
    c->chosen[candidate] = true;
}

static double usual_sharpness(const candidates *c)
{
    double values[CONTEXT_CANDIDATES];
    for (uint32_t i = 0; i < c->count; i++) {
        values[i] = c->surfaces[i].sharpness;
    }
    return view_sharpness_usual(values, c->count);
}

/* Returns the factor of a frame's gain: its sharpness against the usual one, and little for a blurred frame. */
static double weight_of(const view_surface *s, double usual)
{
    const double sharp = usual > 0 ? fmin(1, s->sharpness / usual) : 1;
    return view_sharpness_is_blurred(s->sharpness, usual) ? sharp / 4 : sharp;
}

static void choose(candidates *c)
{
    const double usual = usual_sharpness(c);
    for (uint32_t taken = 0; taken < T3R_MAX_VIEWS; taken++) {
        uint32_t best = c->count;
        double most = taken > 0 ? GAIN_LEAST * c->point_count : 0;
        for (uint32_t i = 0; i < c->count; i++) {
            const double gain = c->chosen[i] ? 0 : gain_of(c, i) * weight_of(&c->surfaces[i], usual);
            if (gain > most) {
                most = gain;
                best = i;
            }
        }
        if (best == c->count) {
            return;
        }
        take(c, best);
    }
}

/* Whether another chosen frame measures enough of this one's surface by stereo. */
static bool has_partner(const candidates *c, uint32_t candidate)
{
    const view_surface *own = &c->surfaces[candidate];
    for (uint32_t other = 0; other < c->count; other++) {
        uint32_t known = 0, shared = 0;
        for (uint32_t cell = 0; cell < SURFACE_CELLS && c->chosen[other] && other != candidate; cell++) {
            double place[3];
            if (view_surface_point(own, cell, place)) {
                known++;
                shared += view_surface_sees(&c->surfaces[other], place) && measures(own, &c->surfaces[other], place);
            }
        }
        if (known > 0 && shared >= PARTNER_LEAST * known) {
            return true;
        }
    }
    return false;
}

int context_choose(const t3r_recording *recording, const char *path, t3r_depth depth, uint32_t except,
                   uint32_t frames[T3R_MAX_VIEWS], uint32_t *count)
{
    candidates c = {.depth = depth};
    *count = 0;
    int code = look(&c, recording, path, except);
    if (code == CLI_OK && depth == T3R_DEPTH_STEREO) {
        code = assume_depth(&c, recording, path);
    }
    code = code == CLI_OK ? make_points(&c) : code;
    if (code == CLI_OK) {
        choose(&c);
        for (uint32_t i = 0; i < c.count; i++) {
            if (c.chosen[i] && (depth == T3R_DEPTH_SENSOR || has_partner(&c, i))) {
                frames[(*count)++] = c.frames[i];
            }
        }
        if (*count < (depth == T3R_DEPTH_STEREO ? 2u : 1u)) {
            code =
                cli_error(CLI_BAD_INPUT, "%s: --context auto: no two frames see the same from different places", path);
        }
    }
    candidates_free(&c);
    return code;
}
