/* What a library may be built without, to save flash. Each switch is 1 unless the compiler's command says otherwise, as
 * -DT3R_FEATURE_STEREO=0 does: for the library, and for the programs that use it. A library without a feature refuses
 * it with T3R_ERR_UNSUPPORTED. docs/library.md lists the bytes that each saves. */
#ifndef TRIM3R_FEATURES_H
#define TRIM3R_FEATURES_H

/* Depth by stereo: T3R_DEPTH_STEREO. */
#ifndef T3R_FEATURE_STEREO
#define T3R_FEATURE_STEREO 1
#endif

/* Maps that follow a camera: t3r_config.stream. */
#ifndef T3R_FEATURE_STREAMS
#define T3R_FEATURE_STREAMS 1
#endif

/* Heads that are networks: T3R_HEAD_LEARNED. */
#ifndef T3R_FEATURE_LEARNED
#define T3R_FEATURE_LEARNED 1
#endif

/* The head of moments: T3R_HEAD_MOMENT. */
#ifndef T3R_FEATURE_MOMENT
#define T3R_FEATURE_MOMENT 1
#endif

/* Refinement on the context views, and budgets by a bounded loss, which need it. */
#ifndef T3R_FEATURE_REFINEMENT
#define T3R_FEATURE_REFINEMENT 1
#endif

/* The features as bits: what t3r_features() returns. */
#define T3R_HAS_STEREO (1u << 0)
#define T3R_HAS_STREAMS (1u << 1)
#define T3R_HAS_LEARNED (1u << 2)
#define T3R_HAS_MOMENT (1u << 3)
#define T3R_HAS_REFINEMENT (1u << 4)

#endif
