/* What a library may be built without, to save flash. Each switch is 1 unless the compiler's command says otherwise, as
 * -DT3R_FEATURE_STEREO=0 does: for the library, and for the programs that use it. A library without a feature refuses
 * it with T3R_ERR_UNSUPPORTED. docs/library.md lists the bytes that each saves. */
#ifndef TRIM3R_FEATURES_H
#define TRIM3R_FEATURES_H

/* Depth by stereo: T3R_DEPTH_STEREO. */
#ifndef T3R_FEATURE_STEREO
#define T3R_FEATURE_STEREO 1
#endif

/* Planes where stereo matches nothing: t3r_config.planes. */
#ifndef T3R_FEATURE_PLANES
#define T3R_FEATURE_PLANES T3R_FEATURE_STEREO
#elif T3R_FEATURE_PLANES && !T3R_FEATURE_STEREO
#error "T3R_FEATURE_PLANES needs T3R_FEATURE_STEREO"
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

/* Refinement on the context views. */
#ifndef T3R_FEATURE_REFINEMENT
#define T3R_FEATURE_REFINEMENT 1
#endif

/* Budgets by a bounded loss, which refinement measures: t3r_request.max_loss_q8. */
#ifndef T3R_FEATURE_LOSS
#define T3R_FEATURE_LOSS T3R_FEATURE_REFINEMENT
#elif T3R_FEATURE_LOSS && !T3R_FEATURE_REFINEMENT
#error "T3R_FEATURE_LOSS needs T3R_FEATURE_REFINEMENT"
#endif

/* Lenses with distortion: t3r_camera.distortion. */
#ifndef T3R_FEATURE_LENSES
#define T3R_FEATURE_LENSES 1
#endif

/* Comparison of views: t3r_config.views above 1, and streams, which need it. */
#ifndef T3R_FEATURE_COMPARISON
#define T3R_FEATURE_COMPARISON 1
#endif

/* Poses corrected until views agree: t3r_config.align. */
#ifndef T3R_FEATURE_ALIGN
#define T3R_FEATURE_ALIGN T3R_FEATURE_COMPARISON
#elif T3R_FEATURE_ALIGN && !T3R_FEATURE_COMPARISON
#error "T3R_FEATURE_ALIGN needs T3R_FEATURE_COMPARISON"
#endif

/* Allocations of the budget other than by density: `paper`, `uniform`, `random` and `given`. */
#ifndef T3R_FEATURE_ALLOCATIONS
#define T3R_FEATURE_ALLOCATIONS 1
#endif

/* Wavelets other than db2. */
#ifndef T3R_FEATURE_WAVELETS
#define T3R_FEATURE_WAVELETS 1
#endif

/* Several workers: t3r_config.workers above 1. */
#ifndef T3R_FEATURE_WORKERS
#define T3R_FEATURE_WORKERS 1
#endif

/* Builds that follow one another: t3r_config.warm. */
#ifndef T3R_FEATURE_WARM
#define T3R_FEATURE_WARM 1
#endif

/* The features as bits: what t3r_features() returns. */
#define T3R_HAS_STEREO (1u << 0)
#define T3R_HAS_STREAMS (1u << 1)
#define T3R_HAS_LEARNED (1u << 2)
#define T3R_HAS_MOMENT (1u << 3)
#define T3R_HAS_REFINEMENT (1u << 4)
#define T3R_HAS_LENSES (1u << 5)
#define T3R_HAS_COMPARISON (1u << 6)
#define T3R_HAS_ALLOCATIONS (1u << 7)
#define T3R_HAS_WAVELETS (1u << 8)
#define T3R_HAS_WORKERS (1u << 9)
#define T3R_HAS_WARM (1u << 10)
#define T3R_HAS_LOSS (1u << 11)
#define T3R_HAS_PLANES (1u << 12)
#define T3R_HAS_ALIGN (1u << 13)

/* The features of this build. */
#define T3R_FEATURES_BUILT                                                                                             \
    ((T3R_FEATURE_STEREO ? T3R_HAS_STEREO : 0u) | (T3R_FEATURE_STREAMS ? T3R_HAS_STREAMS : 0u) |                       \
     (T3R_FEATURE_LEARNED ? T3R_HAS_LEARNED : 0u) | (T3R_FEATURE_MOMENT ? T3R_HAS_MOMENT : 0u) |                       \
     (T3R_FEATURE_REFINEMENT ? T3R_HAS_REFINEMENT : 0u) | (T3R_FEATURE_LENSES ? T3R_HAS_LENSES : 0u) |                 \
     (T3R_FEATURE_COMPARISON ? T3R_HAS_COMPARISON : 0u) | (T3R_FEATURE_ALLOCATIONS ? T3R_HAS_ALLOCATIONS : 0u) |       \
     (T3R_FEATURE_WAVELETS ? T3R_HAS_WAVELETS : 0u) | (T3R_FEATURE_WORKERS ? T3R_HAS_WORKERS : 0u) |                   \
     (T3R_FEATURE_WARM ? T3R_HAS_WARM : 0u) | (T3R_FEATURE_LOSS ? T3R_HAS_LOSS : 0u) |                                 \
     (T3R_FEATURE_PLANES ? T3R_HAS_PLANES : 0u) | (T3R_FEATURE_ALIGN ? T3R_HAS_ALIGN : 0u))

#endif
