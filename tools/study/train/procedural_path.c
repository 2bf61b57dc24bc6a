/* SPDX-License-Identifier: Apache-2.0 */
#include "procedural_scene.h"

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

/* Draws a walk of at most a quarter of the viewing distance, looking at one place, with a hand's tremor. The last
 * try is always accepted, so that every room has a picture. */
void path_draw(const room *r, generator *g, int width, int height, int views, viewpoint *made)
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
    /* every other place was occupied: take the room's middle under the ceiling, where little stands */
    for (int i = 0; i < views; i++) {
        made[i].at = (vec){0.05f * (float)i, 0.35f - r->size.y, 0.0f};
        look_at(&made[i], (vec){0.3f * r->size.x, -1.0f, 0.5f * r->size.z}, 0.0f);
        made[i].fx = made[i].fy = focal;
        made[i].cx = 0.5f * (float)(width - 1);
        made[i].cy = 0.5f * (float)(height - 1);
    }
}
