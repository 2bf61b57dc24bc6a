#include "room/scene.h"

#include <string.h>

#include "core/fixed.h"

#define FAR ((int64_t)1 << 40)

/* ---- the furniture, in millimetres ------------------------------------------------------------------------------ */

typedef struct solid_mm {
    room_material material;
    int16_t low[3], high[3]; /* for a sphere: centre, and radius in high[0] */
    bool sphere;
} solid_mm;

typedef struct group_mm {
    int16_t pivot[3];
    int16_t cosine, sine, hypotenuse; /* a Pythagorean triple, so that the rotation is exact */
    const solid_mm *solids;
    uint32_t count;
} group_mm;

static const int16_t shell_low[3] = {-2000, -1600, -850};
static const int16_t shell_high[3] = {2000, 1400, 4150};

static const solid_mm table[] = {
    {ROOM_WOOD, {-620, -760, -360}, {620, -722, 360}, false},
    {ROOM_METAL, {-590, -722, -330}, {-562, 0, -302}, false},
    {ROOM_METAL, {562, -722, -330}, {590, 0, -302}, false},
    {ROOM_METAL, {-590, -722, 302}, {-562, 0, 330}, false},
    {ROOM_METAL, {562, -722, 302}, {590, 0, 330}, false},
    {ROOM_MARBLE, {250, -930, -40}, {170, 0, 0}, true},
    {ROOM_CARDBOARD, {-480, -1010, -120}, {-130, -760, 170}, false},
    {ROOM_PAINTED, {-60, -800, -280}, {150, -760, -120}, false},
    {ROOM_CLOTH, {-40, -832, -270}, {130, -800, -130}, false},
};

static const solid_mm crates[] = {
    {ROOM_CRATE, {-260, -520, -260}, {260, 0, 260}, false},
    {ROOM_GRANITE, {-160, -790, -120}, {110, -520, 150}, false},
};

static const solid_mm shelf[] = {
    {ROOM_SHELF, {-600, -1900, -140}, {600, 0, 150}, false},
};

static const solid_mm painting[] = {
    {ROOM_PAINTING, {-420, -330, -30}, {420, 330, 0}, false},
    {ROOM_FRAME_GOLD, {-460, -370, -42}, {460, -330, 0}, false},
    {ROOM_FRAME_GOLD, {-460, 330, -42}, {460, 370, 0}, false},
    {ROOM_FRAME_GOLD, {-460, -330, -42}, {-420, 330, 0}, false},
    {ROOM_FRAME_GOLD, {420, -330, -42}, {460, 330, 0}, false},
};

static const solid_mm rack[] = {
    {ROOM_METAL, {-360, -1300, -12}, {360, -1276, 12}, false}, {ROOM_METAL, {-360, -130, -12}, {360, -106, 12}, false},
    {ROOM_METAL, {-360, -1300, -9}, {-342, 0, 9}, false},      {ROOM_METAL, {-222, -1280, -8}, {-206, -110, 8}, false},
    {ROOM_METAL, {-82, -1280, -8}, {-66, -110, 8}, false},     {ROOM_METAL, {58, -1280, -8}, {74, -110, 8}, false},
    {ROOM_METAL, {198, -1280, -8}, {214, -110, 8}, false},     {ROOM_METAL, {342, -1300, -9}, {360, 0, 9}, false},
};

static const solid_mm lamp[] = {
    {ROOM_PAINTED, {-11, -1650, -11}, {11, 0, 11}, false},
    {ROOM_PAINTED, {-150, -24, -150}, {150, 0, 150}, false},
    {ROOM_LAMP, {0, -1780, 0}, {165, 0, 0}, true},
};

static const solid_mm stool[] = {
    {ROOM_CLOTH, {-190, -460, -190}, {190, -400, 190}, false}, {ROOM_WOOD, {-180, -400, -180}, {-150, 0, -150}, false},
    {ROOM_WOOD, {150, -400, -180}, {180, 0, -150}, false},     {ROOM_WOOD, {-180, -400, 150}, {-150, 0, 180}, false},
    {ROOM_WOOD, {150, -400, 150}, {180, 0, 180}, false},
};

