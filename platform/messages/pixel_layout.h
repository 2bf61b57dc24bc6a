/* SPDX-License-Identifier: Apache-2.0 */
/* The memory layout of the pixel formats and their names in ROS: one table for writer and reader of recordings. */
#ifndef T3R_PLATFORM_PIXEL_LAYOUT_H
#define T3R_PLATFORM_PIXEL_LAYOUT_H

#include <stdbool.h>
#include <stdint.h>

#include "host/text.h"
#include "trim3r.h"

/* Returns the name of the format in sensor_msgs, as trim3r writes it ("nv12" is our own: ROS has no name for it). */
const char *t3r_pixel_encoding(t3r_pixel_format format);
/* Finds the format of an encoding, also by V4L2's names. False if it is none of trim3r's colour formats. */
bool t3r_pixel_format_of(t3r_text encoding, t3r_pixel_format *format);

/* Whether an encoding of ROS is one of colour that only import converts: rgba8, bgra8, 8UC4, bayer in 8 bits. */
bool t3r_pixel_is_converted(t3r_text encoding);

/* Returns the bytes of a row of plane 0 without padding. */
uint32_t t3r_pixel_row_bytes(t3r_pixel_format format, uint32_t width);
/* Returns the rows of plane 0 or plane 1 (0 except for NV12). */
uint32_t t3r_pixel_rows(t3r_pixel_format format, uint32_t plane, uint32_t height);
/* Returns NULL, or why an image of this format cannot have this size. */
const char *t3r_pixel_size_error(t3r_pixel_format format, uint32_t width, uint32_t height);

#endif
