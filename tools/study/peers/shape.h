/* SPDX-License-Identifier: Apache-2.0 */
/* The network that the peers run: the head `small` with layers of the nearest usual shapes, on the pixels of two
 * 256x256 views. */
#ifndef TRIM3R_TOOLS_PEERS_SHAPE_H
#define TRIM3R_TOOLS_PEERS_SHAPE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { VIEWS = 2, SIDE = 256, CHANNELS_MOST = 32, LAYERS = 3, RUNS_MOST = 101 };

static const struct {
    size_t inputs, outputs, side; /* shape of the kernel */
} layers[LAYERS] = {{24, 32, 3}, {32, 32, 1}, {32, 16, 1}};

/* any bytes: the time does not depend on them */
static inline int8_t *filled(size_t count, int8_t most)
{
    int8_t *bytes = malloc(count);
    for (size_t i = 0; bytes != NULL && i < count; i++) {
        bytes[i] = (int8_t)((uint32_t)(i * 2654435761u >> 16) % (2u * (uint32_t)most + 1) - (uint32_t)most);
    }
    return bytes;
}

static inline double macs(void)
{
    double sum = 0;
    for (int l = 0; l < LAYERS; l++) {
        sum += (double)(layers[l].inputs * layers[l].outputs * layers[l].side * layers[l].side);
    }
    return sum * VIEWS * SIDE * SIDE;
}

static inline int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Prints the median of `runs` runs of all layers, after one that is not counted, as 10^9 multiply-accumulates a
 * second. */
static inline int print_rate(int runs, int (*run)(void))
{
    double seconds[RUNS_MOST];
    for (int i = -1; i < runs; i++) {
        struct timespec from, to;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
        if (run() != 0) {
            fprintf(stderr, "a layer failed\n");
            return 1;
        }
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
        if (i >= 0) {
            seconds[i] = (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
        }
    }
    qsort(seconds, (size_t)runs, sizeof seconds[0], by_value);
    printf("%.3f\n", macs() / seconds[runs / 2] * 1e-9);
    return 0;
}

static inline int runs_of(int argc, char **argv)
{
    const int runs = argc == 2 ? atoi(argv[1]) : 7;
    return runs < 1 ? 1 : runs > RUNS_MOST ? RUNS_MOST : runs;
}

#endif
