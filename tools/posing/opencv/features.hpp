/* SPDX-License-Identifier: Apache-2.0 */
// SIFT features of a picture, and those of two pictures that look alike.
#ifndef TRIM3R_TOOLS_POSING_OPENCV_FEATURES_HPP
#define TRIM3R_TOOLS_POSING_OPENCV_FEATURES_HPP

#include "posing/opencv_module.h"

void find_features(const uint8_t *grey, uint32_t width, uint32_t height, pose_features *out);
// Returns the number of matches.
uint32_t match_features(const pose_features *a, const pose_features *b, pose_match *matches);

#endif
