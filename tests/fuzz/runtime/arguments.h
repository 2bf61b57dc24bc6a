/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by fuzzers of the C interface: bytes to numbers, frames, cameras, Gaussians and pictures, including wild
 * ones. All memory read or written has exactly the bytes that the interface names. */
#ifndef T3R_FUZZ_ARGUMENTS_H
#define T3R_FUZZ_ARGUMENTS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "trim3r.h"

enum { MOST_SIDE = 40 };

#define REQUIRE(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "line %d: not true: %s\n", __LINE__, #condition);                                          \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)

typedef struct input {
    const uint8_t *bytes;
    size_t left;
} input;

uint8_t take8(input *in);
uint32_t take32(input *in);
/* Draws a number below the bound from one or two bytes of input; 0 = any number, from four. */
uint32_t below(input *in, uint32_t bound);
/* Draws a size near the smallest ones, or one that must be refused. */
uint32_t take_side(input *in);

/* Draws the settings from `first` on, each in its range and at most the one of `most`; a setting with no choice takes
 * no input. */
void take_settings(input *in, size_t first, const t3r_config *most, t3r_config *config);
#define SETTING_AT(name) (offsetof(t3r_config, name) / sizeof(uint32_t))
/* Returns the largest value of each setting. */
t3r_config most_settings(void);

/* Returns zeroed memory; ends the program without memory. */
void *allocate(size_t bytes);
uint8_t *allocate_arena(size_t bytes);

void require_status(t3r_status status);

t3r_camera take_camera(input *in);

/* Planes are allocated to the byte, so that a read beyond width, height and stride is caught. */
typedef struct held_frame {
    t3r_frame frame;
    uint8_t *planes[3];
} held_frame;

held_frame take_frame(input *in);
/* Returns the minimum bytes of a colour plane with the frame's stride, and of one row. */
uint64_t plane_bytes(const t3r_frame *frame, int plane, uint32_t *row);
void free_frame(held_frame *held);

t3r_gaussian take_gaussian(input *in);

/* A target with all its planes and `padding` elements between rows. */
typedef struct picture {
    t3r_target target;
    size_t bytes[3];
} picture;

picture picture_of(uint32_t width, uint32_t height, uint32_t padding);
void free_picture(picture *p);

#endif