#define GROUP(list) list, sizeof(list) / sizeof *(list)
static const group_mm furniture[] = {
    {{-130, 1400, 2500}, 24, 7, 25, GROUP(table)},   {{1010, 1400, 2050}, 4, -3, 5, GROUP(crates)},
    {{-1150, 1400, 4000}, 1, 0, 1, GROUP(shelf)},    {{480, -420, 4150}, 1, 0, 1, GROUP(painting)},
    {{1180, 1400, 3350}, 35, 12, 37, GROUP(rack)},   {{-330, 1400, 3800}, 1, 0, 1, GROUP(lamp)},
    {{-1000, 1400, 1750}, 12, -5, 13, GROUP(stool)},
};

/* ---- building --------------------------------------------------------------------------------------------------- */

static room_vector from_mm(const int16_t mm[3])
{
    return (room_vector){{ROOM_MM(mm[0]), ROOM_MM(mm[1]), ROOM_MM(mm[2])}};
}

static room_vector difference(const room_vector *a, const room_vector *b)
{
    return (room_vector){{a->v[0] - b->v[0], a->v[1] - b->v[1], a->v[2] - b->v[2]}};
}

static int64_t dot(const room_vector *a, const room_vector *b)
{
    return a->v[0] * b->v[0] + a->v[1] * b->v[1] + a->v[2] * b->v[2];
}

static void build_solid(const solid_mm *mm, room_solid *solid)
{
    solid->material = mm->material;
    solid->low = from_mm(mm->low);
    solid->high = from_mm(mm->high);
    if (mm->sphere) {
        solid->radius = ROOM_MM(mm->high[0]);
        solid->middle = solid->low;
        solid->reach_squared = solid->radius * solid->radius;
        return;
    }
    solid->radius = 0;
    for (int i = 0; i < 3; i++) {
        solid->middle.v[i] = (solid->low.v[i] + solid->high.v[i]) / 2;
    }
    room_vector half = difference(&solid->high, &solid->middle);
    solid->reach_squared = dot(&half, &half);
}

/* Computes the sphere around all of a group's solids: centre of their extent, radius to its farthest corner. */
static void enclose(const room_scene *scene, room_group *group)
{
    room_vector low = {{FAR, FAR, FAR}}, high = {{-FAR, -FAR, -FAR}};
    for (uint32_t s = group->first; s < group->first + group->count; s++) {
        const room_solid *solid = &scene->solids[s];
        for (int i = 0; i < 3; i++) {
            int64_t from = solid->low.v[i] - solid->radius;
            int64_t to = solid->radius != 0 ? solid->low.v[i] + solid->radius : solid->high.v[i];
            low.v[i] = T3R_MIN(low.v[i], from);
            high.v[i] = T3R_MAX(high.v[i], to);
        }
    }
    for (int i = 0; i < 3; i++) {
        group->middle.v[i] = (low.v[i] + high.v[i]) / 2;
    }
    room_vector half = difference(&high, &group->middle);
    group->reach_squared = dot(&half, &half);
}

_Static_assert(sizeof furniture / sizeof *furniture <= ROOM_GROUPS, "room for every group");
_Static_assert((sizeof table + sizeof crates + sizeof shelf + sizeof painting + sizeof rack + sizeof lamp +
                sizeof stool) /
                       sizeof(solid_mm) <=
                   ROOM_SOLIDS,
               "room for every solid");

void room_scene_build(room_scene *scene)
{
    memset(scene, 0, sizeof *scene);
    for (uint32_t g = 0; g < sizeof furniture / sizeof *furniture; g++) {
        const group_mm *mm = &furniture[g];
        room_group *group = &scene->groups[scene->group_count++];
        group->pivot = from_mm(mm->pivot);
        group->cosine_q30 = ((int64_t)mm->cosine * (1 << 30)) / mm->hypotenuse;
        group->sine_q30 = ((int64_t)mm->sine * (1 << 30)) / mm->hypotenuse;
        group->first = scene->solid_count;
        group->count = mm->count;
        for (uint32_t s = 0; s < mm->count; s++) {
            build_solid(&mm->solids[s], &scene->solids[scene->solid_count++]);
        }
        enclose(scene, group);
    }
}

/* ---- rays ------------------------------------------------------------------------------------------------------- */

/* Rotates into a group. Components are below 2^24, so each product is below 2^55. */
static room_vector into_group(const room_group *group, const room_vector *a)
{
    int64_t c = group->cosine_q30, s = group->sine_q30;
    return (room_vector){
        {t3r_round_shift64(c * a->v[0] - s * a->v[2], 30), a->v[1], t3r_round_shift64(s * a->v[0] + c * a->v[2], 30)}};
}

