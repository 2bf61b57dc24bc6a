/* SPDX-License-Identifier: Apache-2.0 */
/* The devices of the boards that QEMU emulates. The camera is a program: the processor's timer stands for its DMA, and
 * each tick "sends" a line of a wall two metres away with a box half a metre before it. Symbols that end in _at are
 * addresses and numbers of the board's linker script. */
#include "board.h"

#include "report.h"
#include "semihost.h"

#ifndef TICKS_PER_LINE
#define TICKS_PER_LINE 50000 /* of the processor's clock: 2 ms */
#endif
enum { WALL_MM = 2000, BOX_MM = 1500, BOX_HALF_MM = 300, SQUARE_MM = 128 };
enum { MILLISECONDS = 1000, UNLOCK = 0x1acce551, COUNTS_AND_RESETS = 3 };

extern uint8_t weights_begin_at[], weights_bytes_at[], watchdog_begin_at[], watchdog_hertz_at[];

camera_line camera_lines[CAMERA_LINES];

static volatile uint32_t *word_at(uintptr_t address)
{
    return (volatile uint32_t *)address;
}

/* --- the camera ------------------------------------------------------------------------------------------------ */

static struct {
    void (*arrived)(uint32_t y);
    int32_t right_mm;
    uint32_t next; /* line */
} camera;

static void timer(uint32_t ticks)
{
    *word_at(0xe000e010) = 0; /* SysTick: control, reload, current */
    *word_at(0xe000e014) = ticks;
    *word_at(0xe000e018) = 0;
    *word_at(0xe000e010) = ticks == 0 ? 0 : 7;
}

/* Returns where the ray of a pixel is at a depth, from the middle of the picture, in millimetres. */
static int32_t place(uint32_t pixel, int32_t depth_mm)
{
    return (2 * (int32_t)pixel - CAMERA_SIDE + 1) * depth_mm / (2 * CAMERA_SIDE);
}

static int is_in_box(int32_t mm)
{
    return mm > -BOX_HALF_MM && mm < BOX_HALF_MM;
}

static void expose(uint32_t y, camera_line *line)
{
    for (uint32_t x = 0; x < CAMERA_SIDE; x++) {
        const int box = is_in_box(place(x, BOX_MM) + camera.right_mm) && is_in_box(place(y, BOX_MM));
        const int32_t depth = box ? BOX_MM : WALL_MM;
        const uint32_t across = (uint32_t)(place(x, depth) + camera.right_mm + 64 * SQUARE_MM) / SQUARE_MM;
        const uint32_t down = (uint32_t)(place(y, depth) + 64 * SQUARE_MM) / SQUARE_MM;
        const uint32_t pixel = ((across + down) % 2 != 0 ? 0xe71c : 0x18c3) ^ (box ? 0x7000 : 0) ^ across % 8;
        line->rgb565[2 * x] = (uint8_t)(pixel >> 8);
        line->rgb565[2 * x + 1] = (uint8_t)pixel;
        line->depth[2 * x] = (uint8_t)depth;
        line->depth[2 * x + 1] = (uint8_t)(depth >> 8);
    }
}

void SysTick_Handler(void);
void SysTick_Handler(void)
{
    const uint32_t y = camera.next++;
    expose(y, &camera_lines[y % CAMERA_LINES]);
    if (camera.next == CAMERA_SIDE) {
        timer(0);
    }
    camera.arrived(y);
}

void camera_start(int32_t right_mm, void (*arrived)(uint32_t y))
{
    timer(0);
    camera.arrived = arrived;
    camera.right_mm = right_mm;
    camera.next = 0;
    timer(TICKS_PER_LINE);
}

void camera_wait(void)
{
    __asm__ volatile("wfi" ::: "memory");
}

/* --- the watchdog: Arm's APB watchdog (CMSDK) ---------------------------------------------------------------- */

static volatile uint32_t *watchdog(uint32_t offset)
{
    return word_at((uintptr_t)watchdog_begin_at + offset);
}

void watchdog_start(uint32_t milliseconds)
{
    *watchdog(0xc00) = UNLOCK;
    *watchdog(0) = milliseconds * ((uint32_t)(uintptr_t)watchdog_hertz_at / MILLISECONDS);
    *watchdog(8) = COUNTS_AND_RESETS;
}

void watchdog_feed(void)
{
    *watchdog(0xc) = 1;
}

void NMI_Handler(void);
void NMI_Handler(void)
{
    report_text("error: ", "the watchdog was not fed", "", "");
    semihost_exit(3);
}

/* --- the flash ------------------------------------------------------------------------------------------------- */

const uint8_t *weights_partition(uint32_t *bytes)
{
    *bytes = (uint32_t)(uintptr_t)weights_bytes_at;
    return weights_begin_at;
}
