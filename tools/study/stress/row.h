/* SPDX-License-Identifier: Apache-2.0 */
/* A row of a stress test: one perturbation of one case at one strength, one method, one budget. */
#ifndef TRIM3R_TOOLS_STRESS_ROW_H
#define TRIM3R_TOOLS_STRESS_ROW_H

#include <stdint.h>

#include "reconstruction/method.h"

#define STRESS_REASON_BYTES 200

typedef enum stress_status {
    STRESS_MEASURED,
    STRESS_REFUSED, /* refused with a reason, as expected for unusable frames */
    STRESS_BROKEN   /* an invariant is broken; the reason names it */
} stress_status;

/* Values of a row; NaN: does not apply. */
typedef enum stress_value {
    STRESS_BUDGET,    /* requested budget, the one for the unperturbed frames */
    STRESS_GAUSSIANS, /* count used */
    STRESS_PSNR,      /* of the target, on the mask of the unperturbed frames, dB */
    STRESS_SSIM,
    STRESS_HOLES,            /* share of the mask with transmittance above 1/2 */
    STRESS_PERCEPTUAL,       /* FLIP on the mask */
    STRESS_PSNR_UNPRUNED,    /* PSNR with all points of the same frames, dB */
    STRESS_PSNR_LOST,        /* against the method's unperturbed row, dB; for a synthetic scene against all points */
    STRESS_SSIM_LOST,        /* likewise */
    STRESS_FLICKER,          /* mean change on the mask between noisy captures of the still scene, 8-bit levels */
    STRESS_FLICKER_UNPRUNED, /* the same with all points */
    STRESS_MASK_CHANGED,     /* unperturbed rows: share of the retained pixels that the next capture does not retain */
    STRESS_MOTION,   /* unperturbed rows: median motion of the Gaussians retained in both captures, as a share of their
                spacing */
    STRESS_BUILD_MS, /* least of the captures */
    STRESS_BUILD_RATIO, /* against the unperturbed row */
    STRESS_ARENA_BYTES,
    STRESS_VALUE_COUNT
} stress_value;

typedef struct stress_row {
    char scene[256], context[192], target[16];
    const char *what, *unit; /* a perturbation, "unperturbed", or a synthetic scene */
    double strength;
    uint32_t grade; /* 1..STRESS_GRADES; 0 = unperturbed */
    const method *method;
    double keep;
    stress_status status;
    char reason[STRESS_REASON_BYTES]; /* "" when measured */
    double value[STRESS_VALUE_COUNT];
} stress_row;

#define STRESS_UNPERTURBED "unperturbed"

#endif
