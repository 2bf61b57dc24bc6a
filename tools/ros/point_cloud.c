#include "ros/point_cloud.h"

#include <math.h>
#include <string.h>

#include "host/little_floats.h"
#include "scene/gaussian_shape.h"

#define NAME(name) #name,
const char *const point_cloud_fields[POINT_CLOUD_FIELD_COUNT] = {POINT_CLOUD_FIELDS(NAME)};
#undef NAME

static uint8_t *put_float(uint8_t *at, double value)
{
    t3r_store_float(at, value);
    return at + sizeof(float);
}

/* Returns 0..32640 in 1/128 of a level, rounded as in a picture of the Gaussian alone. */
static uint32_t level(uint16_t colour_q7)
{
    return (colour_q7 + 64u) >> 7;
}

static void put_point(const t3r_scene *scene, uint32_t index, uint8_t *at)
{
    const t3r_gaussian *g = &scene->gaussians[index];
    const gaussian_shape shape = gaussian_shape_of(g);
    for (int i = 0; i < 3; i++) {
        at = put_float(at, ldexp((double)scene->frame.origin_q32[i], -32) +
                               ldexp(g->position_q20[i], scene->frame.exponent - 20));
    }
    t3r_store_le32(at, level(g->colour_q7[0]) << 16 | level(g->colour_q7[1]) << 8 | level(g->colour_q7[2]));
    at = put_float(at + 4, g->opacity_q15 / 32768.0);
    for (int i = 0; i < 3; i++) {
        at = put_float(at, ldexp(shape.scale[i], scene->frame.exponent));
    }
    for (int i = 0; i < 4; i++) {
        at = put_float(at, shape.rotation[i]);
    }
}

void point_cloud_write(const t3r_scene *scene, uint8_t *data)
{
    for (uint32_t i = 0; i < scene->count; i++) {
        put_point(scene, i, data + (size_t)i * POINT_CLOUD_STEP);
    }
}
