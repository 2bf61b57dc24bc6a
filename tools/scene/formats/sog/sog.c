/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/sog/sog.h"

#include "scene/scene_format.h"

const scene_format scene_format_sog = {.suffix = ".sog",
                                       .magic = "PK\x03\x04",
                                       .degree = 3,
                                       .holds_mip = true,
                                       .shares_bits = true,
                                       .parse = sog_parse,
                                       .write = sog_write};
