/* What has rows of its own in an evaluation: a method, trim3r once a head or once an ablation. */
#ifndef TRIM3R_TOOLS_EVALUATION_CONTESTANT_H
#define TRIM3R_TOOLS_EVALUATION_CONTESTANT_H

#include "study/evaluation/ablation.h"
#include "reconstruction/method.h"
#include "reconstruction/reconstruction.h"

#define EVALUATION_HEADS_MOST 32u
#define EVALUATION_CONTESTANTS_MOST (EVALUATION_HEADS_MOST + ABLATIONS_MOST + METHOD_COUNT)
#define EVALUATION_LABEL_BYTES 40

typedef struct evaluation_contestant {
    method_id method;
    const char *head;                   /* NULL: the settings' own */
    bool ablated;                       /* one of the rows of --ablate */
    uint32_t ablation;                  /* then */
    char label[EVALUATION_LABEL_BYTES]; /* over its pictures and in their names */
} evaluation_contestant;

typedef struct evaluation_contestants {
    evaluation_contestant list[EVALUATION_CONTESTANTS_MOST];
    uint32_t count;
} evaluation_contestants;

/* Methods, with trim3r once for each of `heads` where there are any; or ablations of `settings`: those given, which
 * must apply, or, of none, all that do. Opens every head once: a bad one is told before the work. An exit status of
 * cli.h after a message. */
int evaluation_contestants_methods(evaluation_contestants *chosen, const method_id *methods, uint32_t method_count,
                                   char *const *heads, uint32_t head_count, const reconstruction_options *settings);
int evaluation_contestants_ablations(evaluation_contestants *chosen, const uint32_t *ablations, uint32_t count,
                                     bool planar, const reconstruction_options *settings);

/* The settings' scene file alone. */
void evaluation_contestants_scene(evaluation_contestants *chosen);

/* The settings with what the contestant changes of them. */
reconstruction_options evaluation_contestant_settings(const evaluation_contestant *it,
                                                      const reconstruction_options *settings);

#endif
