/* Poses as matrices, as other programs' files hold them. */
#ifndef TRIM3R_TOOLS_POSE_MATRIX_H
#define TRIM3R_TOOLS_POSE_MATRIX_H

typedef enum camera_axes {
    AXES_OPENCV, /* x right, y down, z forward, as in posed_frame */
    AXES_OPENGL  /* x right, y up, z backward */
} camera_axes;

/* Converts a camera-to-world matrix, row-major, whose last row is 0 0 0 1, to the pose of posed_frame. Returns NULL, or
 * what is wrong: an entry that is not finite, a matrix that is no rotation, a position of 2^T3R_LIMIT_POSITION_LOG2 or
 * more. */
const char *pose_of_matrix(const double matrix[16], camera_axes axes, double position[3], double rotation[4]);

#endif
