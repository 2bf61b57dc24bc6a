/* The furniture of the room, and ray casting. Lengths Q16 metres, directions and distances along a ray Q20. */
#ifndef TRIM3R_TOOLS_ROOM_SCENE_H
#define TRIM3R_TOOLS_ROOM_SCENE_H

#include <stdbool.h>
#include <stdint.h>

#define ROOM_MM(x) ((int64_t)(x)*65536 / 1000)

typedef struct room_vector {
    int64_t v[3];
} room_vector;

typedef enum room_material {
    ROOM_FLOOR,
    ROOM_CEILING,
    ROOM_BRICK,
    ROOM_BLANK,
    ROOM_PLASTER, /* the shell */
    ROOM_WOOD,
    ROOM_CARDBOARD,
    ROOM_CRATE,
    ROOM_SHELF,
    ROOM_PAINTING,
    ROOM_FRAME_GOLD,
    ROOM_METAL,
    ROOM_PAINTED,
    ROOM_GRANITE,
    ROOM_MARBLE,
    ROOM_LAMP,
    ROOM_CLOTH
} room_material;

#define ROOM_GROUPS 8
#define ROOM_SOLIDS 64

/* A box (low, high) or, if radius is not 0, a sphere around low; in the frame of its group. */
typedef struct room_solid {
    room_vector low, high, middle;
    int64_t radius;
    int64_t reach_squared; /* Q32, of the enclosing sphere around `middle` */
    room_material material;
} room_solid;

/* Solids that share a place on the floor and a rotation about the vertical. */
typedef struct room_group {
    room_vector pivot, middle;
    int64_t cosine_q30, sine_q30;
    int64_t reach_squared;
    uint32_t first, count;
} room_group;

typedef struct room_scene {
    room_group groups[ROOM_GROUPS];
    room_solid solids[ROOM_SOLIDS];
    uint32_t group_count, solid_count;
} room_scene;

typedef struct room_hit {
    int64_t distance; /* Q20, in multiples of the ray's direction */
    room_material material;
    uint32_t axis;         /* of the face; 3 = sphere */
    uint32_t solid;        /* index; ROOM_SOLIDS = the shell */
    room_vector point;     /* world */
    room_vector local;     /* in the group's frame, from the box's low corner or the sphere's centre */
    int32_t normal_q14[3]; /* world, towards the ray's origin */
} room_hit;

void room_scene_build(room_scene *scene);
/* Finds the nearest surface; the shell is closed, so there is one for every origin inside it. |direction| in [1/2,
 * 8). */
void room_scene_trace(const room_scene *scene, const room_vector *origin, const room_vector *direction, room_hit *hit);
/* Whether a solid lies between the origin and origin + direction. */
bool room_scene_blocked(const room_scene *scene, const room_vector *origin, const room_vector *direction);
/* Returns the millimetres from the point to the nearest wall, floor or ceiling, not counting those perpendicular to
 * `axis`. */
int64_t room_scene_corner(const room_vector *point, uint32_t axis);

#endif
