/* SPDX-License-Identifier: Apache-2.0 */
/* A generated room: its objects and the steps that render them, each in a file; procedural_room.c calls them in turn.
 */
#ifndef T3R_PROCEDURAL_SCENE_H
#define T3R_PROCEDURAL_SCENE_H

#include "procedural.h"

/* World: metres, y down, the floor's middle at the origin. */

enum {
    MAX_BODIES = 192,
    MAX_LUXELS = 40000,
    MAX_LIGHTS = 4,
    LIGHT_RAYS = 5,
    SKY_RAYS = 6,
    POSTERS = 3,
    POSTER_SIDE = 160,
    ROOM_MATERIALS = 96,
    MAX_VIEWS = 16,
    NO_FACE = 7,
};

typedef struct {
    float x, y, z;
} vec;

typedef enum { BODY_BOX, BODY_ELLIPSOID, BODY_CYLINDER } body_kind;

/* A body. Faces of a box: -x +x -y +y -z +z; of a cylinder: 0 = mantle, 2 and 3 = ends; of an ellipsoid: 0 */
typedef struct {
    body_kind kind;
    vec centre, half;
    float c, s;      /* yaw about y */
    float reach;     /* radius of the bounding sphere */
    bool inside_out; /* the room itself */
    int material[6];
    int poster[6]; /* -1 = none */
    float glow;    /* emitted light, times the material's colour; 0 for most */
    float offset[2];
    int luxels[6], columns[6], rows[6]; /* boxes: where a face's light is stored */
    float open[MAX_LIGHTS];             /* round bodies: share of each light that reaches them */
} body;

typedef struct {
    vec centre, along, across, normal; /* half edges of a rectangle */
    float colour[3];                   /* intensity times area */
} lamp;

typedef struct {
    float *rgb; /* [POSTER_SIDE][POSTER_SIDE][3] linear, then every coarser level */
} poster;

typedef struct {
    const atlas *shared;
    body bodies[MAX_BODIES];
    int body_count, material_count, luxel_count, lamp_count;
    material materials[ROOM_MATERIALS];
    lamp lamps[MAX_LIGHTS];
    poster posters[POSTERS];
    palette colours;
    float ambient[3];
    vec size; /* full extents; size.y = height */
    /* bodies whose shadows the stored light can resolve: neither lamps nor objects of a few centimetres */
    float caster_x[MAX_BODIES], caster_y[MAX_BODIES], caster_z[MAX_BODIES], caster_reach2[MAX_BODIES];
    int casters[MAX_BODIES], caster_count;
    float (*luxels)[3];
} room;

typedef struct {
    vec at, x, y, z; /* camera axes in the world */
    float fx, fy, cx, cy;
} viewpoint;

