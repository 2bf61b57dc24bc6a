/* The words of the command line. */
#ifndef T3R_BAREMETAL_OPTIONS_H
#define T3R_BAREMETAL_OPTIONS_H

#include <stdint.h>

/* Texts and numbers as main.c documents them; 0 and "" where a word is missing. */
typedef struct options {
    const char *frames, *view, *scene;
    uint32_t width, height, views, gaussians, clusters, cluster_batches, refine, learned, hashes, plain, cpu, arena;
} options;

/* Reads them; what is unknown, malformed or missing ends the program with a message. Texts live as long as it does. */
void options_read(options *o);

#endif
