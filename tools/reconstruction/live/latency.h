/* SPDX-License-Identifier: Apache-2.0 */
/* The times that frames take: how they are spread, in a fixed number of bytes for any number of frames. */
#ifndef TRIM3R_TOOLS_LATENCY_H
#define TRIM3R_TOOLS_LATENCY_H

#include <stdint.h>

#define LATENCY_FINE 128   /* bins an octave: a bin's middle is at most 0.3 % off */
#define LATENCY_OCTAVES 27 /* from 1 us to 2 minutes; times beyond count in the outermost bins */
#define LATENCY_TEXT_BYTES 96

typedef struct latency {
    uint64_t count;
    double sum, worst; /* ms */
    uint32_t bins[LATENCY_OCTAVES * LATENCY_FINE];
} latency;

void latency_add(latency *times, double milliseconds);

/* Return ms; 0 without times. */
double latency_mean(const latency *times);
/* Returns the time that `percent` of the frames do not exceed, within 0.3 %. */
double latency_of_share(const latency *times, uint32_t percent);
/* Returns frames a second, one after the other; 0 without times. */
double latency_rate(const latency *times);
/* Writes "median M ms, 95 % at most N ms, worst W ms"; returns the text. */
const char *latency_text(const latency *times, char text[LATENCY_TEXT_BYTES]);

#endif
