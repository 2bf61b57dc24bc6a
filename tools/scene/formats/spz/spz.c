/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/spz/spz.h"

#include "scene/scene_format.h"

#define COLOUR_REACH (0.5 * HARMONICS_ZERO / SPZ_COLOUR_SCALE) /* of a byte's ends from the middle */

const scene_format scene_format_spz = {.suffix = ".spz",
                                       .magic = SPZ_MAGIC,
                                       .axes = SCENE_AXES_RUB,
                                       .degree = 3,
                                       .harmonics = 1,
                                       .colour = {0.5 - COLOUR_REACH, 0.5 + COLOUR_REACH},
                                       .log_scale = {SPZ_SCALE_LEAST, SPZ_SCALE_LEAST + 255 / SPZ_SCALE_STEPS},
                                       .holds_mip = true,
                                       .shares_bits = true,
                                       .parse = spz_parse,
                                       .write = spz_write};
/* Most files of versions 1 to 3 are gzip streams. */
const scene_format scene_format_spz_gzip = {.suffix = ".spz", .magic = "\x1f\x8b", .parse = spz_parse_gzip};
