/* SPDX-License-Identifier: Apache-2.0 */
/* How methods choose points, and how Gaussians are made of these. */
#ifndef TRIM3R_TOOLS_RIVALS_KINDS_H
#define TRIM3R_TOOLS_RIVALS_KINDS_H

typedef enum method_kind {
    METHOD_TRIM3R, /* allocation and head as the settings say */
    /* rivals: the head's unpruned scene, of which those Gaussians stay that a score ranks highest (score.h) */
    METHOD_RANDOM,
    METHOD_EAGLES,
    METHOD_LIGHTGAUSSIAN,
    METHOD_PUP,
    METHOD_EFFICIENTGS,
    METHOD_KIND_COUNT
} method_kind;

/* How the points that a kind chooses become Gaussians. */
typedef enum method_way {
    METHOD_PLAIN,
    METHOD_FINETUNE, /* their Gaussians are fine-tuned on the context views */
    METHOD_HEAD,     /* the head makes new ones of them (allocation `given`), refined as ours are */
    METHOD_WAY_COUNT
} method_way;

#endif