/* Returns a Q16 length, below 2^20, as a Q20 multiple of the ray. */
static int64_t multiple(int64_t length, int64_t component)
{
    return length * (1 << 24) / component;
}

/* Whether the line meets the sphere around `middle`: |c x d|^2 <= reach^2 |d|^2, without a division. Components of c
 * are below 2^19 (8 m), of d below 2^23: the products are below 2^43, their squares after the shift below 2^55. */
static bool near_sphere(const room_vector *middle, int64_t reach_squared, const room_vector *origin,
                        const room_vector *direction, int64_t length_squared_q20)
{
    room_vector c = difference(middle, origin);
    int64_t x = (c.v[1] * direction->v[2] - c.v[2] * direction->v[1]) >> 16;
    int64_t y = (c.v[2] * direction->v[0] - c.v[0] * direction->v[2]) >> 16;
    int64_t z = (c.v[0] * direction->v[1] - c.v[1] * direction->v[0]) >> 16;
    /* a Q20 slack covers what the shifts drop */
    return x * x + y * y + z * z <= ((reach_squared >> 12) + 64) * length_squared_q20;
}

static bool meet_box(const room_solid *box, const room_vector *origin, const room_vector *direction, int64_t *distance,
                     uint32_t *axis)
{
    int64_t enter = -FAR, leave = FAR;
    for (uint32_t i = 0; i < 3; i++) {
        int64_t d = direction->v[i];
        int64_t to_low = box->low.v[i] - origin->v[i], to_high = box->high.v[i] - origin->v[i];
        if (d == 0) {
            if (to_low > 0 || to_high < 0) {
                return false;
            }
            continue;
        }
        int64_t first = multiple(d > 0 ? to_low : to_high, d);
        int64_t second = multiple(d > 0 ? to_high : to_low, d);
        if (first > enter) {
            enter = first;
            *axis = i;
        }
        leave = T3R_MIN(leave, second);
    }
    *distance = enter;
    return enter > 0 && enter < leave;
}

static bool meet_sphere(const room_solid *ball, const room_vector *origin, const room_vector *direction,
                        int64_t length_squared_q20, int64_t *distance)
{
    room_vector c = difference(&ball->low, origin);
    int64_t nearest = dot(&c, direction) * 16 / length_squared_q20; /* Q36 x 2^4 / Q20 = Q20 */
    if (nearest <= 0) {
        return false;
    }
    room_vector miss;
    for (int i = 0; i < 3; i++) {
        miss.v[i] = c.v[i] - t3r_round_shift64(direction->v[i] * nearest, 24);
    }
    int64_t inside = ball->reach_squared - dot(&miss, &miss); /* Q32, at most 2^30: radii are below half a metre */
    if (inside <= 0) {
        return false;
    }
    *distance = nearest - (int64_t)t3r_isqrt64((uint64_t)(inside * (1 << 28) / length_squared_q20));
    return *distance > 0;
}

static bool meet_solid(const room_solid *solid, const room_vector *origin, const room_vector *direction,
                       int64_t length_squared_q20, int64_t *distance, uint32_t *axis)
{
    if (!near_sphere(&solid->middle, solid->reach_squared, origin, direction, length_squared_q20)) {
        return false;
    }
    if (solid->radius != 0) {
        *axis = 3;
        return meet_sphere(solid, origin, direction, length_squared_q20, distance);
    }
    return meet_box(solid, origin, direction, distance, axis);
}

static room_vector along(const room_vector *origin, const room_vector *direction, int64_t distance)
{
    room_vector point;
    for (int i = 0; i < 3; i++) {
        point.v[i] = origin->v[i] + t3r_round_shift64(direction->v[i] * distance, 24);
    }
    return point;
}

/* Finds the face through which a ray leaves the shell. */
static void meet_shell(const room_vector *origin, const room_vector *direction, room_hit *hit)
{
    static const room_material materials[3][2] = {
        {ROOM_BRICK, ROOM_BLANK}, {ROOM_CEILING, ROOM_FLOOR}, {ROOM_PLASTER, ROOM_PLASTER}};
    hit->distance = FAR;
    hit->solid = ROOM_SOLIDS;
    for (uint32_t i = 0; i < 3; i++) {
        int64_t d = direction->v[i];
        if (d == 0) {
            continue;
        }
        int64_t face = ROOM_MM(d > 0 ? shell_high[i] : shell_low[i]);
        int64_t distance = multiple(face - origin->v[i], d);
        if (distance < hit->distance) {
            hit->distance = distance;
            hit->axis = i;
            hit->material = materials[i][d > 0];
        }
    }
}