static inline vec add(vec a, vec b)
{
    return (vec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec sub(vec a, vec b)
{
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec times(vec a, float k)
{
    return (vec){a.x * k, a.y * k, a.z * k};
}

static inline float dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline vec unit(vec a)
{
    return times(a, 1.0f / sqrtf(maxf(dot(a, a), 1e-20f)));
}

static inline vec to_body(const body *b, vec v)
{
    return (vec){b->c * v.x + b->s * v.z, v.y, b->c * v.z - b->s * v.x};
}

static inline vec from_body(const body *b, vec v)
{
    return (vec){b->c * v.x - b->s * v.z, v.y, b->c * v.z + b->s * v.x};
}

/* ---- rays ------------------------------------------------------------------------------------------------------- */

static inline float safe_inverse(float x)
{
    return 1.0f / (fabsf(x) < 1e-9f ? (x < 0.0f ? -1e-9f : 1e-9f) : x);
}

/* Returns the first hit of at + t along, t > 1e-4, in the body's frame, or INFINITY; sets *face. */
static inline float hit_box(const body *b, vec at, vec along, int *face)
{
    float ix = safe_inverse(along.x), iy = safe_inverse(along.y), iz = safe_inverse(along.z);
    float ax = (-b->half.x - at.x) * ix, bx = (b->half.x - at.x) * ix;
    float ay = (-b->half.y - at.y) * iy, by = (b->half.y - at.y) * iy;
    float az = (-b->half.z - at.z) * iz, bz = (b->half.z - at.z) * iz;
    if (b->inside_out) {
        float tx = maxf(ax, bx), ty = maxf(ay, by), tz = maxf(az, bz), t = minf(tx, minf(ty, tz));
        *face = t == tx ? (along.x > 0.0f) : t == ty ? 2 + (along.y > 0.0f) : 4 + (along.z > 0.0f);
        return t;
    }
    float nx = minf(ax, bx), ny = minf(ay, by), nz = minf(az, bz);
    float enter = maxf(nx, maxf(ny, nz)), leave = minf(maxf(ax, bx), minf(maxf(ay, by), maxf(az, bz)));
    if (enter > leave || enter < 1e-4f) {
        return INFINITY;
    }
    *face = enter == nx ? (along.x < 0.0f) : enter == ny ? 2 + (along.y < 0.0f) : 4 + (along.z < 0.0f);
    return enter;
}

static inline float hit_round(const body *b, vec at, vec along, int *face)
{
    bool cylinder = b->kind == BODY_CYLINDER;
    vec k = {1.0f / b->half.x, 1.0f / b->half.y, 1.0f / b->half.z};
    vec p = {at.x * k.x, at.y * k.y, at.z * k.z}, d = {along.x * k.x, along.y * k.y, along.z * k.z};
    float py = cylinder ? 0.0f : p.y, dy = cylinder ? 0.0f : d.y;
    float a = d.x * d.x + dy * dy + d.z * d.z, h = p.x * d.x + py * dy + p.z * d.z;
    float root = h * h - a * (p.x * p.x + py * py + p.z * p.z - 1.0f);
    float best = INFINITY;
    if (root >= 0.0f && a > 1e-12f) {
        float t = (-h - sqrtf(root)) / a;
        if (t > 1e-4f && (!cylinder || fabsf(p.y + t * d.y) <= 1.0f)) {
            best = t;
            *face = 0;
        }
    }
    if (cylinder && fabsf(d.y) > 1e-9f) {
        float t = ((d.y < 0.0f ? 1.0f : -1.0f) - p.y) / d.y, x = p.x + t * d.x, z = p.z + t * d.z;
        if (t > 1e-4f && t < best && x * x + z * z <= 1.0f) {
            best = t;
            *face = 2 + (d.y < 0.0f);
        }
    }
    return best;
}

static inline float hit(const body *b, vec at, vec along, int *face)
{
    return b->kind == BODY_BOX ? hit_box(b, at, along, face) : hit_round(b, at, along, face);
}

/* ---- parts ------------------------------------------------------------------------------------------------------ */

/* Places materials, tables, chairs, shelves, wall objects and lamps; the room's own walls are body 0. */
void furnish(room *r, generator *g);

/* Diffuse light, [3] linear, from lamps and sky at a place, with the shadows of `casters`. store_light() stores it on
 * a grid over the faces of boxes, stored_light() reads it at s, t of a face, open_light() computes it for round
 * bodies. */
void face_frame(const body *b, int face, vec *middle, vec *along, vec *across, vec *normal);
void store_light(room *r);
void open_light(const room *r, const body *b, vec at, vec normal, float rgb[3]);
void stored_light(const room *r, const body *b, int face, float s, float t, float rgb[3]);

/* Makes a dead-leaves picture for a wall; u and v in 0..1, footprint in poster widths. False: out of memory. */
bool poster_draw(poster *made, const atlas *shared, uint64_t seed);
void poster_at(const poster *p, float u, float v, float footprint, float rgb[3]);

/* Renders one view, [height][width][3] linear and its depth, metres; near and owner: room for SUBSAMPLES^2 rays a
 * pixel. */
void see_room(const room *r, const viewpoint *v, int width, int height, float *near, uint16_t *owner, float *linear,
              float *depth);

/* Makes `views` viewpoints along a walk through the room. */
void path_draw(const room *r, generator *g, int width, int height, int views, viewpoint *made);

#endif
