/* SPDX-License-Identifier: Apache-2.0 */
/* The methods' ways of choosing points, and of making Gaussians of them. */
#ifndef TRIM3R_TOOLS_RIVALS_KINDS_H
#define TRIM3R_TOOLS_RIVALS_KINDS_H

typedef enum method_kind {
    METHOD_TRIM3R, /* allocation and head from the settings */
    /* rivals: the Gaussians of the head's unpruned scene with the highest scores (score.h) */
    METHOD_RANDOM,
    METHOD_EAGLES,
    METHOD_LIGHTGAUSSIAN,
    METHOD_PUP,
    METHOD_EFFICIENTGS,
    METHOD_KIND_COUNT
} method_kind;

/* The way from chosen points to Gaussians. */
typedef enum method_way {
    METHOD_PLAIN,
    METHOD_FINETUNE, /* the rival's Gaussians are fine-tuned on the context views */
    METHOD_HEAD,     /* the head makes new Gaussians at the chosen points (allocation `given`), refined like trim3r's */
    METHOD_WAY_COUNT
} method_way;

#endif
