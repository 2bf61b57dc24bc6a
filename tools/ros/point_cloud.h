/* Converts Gaussians to the points of a sensor_msgs/PointCloud2: little-endian floats, in the world's frame. */
#ifndef TRIM3R_TOOLS_POINT_CLOUD_H
#define TRIM3R_TOOLS_POINT_CLOUD_H

#include <stdint.h>

#include "trim3r.h"

#ifdef __cplusplus
extern "C" {
#endif

/* X(NAME), 4 bytes each: the position in world units; the colour as viewers read it, 0x00RRGGBB in a float's bits; the
 * opacity, 0..1; the standard deviations along the three axes in world units; the rotation of the axes as a unit
 * quaternion w x y z. */
#define POINT_CLOUD_FIELDS(X)                                                                                          \
    X(x) X(y) X(z) X(rgb) X(opacity) X(scale_0) X(scale_1) X(scale_2) X(rot_0) X(rot_1) X(rot_2) X(rot_3)

enum {
    POINT_CLOUD_FIELD_COUNT = 12,
    POINT_CLOUD_FLOAT32 = 7, /* the type's number in PointField */
    POINT_CLOUD_STEP = POINT_CLOUD_FIELD_COUNT * 4
};

extern const char *const point_cloud_fields[POINT_CLOUD_FIELD_COUNT];

/* Writes scene->count x POINT_CLOUD_STEP bytes. */
void point_cloud_write(const t3r_scene *scene, uint8_t *data);

#ifdef __cplusplus
}
#endif
#endif
