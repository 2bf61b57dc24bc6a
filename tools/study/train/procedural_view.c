/* SPDX-License-Identifier: Apache-2.0 */
#include "procedural_scene.h"

#include <stdlib.h>
#include <string.h>

static vec ray_of(const viewpoint *v, float x, float y)
{
    return add(v->z, add(times(v->x, (x - v->cx) / v->fx), times(v->y, (y - v->cy) / v->fy)));
}

/* Computes the rows and columns of subsamples that may see the body; all of them if it reaches behind the camera */
static void screen_box(const body *b, const viewpoint *v, int columns, int rows, int box[4])
{
    float low_x = 1e9f, low_y = 1e9f, high_x = -1e9f, high_y = -1e9f;
    box[0] = box[1] = 0;
    box[2] = columns;
    box[3] = rows;
    /* is the whole sphere outside one of the picture's four sides? */
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

/* Runs hit_box() along a row of rays, without branches, so that it vectorises; faces: 0..5 */
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
        if (!(z < 1e6f)) { /* at the limb, the mean of the rays that hit the body may miss it */
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

void see_room(const room *r, const viewpoint *v, int width, int height, float *near, uint16_t *owner, float *linear,
              float *depth)
{
    int columns = width * SUBSAMPLES, rows = height * SUBSAMPLES;
    const float step = 1.0f / SUBSAMPLES;
    for (size_t i = 0; i < (size_t)columns * rows; i++) {
        near[i] = INFINITY;
    }
    for (int i = 0; i < r->body_count; i++) {
        see_body(&r->bodies[i], i, v, columns, rows, near, owner);
    }
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            seen found[SUBSAMPLES * SUBSAMPLES];
            float sum[3] = {0.0f, 0.0f, 0.0f}, rgb[3];
            for (int k = pixel_owners(owner, width, x, y, found), i = 0; i < k; i++) {
                const seen *f = &found[i];
                shade_hit(r, v, f->owner, (float)x + f->x / f->count, (float)y + f->y / f->count, rgb);
                for (int c = 0; c < 3; c++) {
                    sum[c] += rgb[c] * f->count * step * step;
                }
            }
            memcpy(linear + 3 * (y * width + x), sum, sizeof sum);
            depth[y * width + x] =
                near[(size_t)(y * SUBSAMPLES + SUBSAMPLES / 2) * columns + x * SUBSAMPLES + SUBSAMPLES / 2];
        }
    }
}