/* Computes point, surface coordinates and normal of the nearest hit. */
static void describe(const room_scene *scene, const room_vector *origin, const room_vector *direction,
                     const room_group *group, room_hit *hit)
{
    hit->point = along(origin, direction, hit->distance);
    hit->normal_q14[0] = hit->normal_q14[1] = hit->normal_q14[2] = 0;
    if (group == NULL) {
        room_vector low = from_mm(shell_low);
        hit->local = difference(&hit->point, &low);
        hit->normal_q14[hit->axis] = direction->v[hit->axis] > 0 ? -(1 << 14) : 1 << 14;
        return;
    }
    const room_solid *solid = &scene->solids[hit->solid];
    room_vector from_pivot = difference(&hit->point, &group->pivot);
    room_vector place = into_group(group, &from_pivot);
    hit->local = difference(&place, &solid->low);
    int64_t n[3] = {0, 0, 0};
    if (solid->radius != 0) {
        for (int i = 0; i < 3; i++) {
            n[i] = hit->local.v[i] * (1 << 14) / solid->radius;
        }
    } else {
        room_vector d = into_group(group, direction);
        n[hit->axis] = d.v[hit->axis] > 0 ? -(1 << 14) : 1 << 14;
    }
    hit->normal_q14[0] = (int32_t)t3r_round_shift64(group->cosine_q30 * n[0] + group->sine_q30 * n[2], 30);
    hit->normal_q14[1] = (int32_t)n[1];
    hit->normal_q14[2] = (int32_t)t3r_round_shift64(group->cosine_q30 * n[2] - group->sine_q30 * n[0], 30);
}

void room_scene_trace(const room_scene *scene, const room_vector *origin, const room_vector *direction, room_hit *hit)
{
    const room_group *of_hit = NULL;
    int64_t length_squared_q20 = dot(direction, direction) >> 20;
    meet_shell(origin, direction, hit);
    for (uint32_t g = 0; g < scene->group_count; g++) {
        const room_group *group = &scene->groups[g];
        room_vector from_pivot = difference(origin, &group->pivot);
        room_vector o = into_group(group, &from_pivot), d = into_group(group, direction);
        if (!near_sphere(&group->middle, group->reach_squared, &o, &d, length_squared_q20)) {
            continue;
        }
        for (uint32_t s = group->first; s < group->first + group->count; s++) {
            int64_t distance;
            uint32_t axis = 0;
            if (meet_solid(&scene->solids[s], &o, &d, length_squared_q20, &distance, &axis) &&
                distance < hit->distance) {
                hit->distance = distance;
                hit->axis = axis;
                hit->solid = s;
                hit->material = scene->solids[s].material;
                of_hit = group;
            }
        }
    }
    describe(scene, origin, direction, of_hit, hit);
}

bool room_scene_blocked(const room_scene *scene, const room_vector *origin, const room_vector *direction)
{
    int64_t length_squared_q20 = dot(direction, direction) >> 20;
    for (uint32_t g = 0; g < scene->group_count; g++) {
        const room_group *group = &scene->groups[g];
        room_vector from_pivot = difference(origin, &group->pivot);
        room_vector o = into_group(group, &from_pivot), d = into_group(group, direction);
        if (!near_sphere(&group->middle, group->reach_squared, &o, &d, length_squared_q20)) {
            continue;
        }
        for (uint32_t s = group->first; s < group->first + group->count; s++) {
            int64_t distance;
            uint32_t axis;
            if (scene->solids[s].material != ROOM_LAMP &&
                meet_solid(&scene->solids[s], &o, &d, length_squared_q20, &distance, &axis) && distance < (1 << 20)) {
                return true;
            }
        }
    }
    return false;
}

int64_t room_scene_corner(const room_vector *point, uint32_t axis)
{
    int64_t nearest = FAR;
    for (uint32_t i = 0; i < 3; i++) {
        if (i != axis) {
            int64_t to_low = point->v[i] - ROOM_MM(shell_low[i]), to_high = ROOM_MM(shell_high[i]) - point->v[i];
            nearest = T3R_MIN(nearest, T3R_MIN(to_low, to_high));
        }
    }
    return nearest * 1000 / 65536;
}
