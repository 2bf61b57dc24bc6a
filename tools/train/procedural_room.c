#include "procedural.h"

#include <stdlib.h>
#include <string.h>

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

/* Faces of a box: -x +x -y +y -z +z; of a cylinder: 0 = mantle, 2 and 3 = ends; of an ellipsoid: 0 */
typedef struct {
    body_kind kind;
    vec centre, half;
    float c, s;      /* yaw about y */
    float reach;     /* radius of the sphere around it */
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
    /* what casts shadows that the stored light can hold: neither lamps nor things of a few centimetres */
    float caster_x[MAX_BODIES], caster_y[MAX_BODIES], caster_z[MAX_BODIES], caster_reach2[MAX_BODIES];
    int casters[MAX_BODIES], caster_count;
    float (*luxels)[3];
} room;

typedef struct {
    vec at, x, y, z; /* camera axes in the world */
    float fx, fy, cx, cy;
} viewpoint;

static vec add(vec a, vec b)
{
    return (vec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static vec sub(vec a, vec b)
{
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static vec times(vec a, float k)
{
    return (vec){a.x * k, a.y * k, a.z * k};
}

static float dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static vec unit(vec a)
{
    return times(a, 1.0f / sqrtf(maxf(dot(a, a), 1e-20f)));
}

static vec to_body(const body *b, vec v)
{
    return (vec){b->c * v.x + b->s * v.z, v.y, b->c * v.z - b->s * v.x};
}

static vec from_body(const body *b, vec v)
{
    return (vec){b->c * v.x - b->s * v.z, v.y, b->c * v.z + b->s * v.x};
}

/* ---- rays ------------------------------------------------------------------------------------------------------- */

static float safe_inverse(float x)
{
    return 1.0f / (fabsf(x) < 1e-9f ? (x < 0.0f ? -1e-9f : 1e-9f) : x);
}

/* First hit of at + t along, t > 1e-4, in the body's frame; INFINITY where there is none. *face: the one hit. */
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

/* Whether something other than the room and `except` lies between at and at + along */
static bool blocked(const room *r, vec at, vec along, int except)
{
    float scale = 1.0f / dot(along, along);
    bool near[MAX_BODIES];
    for (int i = 0; i < r->caster_count; i++) { /* a loop of its own: it vectorises */
        float x = r->caster_x[i] - at.x, y = r->caster_y[i] - at.y, z = r->caster_z[i] - at.z;
        float t = clampf((x * along.x + y * along.y + z * along.z) * scale, 0.0f, 1.0f);
        x -= t * along.x;
        y -= t * along.y;
        z -= t * along.z;
        near[i] = x * x + y * y + z * z <= r->caster_reach2[i];
    }
    for (int i = 0; i < r->caster_count; i++) {
        if (!near[i] || r->casters[i] == except) {
            continue;
        }
        const body *b = &r->bodies[r->casters[i]];
        vec to = sub(b->centre, at);
        int face;
        if (hit(b, to_body(b, times(to, -1.0f)), to_body(b, along), &face) < 1.0f) {
            return true;
        }
    }
    return false;
}

/* ---- furnishing ------------------------------------------------------------------------------------------------- */

static int new_material(room *r, generator *g, float size, float texture)
{
    if (r->material_count == ROOM_MATERIALS) { /* the first are walls and lamps */
        return 8 + draw_index(g, ROOM_MATERIALS - 8);
    }
    material_draw(&r->materials[r->material_count], &r->colours, g, size, texture);
    return r->material_count++;
}

static int new_calm_material(room *r, generator *g, float size, float texture)
{
    if (r->material_count == ROOM_MATERIALS) {
        return new_material(r, g, size, texture);
    }
    material_draw_calm(&r->materials[r->material_count], &r->colours, g, size, texture);
    return r->material_count++;
}

static body *new_body(room *r, generator *g, body_kind kind, vec centre, vec half, float yaw, int of_material)
{
    body *b = &r->bodies[r->body_count < MAX_BODIES ? r->body_count++ : MAX_BODIES - 1];
    memset(b, 0, sizeof *b);
    b->kind = kind;
    b->centre = centre;
    b->half = half;
    b->c = cosf(yaw);
    b->s = sinf(yaw);
    b->reach = sqrtf(dot(half, half));
    for (int i = 0; i < 6; i++) {
        b->material[i] = of_material;
        b->poster[i] = -1;
    }
    b->offset[0] = draw_in(g, -50.0f, 50.0f);
    b->offset[1] = draw_in(g, -50.0f, 50.0f);
    return b;
}

/* Small things on a level rectangle at height y, turned by yaw about `middle` */
static void clutter(room *r, generator *g, vec middle, float half_x, float half_z, float yaw, int count)
{
    float c = cosf(yaw), s = sinf(yaw);
    for (int i = 0; i < count; i++) {
        float size = draw_radius(g, 0.03f, 0.25f), x = draw_in(g, -0.9f, 0.9f) * half_x;
        float z = draw_in(g, -0.9f, 0.9f) * half_z;
        int kind = draw_index(g, 6);
        float high = size * draw_in(g, 0.2f, 1.6f), turn = draw_chance(g, 0.5f) ? yaw : draw_in(g, 0.0f, 3.14f);
        vec half = {size * draw_in(g, 0.4f, 1.0f), high, size * draw_in(g, 0.4f, 1.0f)};
        if (kind == 0) { /* papers, books lying */
            half.y = draw_in(g, 0.004f, 0.02f);
        }
        if (kind >= 4) {
            half.z = half.x = 0.5f * size;
        }
        vec at = {middle.x + c * x - s * z, middle.y - half.y, middle.z + c * z + s * x};
        body *b = new_body(r, g,
                           kind < 4    ? BODY_BOX
                           : kind == 4 ? BODY_CYLINDER
                                       : BODY_ELLIPSOID,
                           at, half, turn, new_material(r, g, 2.0f * size, 0.6f));
        if (kind == 1) {
            b->poster[draw_index(g, 6)] = draw_index(g, POSTERS);
        }
    }
}

static void table(room *r, generator *g, vec foot, float yaw)
{
    float half_x = draw_in(g, 0.35f, 0.9f), half_z = draw_in(g, 0.3f, 0.5f), high = draw_in(g, 0.4f, 0.95f);
    float thick = draw_in(g, 0.01f, 0.03f), c = cosf(yaw), s = sinf(yaw);
    int top = new_calm_material(r, g, 1.0f, 0.4f), legs = new_material(r, g, 0.5f, 0.1f);
    new_body(r, g, BODY_BOX, (vec){foot.x, -high, foot.z}, (vec){half_x, thick, half_z}, yaw, top);
    float leg = draw_in(g, 0.015f, 0.04f);
    body_kind kind = draw_chance(g, 0.4f) ? BODY_CYLINDER : BODY_BOX;
    for (int i = 0; i < 4; i++) {
        float x = (i & 1 ? 0.9f : -0.9f) * half_x, z = (i & 2 ? 0.9f : -0.9f) * half_z;
        new_body(r, g, kind, (vec){foot.x + c * x - s * z, -0.5f * (high - thick), foot.z + c * z + s * x},
                 (vec){leg, 0.5f * (high - thick), leg}, yaw, legs);
    }
    clutter(r, g, (vec){foot.x, -high - thick, foot.z}, half_x, half_z, yaw, 2 + draw_index(g, 16));
}

static void chair(room *r, generator *g, vec foot, float yaw)
{
    float half = draw_in(g, 0.2f, 0.27f), high = draw_in(g, 0.4f, 0.5f), back = draw_in(g, 0.2f, 0.3f);
    float c = cosf(yaw), s = sinf(yaw);
    int seat = new_material(r, g, 0.5f, 0.4f), legs = new_material(r, g, 0.5f, 0.1f);
    new_body(r, g, BODY_BOX, (vec){foot.x, -high, foot.z}, (vec){half, 0.03f, half}, yaw, seat);
    new_body(r, g, BODY_BOX, (vec){foot.x - s * half, -high - 0.15f - back, foot.z + c * half},
             (vec){half, back, 0.02f}, yaw, seat);
    for (int i = 0; i < 4; i++) {
        float x = (i & 1 ? 0.85f : -0.85f) * half, z = (i & 2 ? 0.85f : -0.85f) * half;
        new_body(r, g, BODY_CYLINDER, (vec){foot.x + c * x - s * z, -0.5f * high, foot.z + c * z + s * x},
                 (vec){0.015f, 0.5f * high, 0.015f}, yaw, legs);
    }
}

/* Boards between two sides, with rows of books and things on them; its back stands at the wall */
static void shelf(room *r, generator *g, vec foot, float yaw)
{
    float half_x = draw_in(g, 0.3f, 0.6f), half_z = draw_in(g, 0.13f, 0.2f), high = draw_in(g, 0.8f, 2.0f);
    float c = cosf(yaw), s = sinf(yaw), pitch = draw_in(g, 0.28f, 0.4f);
    int wood = new_calm_material(r, g, 1.0f, 0.3f);
    for (int i = -1; i <= 1; i += 2) {
        float x = (float)i * half_x;
        new_body(r, g, BODY_BOX, (vec){foot.x + c * x, -0.5f * high, foot.z + s * x},
                 (vec){0.012f, 0.5f * high, half_z}, yaw, wood);
    }
    for (float y = 0.05f; y < high; y += pitch) {
        new_body(r, g, BODY_BOX, (vec){foot.x, -y, foot.z}, (vec){half_x, 0.01f, half_z}, yaw, wood);
        if (y + pitch > high + 0.1f) {
            break;
        }
        if (draw_chance(g, 0.6f)) {
            int books = new_material(r, g, 0.5f, 1.0f);
            material *m = &r->materials[books];
            m->pattern = PATTERN_BOOKS;
            m->period = draw_in(g, 0.03f, 0.08f);
            m->ca = 1.0f;
            m->sa = 0.0f;
            float wide = half_x * draw_in(g, 0.3f, 0.95f), tall = pitch * draw_in(g, 0.25f, 0.42f);
            float x = draw_in(g, -1.0f, 1.0f) * (half_x - wide);
            new_body(r, g, BODY_BOX, (vec){foot.x + c * x, -y - tall, foot.z + s * x}, (vec){wide, tall, 0.8f * half_z},
                     yaw, books);
        } else {
            clutter(r, g, (vec){foot.x, -y - 0.01f, foot.z}, 0.8f * half_x, 0.5f * half_z, yaw, draw_index(g, 4));
        }
    }
}

static void cabinet(room *r, generator *g, vec foot, float yaw)
{
    vec half = {draw_in(g, 0.25f, 0.7f), draw_in(g, 0.2f, 1.0f), draw_in(g, 0.2f, 0.35f)};
    float c = cosf(yaw), s = sinf(yaw);
    body *b = new_body(r, g, BODY_BOX, (vec){foot.x, -half.y, foot.z}, half, yaw, new_calm_material(r, g, 1.0f, 0.4f));
    b->material[2] = new_material(r, g, 1.0f, 0.2f);
    if (draw_chance(g, 0.3f)) {
        b->poster[4] = draw_index(g, POSTERS);
    }
    int drawers = draw_index(g, 5), front = new_calm_material(r, g, 1.0f, 0.3f), knob = new_material(r, g, 0.1f, 0.0f);
    for (int i = 0; i < drawers; i++) {
        float y = -2.0f * half.y * ((float)i + 0.5f) / (float)drawers, z = -half.z - 0.008f;
        new_body(r, g, BODY_BOX, (vec){foot.x - s * z, y, foot.z + c * z},
                 (vec){0.96f * half.x, 0.93f * half.y / (float)drawers, 0.008f}, yaw, front);
        new_body(r, g, BODY_BOX, (vec){foot.x - s * (z - 0.02f), y, foot.z + c * (z - 0.02f)},
                 (vec){0.06f, 0.008f, 0.012f}, yaw, knob);
    }
    clutter(r, g, (vec){foot.x, -2.0f * half.y, foot.z}, half.x, half.z, yaw, 1 + draw_index(g, 9));
}

/* A place at one of the walls: yaw turns -z, a thing's front, into the room */
static vec at_wall(const room *r, generator *g, float depth, float *yaw)
{
    int side = draw_index(g, 4);
    float x = draw_in(g, -0.42f, 0.42f) * r->size.x, z = draw_in(g, -0.42f, 0.42f) * r->size.z;
    *yaw = 1.5707963f * (float)side;
    switch (side) {
    case 0:
        return (vec){x, 0.0f, 0.5f * r->size.z - depth};
    case 1:
        return (vec){-0.5f * r->size.x + depth, 0.0f, z};
    case 2:
        return (vec){x, 0.0f, -0.5f * r->size.z + depth};
    default:
        return (vec){0.5f * r->size.x - depth, 0.0f, z};
    }
}

static void hang_on_walls(room *r, generator *g)
{
    for (int n = 3 + draw_index(g, 11); n > 0; n--) {
        float yaw;
        vec at = at_wall(r, g, 0.012f, &yaw), half = {draw_in(g, 0.12f, 0.6f), draw_in(g, 0.12f, 0.5f), 0.012f};
        at.y = -draw_in(g, 1.0f, maxf(r->size.y - half.y, 1.1f));
        int kind = draw_index(g, 5);
        if (kind == 0) { /* a door */
            half = (vec){0.45f, 1.0f, 0.02f};
            at.y = -1.0f;
        }
        body *b = new_body(r, g, BODY_BOX, at, half, yaw, new_material(r, g, 2.0f * half.x, kind == 1 ? 0.9f : 0.2f));
        if (kind >= 2) {
            b->poster[4] = draw_index(g, POSTERS);
        }
    }
}

static void light_room(room *r, generator *g)
{
    for (int n = 1 + draw_index(g, 3); n > 0 && r->lamp_count < MAX_LIGHTS; n--) {
        lamp *l = &r->lamps[r->lamp_count++];
        bool window = draw_chance(g, 0.4f);
        vec half;
        float yaw = 0.0f, strength = draw_in(g, 0.5f, 2.0f);
        if (window) {
            l->centre = at_wall(r, g, 0.03f, &yaw);
            l->centre.y = -0.6f * r->size.y;
            half = (vec){draw_in(g, 0.4f, 1.2f), draw_in(g, 0.4f, 0.7f), 0.01f};
            l->normal = (vec){sinf(yaw), 0.0f, -cosf(yaw)};
            l->along = (vec){half.x * cosf(yaw), 0.0f, half.x * sinf(yaw)};
            l->across = (vec){0.0f, half.y, 0.0f};
        } else {
            l->centre =
                (vec){draw_in(g, -0.35f, 0.35f) * r->size.x, -r->size.y + 0.04f, draw_in(g, -0.35f, 0.35f) * r->size.z};
            half = (vec){draw_in(g, 0.1f, 0.6f), 0.02f, draw_in(g, 0.1f, 0.6f)};
            l->normal = (vec){0.0f, 1.0f, 0.0f};
            l->along = (vec){half.x, 0.0f, 0.0f};
            l->across = (vec){0.0f, 0.0f, half.z};
        }
        float warm = window ? -0.06f : 0.08f * draw(g);
        l->colour[0] = strength * (1.0f + warm);
        l->colour[1] = strength;
        l->colour[2] = strength * (1.0f - warm);
        body *b = new_body(r, g, BODY_BOX, l->centre, half, yaw, new_material(r, g, 1.0f, 0.0f));
        b->glow = window ? 1.0f : 2.0f;
        for (int c = 0; c < 3; c++) {
            r->materials[b->material[0]].colour[0][c] = 1.0f;
        }
        r->materials[b->material[0]].weave_amount = 0.0f;
    }
    float base = draw_in(g, 0.08f, 0.4f);
    for (int c = 0; c < 3; c++) {
        r->ambient[c] = base * r->colours.light[c];
    }
}

static void furnish(room *r, generator *g)
{
    float texture = draw_in(g, 0.2f, 0.9f);
    palette_draw(&r->colours, g);
    r->size = (vec){draw_in(g, 2.6f, 7.0f), draw_in(g, 2.2f, 3.2f), draw_in(g, 2.6f, 7.0f)};
    body *walls = new_body(r, g, BODY_BOX, (vec){0.0f, -0.5f * r->size.y, 0.0f}, times(r->size, 0.5f), 0.0f,
                           new_calm_material(r, g, 2.0f, texture * draw(g)));
    walls->inside_out = true;
    walls->material[3] = new_calm_material(r, g, 1.5f, texture); /* floor */
    walls->material[2] = new_calm_material(r, g, 2.0f, 0.1f);
    if (draw_chance(g, 0.5f)) {
        walls->material[draw_index(g, 2)] = new_calm_material(r, g, 2.0f, texture);
    }
    light_room(r, g);
    hang_on_walls(r, g);
    if (draw_chance(g, 0.7f)) { /* skirting */
        int m = new_material(r, g, 1.0f, 0.1f);
        float high = draw_in(g, 0.03f, 0.08f);
        for (int i = 0; i < 4; i++) {
            bool x = i & 1;
            float sign = i & 2 ? 1.0f : -1.0f;
            new_body(r, g, BODY_BOX,
                     (vec){x ? 0.0f : sign * (0.5f * r->size.x - 0.008f), -high,
                           x ? sign * (0.5f * r->size.z - 0.008f) : 0.0f},
                     (vec){x ? 0.5f * r->size.x : 0.008f, high, x ? 0.008f : 0.5f * r->size.z}, 0.0f, m);
        }
    }
    for (int n = 3 + draw_index(g, 8); n > 0 && r->body_count < MAX_BODIES - 40; n--) {
        float yaw;
        vec foot = at_wall(r, g, 0.36f, &yaw);
        yaw += draw_chance(g, 0.2f) ? 0.2f * draw_normal(g) : 0.0f;
        switch (draw_index(g, 4)) {
        case 0:
            shelf(r, g, foot, yaw);
            break;
        case 1:
            table(r, g, foot, yaw);
            break;
        default:
            cabinet(r, g, foot, yaw);
            break;
        }
    }
    for (int n = draw_index(g, 6); n > 0 && r->body_count < MAX_BODIES - 25; n--) {
        vec foot = {draw_in(g, -0.35f, 0.35f) * r->size.x, 0.0f, draw_in(g, -0.35f, 0.35f) * r->size.z};
        float yaw = draw_in(g, 0.0f, 6.28f);
        if (draw_chance(g, 0.5f)) {
            chair(r, g, foot, yaw);
        } else {
            table(r, g, foot, draw_chance(g, 0.5f) ? 0.0f : yaw);
        }
    }
    clutter(r, g, (vec){0.0f, 0.0f, 0.0f}, 0.45f * r->size.x, 0.45f * r->size.z, 0.0f, draw_index(g, 20));
}

/* ---- light ------------------------------------------------------------------------------------------------------ */

/* A face's middle, its half edges, and its outward normal (into the room for the room itself), in the body's frame */
static void face_frame(const body *b, int face, vec *middle, vec *along, vec *across, vec *normal)
{
    float sign = face & 1 ? 1.0f : -1.0f;
    vec h = b->half;
    switch (face >> 1) {
    case 0:
        *middle = (vec){sign * h.x, 0.0f, 0.0f};
        *along = (vec){0.0f, 0.0f, h.z};
        *across = (vec){0.0f, h.y, 0.0f};
        *normal = (vec){sign, 0.0f, 0.0f};
        break;
    case 1:
        *middle = (vec){0.0f, sign * h.y, 0.0f};
        *along = (vec){h.x, 0.0f, 0.0f};
        *across = (vec){0.0f, 0.0f, h.z};
        *normal = (vec){0.0f, sign, 0.0f};
        break;
    default:
        *middle = (vec){0.0f, 0.0f, sign * h.z};
        *along = (vec){h.x, 0.0f, 0.0f};
        *across = (vec){0.0f, h.y, 0.0f};
        *normal = (vec){0.0f, 0.0f, sign};
        break;
    }
    if (b->inside_out) {
        *normal = times(*normal, -1.0f);
    }
}

static float lamp_reaches(const lamp *l, vec at, vec normal)
{
    vec to = sub(l->centre, at);
    float d2 = dot(to, to), d = sqrtf(d2);
    float leaves = -dot(l->normal, to) / d, meets = dot(normal, to) / d;
    return leaves > 0.0f && meets > 0.0f ? leaves * meets / (0.3f + d2) : 0.0f;
}

static void light_at(const room *r, vec at, vec normal, int self, float rgb[3])
{
    static const float spot[LIGHT_RAYS][2] = {
        {0.0f, 0.0f}, {0.7f, 0.35f}, {-0.35f, 0.7f}, {-0.7f, -0.35f}, {0.35f, -0.7f}};
    static const float sky[SKY_RAYS][3] = {{0.0f, 0.0f, 1.0f}, {0.8f, 0.0f, 0.6f},   {-0.8f, 0.1f, 0.6f},
                                           {0.1f, 0.8f, 0.6f}, {-0.1f, -0.8f, 0.6f}, {0.6f, 0.6f, 0.52f}};
    vec side = unit(fabsf(normal.y) > 0.9f ? (vec){1.0f, 0.0f, 0.0f} : cross(normal, (vec){0.0f, 1.0f, 0.0f}));
    vec other = cross(normal, side);
    at = add(at, times(normal, 0.003f));
    float open = 0.0f;
    const body *walls = &r->bodies[0];
    for (int i = 0; i < SKY_RAYS; i++) {
        vec to = add(add(times(side, sky[i][0]), times(other, sky[i][1])), times(normal, sky[i][2]));
        int face;
        float wall = hit_box(walls, sub(at, walls->centre), to, &face);
        float near = blocked(r, at, times(to, 0.7f), self) ? 0.15f : 1.0f;
        open += near * clampf(0.4f + 0.6f * wall, 0.4f, 1.0f);
    }
    for (int c = 0; c < 3; c++) {
        rgb[c] = r->ambient[c] * open * (1.0f / SKY_RAYS);
    }
    for (int k = 0; k < r->lamp_count; k++) {
        const lamp *l = &r->lamps[k];
        float reach = lamp_reaches(l, at, normal);
        if (reach < 1e-4f) {
            continue;
        }
        int free_rays = 0;
        for (int i = 0; i < LIGHT_RAYS; i++) {
            vec to = add(l->centre, add(times(l->along, spot[i][0]), times(l->across, spot[i][1])));
            free_rays += !blocked(r, at, sub(to, at), self);
        }
        for (int c = 0; c < 3; c++) {
            rgb[c] += reach * l->colour[c] * (float)free_rays * (1.0f / LIGHT_RAYS);
        }
    }
}

/* Light is stored on a lattice over every box face, 13 to 18 cm apart where that is not too many */
static void store_light(room *r)
{
    for (int i = 1; i < r->body_count; i++) {
        const body *b = &r->bodies[i];
        if (b->glow > 0.0f || b->reach < 0.08f) {
            continue;
        }
        r->caster_x[r->caster_count] = b->centre.x;
        r->caster_y[r->caster_count] = b->centre.y;
        r->caster_z[r->caster_count] = b->centre.z;
        r->caster_reach2[r->caster_count] = b->reach * b->reach;
        r->casters[r->caster_count++] = i;
    }
    for (int i = 0; i < r->body_count; i++) {
        body *b = &r->bodies[i];
        if (b->kind != BODY_BOX) {
            for (int k = 0; k < r->lamp_count; k++) {
                int free_rays = 0;
                for (int j = -1; j <= 1; j++) {
                    vec from = {b->centre.x, b->centre.y + (float)j * 0.8f * b->half.y, b->centre.z};
                    free_rays += !blocked(r, from, sub(r->lamps[k].centre, from), i);
                }
                b->open[k] = (float)free_rays * (1.0f / 3.0f);
            }
            continue;
        }
        for (int face = 0; face < 6; face++) {
            vec middle, along, across, normal;
            face_frame(b, face, &middle, &along, &across, &normal);
            float wide = sqrtf(dot(along, along)), high = sqrtf(dot(across, across));
            float pitch = b->inside_out ? 0.18f : 0.13f;
            b->columns[face] = 2 + (int)minf(2.0f * wide / pitch, 40.0f);
            b->rows[face] = 2 + (int)minf(2.0f * high / pitch, 40.0f);
            if (r->luxel_count + b->columns[face] * b->rows[face] > MAX_LUXELS) {
                b->columns[face] = b->rows[face] = 2;
            }
            b->luxels[face] = r->luxel_count;
            r->luxel_count += b->columns[face] * b->rows[face];
            for (int y = 0; y < b->rows[face]; y++) {
                for (int x = 0; x < b->columns[face]; x++) {
                    /* a little inside the edge: corner points lie in neighbours */
                    float s = 0.98f * (2.0f * (float)x / (float)(b->columns[face] - 1) - 1.0f);
                    float t = 0.98f * (2.0f * (float)y / (float)(b->rows[face] - 1) - 1.0f);
                    vec at = add(middle, add(times(along, s), times(across, t)));
                    light_at(r, add(b->centre, from_body(b, at)), from_body(b, normal), b->inside_out ? -1 : i,
                             r->luxels[b->luxels[face] + y * b->columns[face] + x]);
                }
            }
        }
    }
}

/* Round bodies: the body's share of each lamp, without shadows on itself but its own */
static void open_light(const room *r, const body *b, vec at, vec normal, float rgb[3])
{
    for (int c = 0; c < 3; c++) {
        rgb[c] = r->ambient[c] * (0.6f - 0.35f * normal.y);
    }
    for (int k = 0; k < r->lamp_count; k++) {
        float reach = b->open[k] * lamp_reaches(&r->lamps[k], at, normal);
        for (int c = 0; c < 3; c++) {
            rgb[c] += reach * r->lamps[k].colour[c];
        }
    }
}

/* s and t in -1..1 over the face */
static void stored_light(const room *r, const body *b, int face, float s, float t, float rgb[3])
{
    int columns = b->columns[face], rows = b->rows[face];
    float x = clampf(0.5f * (s + 1.0f) * (float)(columns - 1), 0.0f, (float)(columns - 1) - 1e-3f);
    float y = clampf(0.5f * (t + 1.0f) * (float)(rows - 1), 0.0f, (float)(rows - 1) - 1e-3f);
    int x0 = (int)x, y0 = (int)y;
    float u = x - (float)x0, v = y - (float)y0;
    const float(*from)[3] = (const float(*)[3])r->luxels + b->luxels[face] + y0 * columns + x0;
    for (int c = 0; c < 3; c++) {
        float top = from[0][c] + u * (from[1][c] - from[0][c]);
        float low = from[columns][c] + u * (from[columns + 1][c] - from[columns][c]);
        rgb[c] = top + v * (low - top);
    }
}

/* ---- posters ---------------------------------------------------------------------------------------------------- */

static bool poster_draw(poster *made, const atlas *shared, uint64_t seed)
{
    size_t texels = (size_t)POSTER_SIDE * POSTER_SIDE;
    made->rgb = malloc(2 * texels * 3 * sizeof *made->rgb);
    uint8_t *image = malloc(texels * 3);
    float *depth = malloc(texels * sizeof *depth);
    bool good =
        made->rgb && image && depth && procedural_leaves(shared, seed, POSTER_SIDE, POSTER_SIDE, image, depth) == 0;
    if (good) {
        for (size_t i = 0; i < 3 * texels; i++) {
            float x = (float)image[i] * (1.0f / 255.0f);
            made->rgb[i] = 0.01f + 0.8f * x * x;
        }
        const float *from = made->rgb;
        float *to = made->rgb + 3 * texels;
        for (int side = POSTER_SIDE / 2; side >= 5; side /= 2) {
            for (int y = 0; y < side; y++) {
                for (int i = 0; i < 3 * side; i++) {
                    const float *p = from + (2 * y) * 6 * side + 6 * (i / 3) + i % 3;
                    to[y * 3 * side + i] = 0.25f * (p[0] + p[3] + p[6 * side] + p[6 * side + 3]);
                }
            }
            from = to;
            to += 3 * side * side;
        }
    }
    free(image);
    free(depth);
    return good;
}

/* u and v in 0..1, footprint in poster widths */
static void poster_at(const poster *p, float u, float v, float footprint, float rgb[3])
{
    int side = POSTER_SIDE;
    const float *level = p->rgb;
    for (float texels = footprint * POSTER_SIDE; texels > 1.5f && side > 5; texels *= 0.5f) {
        level += 3 * side * side;
        side /= 2;
    }
    float x = clampf(u * (float)side - 0.5f, 0.0f, (float)side - 1.001f);
    float y = clampf(v * (float)side - 0.5f, 0.0f, (float)side - 1.001f);
    int x0 = (int)x, y0 = (int)y;
    float s = x - (float)x0, t = y - (float)y0;
    level += 3 * (y0 * side + x0);
    for (int c = 0; c < 3; c++) {
        float a = level[c] + s * (level[c + 3] - level[c]);
        float b = level[3 * side + c] + s * (level[3 * side + c + 3] - level[3 * side + c]);
        rgb[c] = a + t * (b - a);
    }
}

/* ---- one view --------------------------------------------------------------------------------------------------- */

static vec ray_of(const viewpoint *v, float x, float y)
{
    return add(v->z, add(times(v->x, (x - v->cx) / v->fx), times(v->y, (y - v->cy) / v->fy)));
}

/* Rows and columns of subsamples that may see the body; all of them where it reaches behind the camera */
static void screen_box(const body *b, const viewpoint *v, int columns, int rows, int box[4])
{
    float low_x = 1e9f, low_y = 1e9f, high_x = -1e9f, high_y = -1e9f;
    box[0] = box[1] = 0;
    box[2] = columns;
    box[3] = rows;
    /* beside the picture's four sides with all of its sphere? */
    vec middle = sub(b->centre, v->at);
    float mx = v->fx * dot(middle, v->x), my = v->fy * dot(middle, v->y), mz = dot(middle, v->z);
    float right = (float)columns / SUBSAMPLES - 0.5f - v->cx, low = (float)rows / SUBSAMPLES - 0.5f - v->cy;
    float left = v->cx + 0.5f, top = v->cy + 0.5f;
    if (!b->inside_out && (mz < -b->reach || mx + left * mz < -b->reach * sqrtf(v->fx * v->fx + left * left) ||
                           right * mz - mx < -b->reach * sqrtf(v->fx * v->fx + right * right) ||
                           my + top * mz < -b->reach * sqrtf(v->fy * v->fy + top * top) ||
                           low * mz - my < -b->reach * sqrtf(v->fy * v->fy + low * low))) {
        box[2] = box[3] = 0;
        return;
    }
    for (int i = 0; i < 8 && !b->inside_out; i++) {
        vec corner = {i & 1 ? b->half.x : -b->half.x, i & 2 ? b->half.y : -b->half.y, i & 4 ? b->half.z : -b->half.z};
        vec p = sub(add(b->centre, from_body(b, corner)), v->at);
        float z = dot(p, v->z);
        if (z < 0.05f) {
            return;
        }
        float x = v->fx * dot(p, v->x) / z + v->cx, y = v->fy * dot(p, v->y) / z + v->cy;
        low_x = minf(low_x, x);
        high_x = maxf(high_x, x);
        low_y = minf(low_y, y);
        high_y = maxf(high_y, y);
    }
    if (!b->inside_out) {
        box[0] = (int)clampf((low_x - 0.5f) * SUBSAMPLES, 0.0f, (float)columns);
        box[1] = (int)clampf((low_y - 0.5f) * SUBSAMPLES, 0.0f, (float)rows);
        box[2] = (int)clampf((high_x + 1.5f) * SUBSAMPLES, 0.0f, (float)columns);
        box[3] = (int)clampf((high_y + 1.5f) * SUBSAMPLES, 0.0f, (float)rows);
    }
}

/* hit_box() along a row of rays, without branches, so that it vectorises; faces: 0..5 */
static void hit_box_row(const body *b, vec at, vec row, vec right, int from, int to, float *depths, int *faces)
{
    vec h = b->half;
    for (int x = from; x < to; x++) {
        vec along = {row.x + right.x * (float)x, row.y + right.y * (float)x, row.z + right.z * (float)x};
        float ix = safe_inverse(along.x), iy = safe_inverse(along.y), iz = safe_inverse(along.z);
        float ax = (-h.x - at.x) * ix, bx = (h.x - at.x) * ix, ay = (-h.y - at.y) * iy, by = (h.y - at.y) * iy;
        float az = (-h.z - at.z) * iz, bz = (h.z - at.z) * iz;
        float nx = minf(ax, bx), ny = minf(ay, by), nz = minf(az, bz);
        float enter = maxf(nx, maxf(ny, nz)), leave = minf(maxf(ax, bx), minf(maxf(ay, by), maxf(az, bz)));
        int face_x = along.x < 0.0f, face_y = 2 + (along.y < 0.0f), face_z = 4 + (along.z < 0.0f);
        int face = enter == ny ? face_y : face_z;
        faces[x] = enter == nx ? face_x : face;
        depths[x] = (enter <= leave) & (enter >= 1e-4f) ? enter : INFINITY;
    }
}

static void see_body(const body *b, int index, const viewpoint *v, int columns, int rows, float *near, uint16_t *owner)
{
    int box[4];
    const float step = 1.0f / SUBSAMPLES, first = 0.5f * step - 0.5f;
    screen_box(b, v, columns, rows, box);
    vec at = to_body(b, sub(v->at, b->centre));
    vec corner = to_body(b, ray_of(v, first, first));
    vec right = to_body(b, times(v->x, step / v->fx)), down = to_body(b, times(v->y, step / v->fy));
    bool rows_at_once = b->kind == BODY_BOX && !b->inside_out;
    for (int y = box[1]; y < box[3]; y++) {
        vec row = add(corner, times(down, (float)y));
        if (rows_at_once) {
            float depths[2048 * SUBSAMPLES];
            int faces[2048 * SUBSAMPLES];
            hit_box_row(b, at, row, right, box[0], box[2], depths, faces);
            for (int x = box[0]; x < box[2]; x++) {
                size_t i = (size_t)y * columns + x;
                if (depths[x] < near[i]) {
                    near[i] = depths[x];
                    owner[i] = (uint16_t)(index * 8 + faces[x]);
                }
            }
            continue;
        }
        for (int x = box[0]; x < box[2]; x++) {
            int face = NO_FACE;
            float z = hit(b, at, add(row, times(right, (float)x)), &face);
            size_t i = (size_t)y * columns + x;
            if (z < near[i]) {
                near[i] = z;
                owner[i] = (uint16_t)(index * 8 + face);
            }
        }
    }
}

static void shade_hit(const room *r, const viewpoint *v, int owner, float x, float y, float rgb[3])
{
    const body *b = &r->bodies[owner >> 3];
    int face = owner & 7;
    vec at = to_body(b, sub(v->at, b->centre)), along = to_body(b, ray_of(v, x, y));
    float light[3], slope, z;
    vec p;
    const material *m = &r->materials[b->material[face]];
    if (b->kind == BODY_BOX || face != 0) {
        vec middle, s, t, normal;
        face_frame(b, face, &middle, &s, &t, &normal);
        float towards = dot(along, normal);
        z = dot(sub(middle, at), normal) / (fabsf(towards) < 1e-6f ? -1e-6f : towards);
        p = add(at, times(along, z));
        slope = fabsf(towards) / sqrtf(dot(along, along));
        float ss = dot(p, s) / dot(s, s), tt = dot(p, t) / dot(t, t);
        float wide = sqrtf(dot(s, s)), high = sqrtf(dot(t, t));
        float footprint = z / (v->fx * sqrtf(maxf(slope, 0.05f)));
        if (b->poster[face] >= 0) {
            poster_at(&r->posters[b->poster[face]], 0.5f * ss + 0.5f, 0.5f * tt + 0.5f, footprint / (2.0f * wide), rgb);
        } else {
            material_at(r->shared, m, ss * wide + b->offset[0], tt * high + b->offset[1] + (float)face, footprint, rgb);
        }
        if (b->kind == BODY_BOX) {
            stored_light(r, b, face, ss, tt, light);
        } else {
            open_light(r, b, add(b->centre, from_body(b, p)), from_body(b, normal), light);
        }
    } else {
        int ignored;
        z = hit_round(b, at, along, &ignored);
        if (!(z < 1e6f)) { /* the mean of the rays that met it misses it by a hair: its limb */
            z = -dot(at, along) / dot(along, along);
        }
        p = add(at, times(along, z));
        vec normal = {p.x / (b->half.x * b->half.x), p.y / (b->half.y * b->half.y), p.z / (b->half.z * b->half.z)};
        if (b->kind == BODY_CYLINDER) {
            normal.y = 0.0f;
        }
        normal = unit(normal);
        bool flat = fabsf(normal.x) > fabsf(normal.z);
        material_at(r->shared, m, (flat ? p.z : p.x) + b->offset[0], p.y + b->offset[1], z / v->fx, rgb);
        open_light(r, b, add(b->centre, from_body(b, p)), from_body(b, normal), light);
    }
    for (int c = 0; c < 3; c++) {
        rgb[c] *= light[c] + b->glow;
    }
}

static void see_room(const room *r, const viewpoint *v, int width, int height, float *near, uint16_t *owner,
                     float *linear, float *depth)
{
    int columns = width * SUBSAMPLES, rows = height * SUBSAMPLES;
    const float step = 1.0f / SUBSAMPLES, first = 0.5f * step - 0.5f;
    for (size_t i = 0; i < (size_t)columns * rows; i++) {
        near[i] = INFINITY;
    }
    for (int i = 0; i < r->body_count; i++) {
        see_body(&r->bodies[i], i, v, columns, rows, near, owner);
    }
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            int seen = 0;
            float sum[3] = {0.0f, 0.0f, 0.0f};
            bool done[SUBSAMPLES * SUBSAMPLES] = {false};
            uint16_t owners[SUBSAMPLES * SUBSAMPLES];
            for (int j = 0; j < SUBSAMPLES * SUBSAMPLES; j++) {
                owners[j] =
                    owner[(size_t)(y * SUBSAMPLES + j / SUBSAMPLES) * columns + x * SUBSAMPLES + j % SUBSAMPLES];
            }
            for (int j = 0; j < SUBSAMPLES * SUBSAMPLES; j++) {
                if (done[j]) {
                    continue;
                }
                float sx = 0.0f, sy = 0.0f, rgb[3];
                seen = 0;
                for (int k = j; k < SUBSAMPLES * SUBSAMPLES; k++) {
                    if (owners[k] == owners[j]) {
                        done[k] = true;
                        seen++;
                        sx += first + step * (float)(k % SUBSAMPLES);
                        sy += first + step * (float)(k / SUBSAMPLES);
                    }
                }
                shade_hit(r, v, owners[j], (float)x + sx / (float)seen, (float)y + sy / (float)seen, rgb);
                for (int c = 0; c < 3; c++) {
                    sum[c] += rgb[c] * (float)seen * step * step;
                }
            }
            memcpy(linear + 3 * (y * width + x), sum, sizeof sum);
            depth[y * width + x] =
                near[(size_t)(y * SUBSAMPLES + SUBSAMPLES / 2) * columns + x * SUBSAMPLES + SUBSAMPLES / 2];
        }
    }
}

/* ---- the path --------------------------------------------------------------------------------------------------- */

static bool free_place(const room *r, vec at, float margin)
{
    if (fabsf(at.x) > 0.5f * r->size.x - margin || fabsf(at.z) > 0.5f * r->size.z - margin || at.y > -0.3f ||
        at.y < 0.2f - r->size.y) {
        return false;
    }
    for (int i = 1; i < r->body_count; i++) {
        const body *b = &r->bodies[i];
        vec p = to_body(b, sub(at, b->centre));
        if (fabsf(p.x) < b->half.x + margin && fabsf(p.y) < b->half.y + margin && fabsf(p.z) < b->half.z + margin) {
            return false;
        }
    }
    return true;
}

static float distance_seen(const room *r, vec at, vec along)
{
    float best = INFINITY;
    for (int i = 0; i < r->body_count; i++) {
        int face;
        const body *b = &r->bodies[i];
        best = minf(best, hit(b, to_body(b, sub(at, b->centre)), to_body(b, along), &face));
    }
    return best;
}

static void look_at(viewpoint *v, vec target, float roll)
{
    v->z = unit(sub(target, v->at));
    vec x = unit(cross((vec){0.0f, 1.0f, 0.0f}, v->z)), y = cross(v->z, x);
    v->x = add(times(x, cosf(roll)), times(y, sinf(roll)));
    v->y = sub(times(y, cosf(roll)), times(x, sinf(roll)));
}

/* A walk of at most a quarter of the distance looked at, eyes on what lies there, a hand's tremor added. The last try
 * is taken whatever it sees: every room has a picture. */
static void path_draw(const room *r, generator *g, int width, int height, int views, viewpoint *made)
{
    float side = (float)(width < height ? width : height), focal = side * draw_in(g, 0.86f, 1.17f);
    for (int attempt = 0; attempt < 60; attempt++) {
        vec middle = {draw_in(g, -0.45f, 0.45f) * r->size.x, -draw_in(g, 0.7f, 1.8f),
                      draw_in(g, -0.45f, 0.45f) * r->size.z};
        const body *aim = &r->bodies[1 + draw_index(g, r->body_count - 1)];
        vec target = add(aim->centre, (vec){0.3f * draw_normal(g), 0.2f * draw_normal(g), 0.3f * draw_normal(g)});
        viewpoint v = {.at = middle};
        look_at(&v, target, 0.0f);
        float far = distance_seen(r, middle, v.z), walk = far * draw_in(g, 0.06f, 0.25f);
        vec step = unit(add(v.x, add(times(v.y, 0.4f * draw_normal(g)), times(v.z, 0.5f * draw_normal(g)))));
        if (fabsf(v.z.y) > 0.75f) {
            continue;
        }
        bool good = far > 0.7f && far < 4.5f;
        vec focus = add(middle, times(v.z, minf(far, 20.0f)));
        for (int i = 0; i < views; i++) {
            float along = views > 1 ? (float)i / (float)(views - 1) - 0.5f : 0.0f;
            vec shake = {draw_normal(g), draw_normal(g), draw_normal(g)};
            made[i].at = add(middle, add(times(step, along * walk), times(shake, 0.04f * walk)));
            vec eyes = {draw_normal(g), draw_normal(g), draw_normal(g)};
            look_at(&made[i], add(focus, times(eyes, 0.04f * minf(far, 20.0f))), 0.03f * draw_normal(g));
            made[i].fx = made[i].fy = focal;
            made[i].cx = 0.5f * (float)(width - 1);
            made[i].cy = 0.5f * (float)(height - 1);
            good = good && free_place(r, made[i].at, 0.15f);
        }
        if (good) {
            return;
        }
    }
    /* every place above was taken: the room's middle under the ceiling, where little stands */
    for (int i = 0; i < views; i++) {
        made[i].at = (vec){0.05f * (float)i, 0.35f - r->size.y, 0.0f};
        look_at(&made[i], (vec){0.3f * r->size.x, -1.0f, 0.5f * r->size.z}, 0.0f);
        made[i].fx = made[i].fy = focal;
        made[i].cx = 0.5f * (float)(width - 1);
        made[i].cy = 0.5f * (float)(height - 1);
    }
}

int procedural_room(const atlas *shared, uint64_t seed, int width, int height, int views, uint8_t *images,
                    float *depths, float *intrinsics, float *poses)
{
    if (width < 16 || width > 2048 || height < 16 || height > 2048 || views < 1 || views > MAX_VIEWS) {
        return -1;
    }
    size_t pixels = (size_t)width * height, rays = pixels * SUBSAMPLES * SUBSAMPLES;
    room *r = calloc(1, sizeof *r);
    float *near = malloc(rays * sizeof *near), *linear = malloc(pixels * 3 * sizeof *linear);
    float *scratch = malloc(pixels * 3 * sizeof *scratch);
    uint16_t *owner = malloc(rays * sizeof *owner);
    bool good = r && near && linear && scratch && owner;
    generator g = {seed};
    if (good) {
        r->shared = shared;
        r->luxels = malloc((MAX_LUXELS + 4 * 6 * MAX_BODIES) * sizeof *r->luxels);
        good = r->luxels != NULL;
    }
    for (int i = 0; good && i < POSTERS; i++) {
        good = poster_draw(&r->posters[i], shared, draw_bits(&g));
    }
    if (good) {
        viewpoint path[MAX_VIEWS];
        camera_look look;
        look_draw(&look, &g);
        look.vignette *= 0.5f;
        furnish(r, &g);
        path_draw(r, &g, width, height, views, path);
        store_light(r);
        for (int i = 0; i < views; i++) {
            const viewpoint *v = &path[i];
            see_room(r, v, width, height, near, owner, linear, depths + i * pixels);
            if (i == 0) {
                look.exposure = look_exposure(linear, width, height, draw_in(&g, 0.1f, 0.22f));
            }
            develop(&look, &g, width, height, linear, scratch, images + i * pixels * 3);
            const float k[4] = {v->fx, v->fy, v->cx, v->cy};
            const float pose[16] = {v->x.x, v->y.x, v->z.x, v->at.x, v->x.y, v->y.y, v->z.y, v->at.y,
                                    v->x.z, v->y.z, v->z.z, v->at.z, 0.0f,   0.0f,   0.0f,   1.0f};
            memcpy(intrinsics + 4 * i, k, sizeof k);
            memcpy(poses + 16 * i, pose, sizeof pose);
        }
    }
    for (int i = 0; r && i < POSTERS; i++) {
        free(r->posters[i].rgb);
    }
    if (r) {
        free(r->luxels);
    }
    free(r);
    free(near);
    free(linear);
    free(scratch);
    free(owner);
    return good ? 0 : -1;
}
