/* Interpolates between two poses. */
#ifndef TRIM3R_TOOLS_POSE_BETWEEN_H
#define TRIM3R_TOOLS_POSE_BETWEEN_H

#define POSE_NUMBERS 7 /* tx ty tz qx qy qz qw, as in TUM trajectories */

/* Interpolates at t, 0..1, from a to b: linearly between the positions, by normalised linear interpolation between the
 * quaternions, the shorter way. Neighbours of a trajectory are a few degrees apart, where this differs from the arc by
 * less than a thousandth of their angle. */
void pose_between(const double a[POSE_NUMBERS], const double b[POSE_NUMBERS], double t, double out[POSE_NUMBERS]);

/* Splits a pose into the position and the quaternion w x y z of norm 1. */
void pose_split(const double pose[POSE_NUMBERS], double position[3], double rotation[4]);

#endif
