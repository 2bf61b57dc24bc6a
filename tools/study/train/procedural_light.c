/* SPDX-License-Identifier: Apache-2.0 */
#include "procedural_scene.h"

/* Whether another object than the room and `except` is between at and at + along */
static bool blocked(const room *r, vec at, vec along, int except)
{
    float scale = 1.0f / dot(along, along);
    bool near[MAX_BODIES];
    for (int i = 0; i < r->caster_count; i++) { /* a separate loop, which vectorises */
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

/* Computes a face's middle, its half edges, and its outward normal (for the room itself: inward), in the body's
 * frame */
void face_frame(const body *b, int face, vec *middle, vec *along, vec *across, vec *normal)
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

/* Stores light on a lattice over every box face, 13 to 18 cm apart unless that takes too many points */
void store_light(room *r)
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
                    /* slightly inside the edge: corner points are inside neighbours */
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

/* Computes light on round bodies: each lamp's share that reaches the body; of its own shadow only the side turned away
 */
void open_light(const room *r, const body *b, vec at, vec normal, float rgb[3])
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

/* Interpolates stored light at s and t in -1..1 over the face */
void stored_light(const room *r, const body *b, int face, float s, float t, float rgb[3])
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
