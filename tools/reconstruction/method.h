/* The methods of build and eval: ours, and those that it is measured against, each as published, fine-tuned, or
 * choosing points for our head. */
#ifndef TRIM3R_TOOLS_METHOD_H
#define TRIM3R_TOOLS_METHOD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/tables/word_list.h"

typedef enum method_kind {
    METHOD_TRIM3R, /* allocation and head from the settings */
    /* rivals: keep the Gaussians of the head's unpruned scene that a score ranks highest (rivals/score.h) */
    METHOD_RANDOM,
    METHOD_EAGLES,
    METHOD_LIGHTGAUSSIAN,
    METHOD_PUP,
    METHOD_EFFICIENTGS,
    METHOD_KIND_COUNT
} method_kind;

/* What is done with the points that a kind chooses. */
typedef enum method_way {
    METHOD_PLAIN,
    METHOD_FINETUNE, /* fine-tune their Gaussians on the context views */
    METHOD_HEAD,     /* make new Gaussians with the head (allocation `given`), refined as ours are */
    METHOD_WAY_COUNT
} method_way;

/* A kind and a way: way x METHOD_KIND_COUNT + kind. */
typedef uint32_t method_id;
#define METHOD_COUNT ((uint32_t)METHOD_WAY_COUNT * METHOD_KIND_COUNT)
#define METHOD_ITERATIONS 200u /* default iterations of fine-tuning */
#define METHOD_ITERATIONS_MOST 100000u
#define METHOD_NAMES "trim3r, random, eagles, lightgaussian, pup, efficientgs, each also with +finetune or +head"
#define METHOD_HELP                                                                                                    \
    "trim3r (default), or a rival: random, eagles, lightgaussian, pup, efficientgs; +finetune behind any of them "     \
    "fine-tunes its Gaussians, +head makes new ones of its points"

static inline method_kind method_kind_of(method_id m)
{
    return (method_kind)(m % METHOD_KIND_COUNT);
}

static inline method_way method_way_of(method_id m)
{
    return (method_way)(m / METHOD_KIND_COUNT);
}

/* Whether our head works on a rival's choice of points. */
static inline bool method_ranks_for_head(method_id m)
{
    return method_way_of(m) == METHOD_HEAD && method_kind_of(m) != METHOD_TRIM3R;
}

/* Returns "trim3r", "eagles+finetune", "eagles+head". */
const char *method_name(method_id m);
/* Returns METHOD_COUNT for an unknown name. */
method_id method_named(list_word name);

#endif
