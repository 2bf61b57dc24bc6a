/* A pose between two others. */
#ifndef TRIM3R_TOOLS_POSE_BETWEEN_H
#define TRIM3R_TOOLS_POSE_BETWEEN_H

#define POSE_NUMBERS 7 /* tx ty tz qx qy qz qw, as TUM trajectories have them */

/* At t of the way from a to b, 0..1: the straight line between the positions and the normalised line between the
 * quaternions, on the shorter way. Neighbours of a trajectory are a few degrees apart, where that differs from the arc
 * by less than a thousandth of their angle. */
void pose_between(const double a[POSE_NUMBERS], const double b[POSE_NUMBERS], double t, double out[POSE_NUMBERS]);

/* The position, and the quaternion w x y z of norm 1. */
void pose_split(const double pose[POSE_NUMBERS], double position[3], double rotation[4]);

#endif
