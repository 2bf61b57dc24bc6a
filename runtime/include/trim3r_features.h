/* SPDX-License-Identifier: Apache-2.0 */
/* Features that a library may be built without, to save flash. Each switch is 1 unless the compiler's command says
 * otherwise, as -DT3R_FEATURE_STEREO=0 does: for the library, and for the programs that use it. A library without a
 * feature refuses it with T3R_ERR_UNSUPPORTED. docs/library.md lists the bytes that each saves. */
#ifndef TRIM3R_FEATURES_H
#define TRIM3R_FEATURES_H

/* Several views, which are compared and whose poses are corrected: t3r_config.views above 1, align, fit_widths. */
#ifndef T3R_FEATURE_COMPARISON
#define T3R_FEATURE_COMPARISON 1
#endif

/* Depth by stereo, with its planes: T3R_DEPTH_STEREO. */
#ifndef T3R_FEATURE_STEREO
#define T3R_FEATURE_STEREO T3R_FEATURE_COMPARISON
#elif T3R_FEATURE_STEREO && !T3R_FEATURE_COMPARISON
#error "T3R_FEATURE_STEREO needs T3R_FEATURE_COMPARISON"
#endif

/* Maps that follow a camera, and builds that follow one another: t3r_config.stream, warm. */
#ifndef T3R_FEATURE_STREAMS
#define T3R_FEATURE_STREAMS T3R_FEATURE_COMPARISON
#elif T3R_FEATURE_STREAMS && !T3R_FEATURE_COMPARISON
#error "T3R_FEATURE_STREAMS needs T3R_FEATURE_COMPARISON"
#endif

/* Heads that are networks: T3R_HEAD_LEARNED. */
#ifndef T3R_FEATURE_LEARNED
#define T3R_FEATURE_LEARNED 1
#endif

/* Refinement on the context views: t3r_config.refine above 0. */
#ifndef T3R_FEATURE_REFINEMENT
#define T3R_FEATURE_REFINEMENT 1
#endif

/* Rarely used in firmware: lenses with distortion, wavelets other than db2, allocations other than by density, several
 * workers, and the losses that refinement measures. */
#ifndef T3R_FEATURE_EXTRAS
#define T3R_FEATURE_EXTRAS 1
#endif

/* Gaussians beyond the pictures: t3r_config.rim and backdrop. */
#ifndef T3R_FEATURE_BACKDROP
#define T3R_FEATURE_BACKDROP 1
#endif

/* Losses that refinement measures: t3r_config.fit_passes and structural, t3r_request.max_loss_q8. */
#define T3R_FEATURE_LOSS (T3R_FEATURE_REFINEMENT && T3R_FEATURE_EXTRAS)

/* The features as bits of t3r_features(). */
#define T3R_HAS_NONE 0u
#define T3R_HAS_COMPARISON (1u << 0)
#define T3R_HAS_STEREO (1u << 1)
#define T3R_HAS_STREAMS (1u << 2)
#define T3R_HAS_LEARNED (1u << 3)
#define T3R_HAS_REFINEMENT (1u << 4)
#define T3R_HAS_EXTRAS (1u << 5)
#define T3R_HAS_BACKDROP (1u << 6)
#define T3R_HAS_LOSS (T3R_HAS_REFINEMENT | T3R_HAS_EXTRAS)

/* X(FEATURE, name), a row a bit. */
#define T3R_FEATURE_ROWS(X)                                                                                            \
    X(COMPARISON, comparison)                                                                                          \
    X(STEREO, stereo)                                                                                                  \
    X(STREAMS, streams)                                                                                                \
    X(LEARNED, learned)                                                                                                \
    X(REFINEMENT, refinement)                                                                                          \
    X(EXTRAS, extras)                                                                                                  \
    X(BACKDROP, backdrop)

/* The features of this build. */
#define T3R_BUILT_(FEATURE, name) | (T3R_FEATURE_##FEATURE ? T3R_HAS_##FEATURE : 0u)
#define T3R_FEATURES_BUILT (0u T3R_FEATURE_ROWS(T3R_BUILT_))

#endif
