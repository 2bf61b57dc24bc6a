/* SPDX-License-Identifier: Apache-2.0 */
#include "oracle_analysis.h"

void oracle_unproject(const oracle_camera *camera, double x, double y, double z, double point[3])
{
    const double local[3] = {(x - camera->cx) / camera->fx * z, (y - camera->cy) / camera->fy * z, z};
    for (int i = 0; i < 3; i++) {
        point[i] = camera->position[i];
        for (int j = 0; j < 3; j++) {
            point[i] += camera->rotation[i * 3 + j] * local[j];
        }
    }
}
