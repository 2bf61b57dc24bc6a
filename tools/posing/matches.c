/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/matches.h"

#include <math.h>
#include <stdlib.h>

#define NONE UINT32_MAX
#define APART_Q8 (5 * 256) /* corners nearer than this are one place: found in several levels, say */

/* What two corners may differ in, of 256 comparisons, and how much more the next place must. */
typedef struct alikeness {
    uint32_t differ_most, better_percent;
} alikeness;

static const alikeness free_rule = {72, 88}, along_rule = {80, 94};

typedef struct epipolar {
    const double *e; /* NULL: any pair */
    double pixels, focal;
} epipolar;

double epipolar_error(const double e[9], const double ray_a[2], const double ray_b[2], double focal)
{
    double a[3] = {e[0] * ray_a[0] + e[1] * ray_a[1] + e[2], e[3] * ray_a[0] + e[4] * ray_a[1] + e[5],
                   e[6] * ray_a[0] + e[7] * ray_a[1] + e[8]};
    double bx = e[0] * ray_b[0] + e[3] * ray_b[1] + e[6], by = e[1] * ray_b[0] + e[4] * ray_b[1] + e[7];
    double slope = sqrt(a[0] * a[0] + a[1] * a[1] + bx * bx + by * by);
    double value = ray_b[0] * a[0] + ray_b[1] * a[1] + a[2];
    return slope > 0 ? focal * value / slope : 0;
}

static bool apart(const corner *a, const corner *b)
{
    return labs((long)a->x_q8 - b->x_q8) > APART_Q8 || labs((long)a->y_q8 - b->y_q8) > APART_Q8;
}

/* The corner of `others` most like `to`, NONE when it is not alike enough or another place nearly as much. row[]:
 * differences by others, UINT16_MAX where the pair is out of the question. */
static uint32_t best(const uint16_t *row, size_t stride, const pose_view *others, const alikeness *rule,
                     uint32_t *rivalry)
{
    uint32_t chosen = NONE, least = UINT16_MAX, next = UINT16_MAX;
    for (uint32_t i = 0; i < others->count; i++) {
        if (row[i * stride] < least) {
            least = row[i * stride];
            chosen = i;
        }
    }
    if (least > rule->differ_most) {
        return NONE;
    }
    for (uint32_t i = 0; i < others->count; i++) {
        uint32_t differ = row[i * stride];
        if (differ < next && apart(&others->corners[i], &others->corners[chosen])) {
            next = differ;
        }
    }
    *rivalry = next == 0 ? 256 : least * 256 / next;
    return least * 100 <= next * rule->better_percent ? chosen : NONE;
}

static int by_rivalry(const void *a, const void *b)
{
    const pose_match *p = a, *q = b;
    return p->rivalry != q->rivalry ? (p->rivalry < q->rivalry ? -1 : 1) : (p->a > q->a) - (p->a < q->a);
}

static uint32_t match(const pose_view *a, const pose_view *b, const epipolar *line, const alikeness *rule,
                      pose_match *matches)
{
    uint16_t *differ = malloc(((size_t)a->count * b->count + 1) * sizeof *differ);
    uint32_t count = 0;
    if (differ == NULL) {
        return 0;
    }
    for (uint32_t i = 0; i < a->count; i++) {
        for (uint32_t j = 0; j < b->count; j++) {
            bool open =
                line->e == NULL || fabs(epipolar_error(line->e, a->rays[i], b->rays[j], line->focal)) <= line->pixels;
            differ[(size_t)i * b->count + j] =
                open ? (uint16_t)corners_differ(&a->corners[i], &b->corners[j]) : UINT16_MAX;
        }
    }
    for (uint32_t i = 0; i < a->count; i++) {
        uint32_t there = 0, back = 0;
        uint32_t j = best(differ + (size_t)i * b->count, 1, b, rule, &there);
        if (j != NONE && best(differ + j, b->count, a, rule, &back) == i) {
            matches[count++] = (pose_match){i, j, there > back ? there : back};
        }
    }
    free(differ);
    qsort(matches, count, sizeof *matches, by_rivalry);
    return count;
}

uint32_t matches_mutual(const pose_view *a, const pose_view *b, pose_match *matches)
{
    return match(a, b, &(epipolar){0}, &free_rule, matches);
}

uint32_t matches_along(const pose_view *a, const pose_view *b, const double e[9], double pixels, pose_match *matches)
{
    return match(a, b, &(epipolar){e, pixels, (a->focal + b->focal) / 2}, &along_rule, matches);
}
