/* The words of the command line. */
#ifndef T3R_BAREMETAL_OPTIONS_H
#define T3R_BAREMETAL_OPTIONS_H

#include <stdint.h>

/* Texts and numbers as main.c documents them; 0 and "" for missing words. */
typedef struct options {
    const char *frames, *view, *scene;
    uint32_t width, height, views, gaussians, clusters, cluster_batches, refine, learned, hashes, plain, cpu, arena;
} options;

/* Reads the words; unknown, malformed or missing ones end the program with a message. Texts live as long as the
 * program. */
void options_read(options *o);

#endif
