/* Rigid transforms in doubles, from a child's frame to its parent's: poses of cameras, and where one sensor sits on
 * another. */
#ifndef TRIM3R_TOOLS_RIGID_H
#define TRIM3R_TOOLS_RIGID_H

typedef struct rigid {
    double position[3];
    double rotation[4]; /* unit quaternion, as geometry/quaternion.h has it */
} rigid;

extern const rigid rigid_identity;

/* Returns outer after inner: from inner's child to outer's parent. */
rigid rigid_compose(const rigid *outer, const rigid *inner);
rigid rigid_inverse(const rigid *transform);
/* Interpolates at t, 0..1, from a to b: linearly between the positions, along the arc between the rotations (slerp),
 * the shorter way. */
rigid rigid_between(const rigid *a, const rigid *b, double t);
void rigid_apply(const rigid *transform, const double point[3], double out[3]);

#endif
