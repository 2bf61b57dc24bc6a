/* SPDX-License-Identifier: Apache-2.0 */
/* A text with a matrix: an error, or numbers whose pose, if it is one, is within the limits. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/pose_matrix.h"
#include "import/poses/matrix_text.h"
#include "mcap/reader_limits.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    double matrix[MATRIX_NUMBERS_MOST];
    rigid pose;
    uint32_t count;
    char *text = malloc(size + 1);
    if (text == NULL) {
        return 0;
    }
    if (size > 0) {
        memcpy(text, data, size);
    }
    text[size] = '\0';
    const char *wrong = matrix_text_parse(text, matrix, &count);
    free(text);
    if (count > MATRIX_NUMBERS_MOST || (wrong != NULL && wrong[0] == '\0')) {
        abort();
    }
    for (int axes = T3R_AXES_OPENCV; wrong == NULL && count == 16 && axes <= T3R_AXES_OPENGL; axes++) {
        if (pose_of_matrix(matrix, (t3r_axes)axes, &pose) == NULL &&
            !(fabs(pose.position[0]) < 1 << T3R_LIMIT_POSITION_LOG2 && fabs(pose.rotation[0]) <= 1)) {
            abort();
        }
    }
    return 0;
}
