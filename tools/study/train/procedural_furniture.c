/* SPDX-License-Identifier: Apache-2.0 */
#include "procedural_scene.h"

#include <stdlib.h>
#include <string.h>

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

/* Places small objects on a level rectangle at height y, turned by yaw about `middle` */
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

/* Builds boards between two sides, with rows of books and objects; the back is at the wall */
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

/* Returns a place at one of the walls: yaw turns -z, the front of the furniture, into the room */
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

void furnish(room *r, generator *g)
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
