/* SPDX-License-Identifier: Apache-2.0 */
/* The devices that the firmware needs. board_mps.c has those of an emulated board: replace it by your drivers. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

enum { CAMERA_SIDE = 64, CAMERA_LINES = 4 };

/* A line of the camera: RGB565 with the high byte first, and millimetres of 16 bits, 0 = not measured. */
typedef struct camera_line {
    uint8_t rgb565[2 * CAMERA_SIDE];
    uint8_t depth[2 * CAMERA_SIDE];
} camera_line;

/* The memory that the DMA fills: line y of a frame is in camera_lines[y % CAMERA_LINES]. */
extern camera_line camera_lines[CAMERA_LINES];

/* Starts a frame, which the camera takes `right_mm` to the right of the world's origin. The interrupt after each line
 * calls arrived(y). The camera waits for no one: after CAMERA_LINES more lines a line is overwritten. */
void camera_start(int32_t right_mm, void (*arrived)(uint32_t y));
/* Sleeps until the next interrupt. */
void camera_wait(void);

/* Starts the watchdog: it ends the firmware unless it is fed each `milliseconds`. */
void watchdog_start(uint32_t milliseconds);
void watchdog_feed(void);

/* Returns the partition of the flash that has the weights, and its bytes. */
const uint8_t *weights_partition(uint32_t *bytes);

#endif
