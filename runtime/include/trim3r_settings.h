/* SPDX-License-Identifier: Apache-2.0 */
/* The settings of the runtime, one row each. The rows generate the fields of t3r_config with their defaults, ranges and
 * needs, the program's options, Python's settings, the fuzzers' draws and the list in docs/library.md. */
#ifndef TRIM3R_SETTINGS_H
#define TRIM3R_SETTINGS_H

/* X(name, kind, low, high, default, feature, from, group, option, help):
 *
 *     name              the field of t3r_config
 *     kind              number; q8 = a number in 1/256; toggle = 0 or 1; wavelet, allocation, head and depth = an
 *                       enumeration of that name
 *     low, high         the range
 *     default           width, height, views and gaussians: the arguments of t3r_default_config()
 *     feature, from     values of `from` and more need this T3R_FEATURE_ of the library
 *     group, option     the program's option: BUILD = of all builds, STREAM = of streams, FIELD = there is none
 *     help              for the option and tables; the comment above the row has everything else to know */
#define T3R_SETTINGS(X)                                                                                                \
    /* The working size of every view. With depth by stereo at least T3R_STEREO_LEAST_SIDE each. */                    \
    X(width, number, T3R_MIN_SIDE, T3R_MAX_SIDE, width, NONE, 0, FIELD, NULL, "width of the working size in pixels")   \
    X(height, number, T3R_MIN_SIDE, T3R_MAX_SIDE, height, NONE, 0, FIELD, NULL,                                        \
      "height of the working size in pixels")                                                                          \
    /* In a stream, the number of newest keyframes that refinement uses. */                                            \
    X(views, number, 0, T3R_MAX_VIEWS, views, COMPARISON, 2, FIELD, NULL,                                              \
      "most context views that the arena has room for; 0 = it renders scenes from files alone")                        \
    X(max_gaussians, number, 1, T3R_MAX_GAUSSIANS, gaussians, NONE, 0, FIELD, NULL,                                    \
      "most Gaussians that the arena has room for")                                                                    \
    /* A scene has exactly this number, or the number of valid points if that is less. */                              \
    X(gaussians, number, 1, T3R_MAX_GAUSSIANS, gaussians, NONE, 0, FIELD, NULL,                                        \
      "budget of a scene in Gaussians, at most max_gaussians")                                                         \
    /* The largest target that t3r_render() may draw. */                                                               \
    X(render_width, number, 1, T3R_MAX_SIDE, width, NONE, 0, FIELD, NULL,                                              \
      "width of the largest picture to draw in pixels")                                                                \
    X(render_height, number, 1, T3R_MAX_SIDE, height, NONE, 0, FIELD, NULL,                                            \
      "height of the largest picture to draw in pixels")                                                               \
    X(wavelet, wavelet, 0, T3R_WAVELET_COUNT - 1, T3R_WAVELET_DB2, EXTRAS, 1, BUILD, "wavelet",                        \
      "wavelet that measures texture")                                                                                 \
    X(levels, number, 1, T3R_MAX_LEVELS, 2, NONE, 0, BUILD, "levels",                                                  \
      "levels of the wavelet that texture is summed over")                                                             \
    /* K in GaussianTrim3R. 0 = t3r_cluster_count() chooses. 1 skips the K-means. A stream has one. */                 \
    X(clusters, number, 0, T3R_MAX_CLUSTERS, 0, NONE, 0, BUILD, "clusters",                                            \
      "number of SuperClusters; 0 = as many as the allocation and the points ask for")                                 \
    /* 0 = t3r_cluster_batch_count() chooses. */                                                                       \
    X(cluster_batches, number, 0, 1024, 0, NONE, 0, FIELD, NULL,                                                       \
      "mini-batches of the K-means before every point is assigned; 0 = a number for the SuperClusters")                \
    X(colour_weight_q8, q8, 0, 1024, 256, NONE, 0, FIELD, NULL,                                                        \
      "weight of r, g, b against x, y, z in the metric of the K-means; 0 = position alone")                            \
    X(allocate, allocation, T3R_ALLOCATE_DENSITY, T3R_ALLOCATE_COUNT - 1, T3R_ALLOCATE_DENSITY, EXTRAS,                \
      T3R_ALLOCATE_PAPER, BUILD, "allocate", "allocation of the budget over the valid points")                         \
    X(keep_percent, number, 0, 100, 10, NONE, 0, BUILD, "keep-percent",                                                \
      "percent of its points that a trimmed SuperCluster keeps, with --allocate paper")                                \
    X(gamma_q8, q8, 0, 512, 179, NONE, 0, BUILD, "gamma",                                                              \
      "exponent of texture in the density; 0 = texture does not count")                                                \
    X(head, head, T3R_HEAD_ANALYTIC, T3R_HEAD_COUNT - 1, T3R_HEAD_ANALYTIC, LEARNED, T3R_HEAD_LEARNED, FIELD, NULL,    \
      "head that makes Gaussians of the retained points")                                                              \
    /* t3r_head_column_bytes() returns the bytes for a head. The default is enough for tiny and small with 8-bit       \
     * activations. */                                                                                                 \
    X(head_column_bytes, number, 0, T3R_MAX_HEAD_COLUMN_BYTES, T3R_HEAD_COLUMN_BYTES, NONE, 0, FIELD, NULL,            \
      "working memory of a learned head in bytes a column of the view; 0 = none, for builds by other heads")           \
    X(refine, number, 0, T3R_MAX_REFINE, T3R_DEFAULT_REFINE, REFINEMENT, 1, BUILD, "refine",                           \
      "passes of refinement on the context views, at most where they are fitted")                                      \
    /* 1 = `refine` is an upper bound, and t3r_refinement_passes() returns the number taken. Where neighbouring pixels \
     * share what views disagree about, as in most recordings, and without `structural`, 5/4 as many passes replace    \
     * them; all but the last compare one pixel in 2 x 2. A stream takes at most T3R_STREAM_REFINE a keyframe. 0 =     \
     * every build and keyframe takes all of them. */                                                                  \
    X(fit_passes, toggle, 0, 1, T3R_FEATURE_LOSS, LOSS, 1, BUILD, "fit-passes",                                        \
      "fit the passes to the budget and the agreement of the views: --refine at most, or 5/4 as many of one pixel in " \
      "2 x 2")                                                                                                         \
    /* 1 = widths of splats fit the retained points of all views together: narrower where several views cover a        \
     * surface, wider where one does or where points are few. 0 = they fit the points of their own view, which         \
     * always holds for T3R_HEAD_LEARNED, a stream, a build with refinement and a head without adaptation. */          \
    X(fit_widths, toggle, 0, 1, T3R_FEATURE_COMPARISON, COMPARISON, 1, BUILD, "fit-widths",                            \
      "without refinement, fit the widths of splats of analytic to the points of all views")                           \
    /* 1 = from its second pass on refinement weights local contrast like structural similarity, and ignores a         \
     * whole view's higher brightness or contrast. 0 = every missing level counts the same, which always holds in a    \
     * stream. */                                                                                                      \
    X(structural, toggle, 0, 1, 0, LOSS, 1, BUILD, "structural",                                                       \
      "refine structure more than level: local contrast, and not what a whole view shows brighter")                    \
    X(depth, depth, T3R_DEPTH_SENSOR, T3R_DEPTH_COUNT - 1, T3R_DEPTH_SENSOR, STEREO, T3R_DEPTH_STEREO, BUILD, "depth", \
      "source of depth; stereo matches the colours of two or more posed frames and ignores recorded depth")            \
    /* 1 = at most 24 Gaussians a view lie around its picture, four times as far as the surfaces at its border and     \
     * behind all that was seen, in the border's colours; at most 12 with a budget below 384 a view, none below 192.   \
     * So a view beside the context views, and a gap between near surfaces, is not black. The t3r_gaussian.view of     \
     * these is T3R_NO_VIEW, and renders have no depth there. Ignored with `stream`, and without `guess`. */           \
    X(rim, toggle, 0, 1, T3R_FEATURE_BACKDROP, BACKDROP, 1, BUILD, "rim",                                              \
      "continue the pictures beyond their borders with some wide Gaussians in the borders' colours")                   \
    /* 1 = 54 of a budget of 864 and more, 24 of 384, 6 of 96 are wide Gaussians 256 scene units away. They lie in all \
     * directions and have the colours of the views' borders, so that an orbit is not black where no context view saw. \
     * Their t3r_gaussian.view is T3R_NO_VIEW, and renders have no depth there. Ignored with `stream`. */              \
    X(backdrop, toggle, 0, 1, 0, BACKDROP, 1, BUILD, "backdrop",                                                       \
      "surround the scene with some wide Gaussians far away, in the colours of the pictures' borders")                 \
    X(fill_radius, number, 0, 8, 4, NONE, 0, BUILD, "fill-radius",                                                     \
      "fill holes of a depth sensor that measurements bracket within N pixels; 0 fills none")                          \
    X(bridge_radius, number, 0, 255, 64, NONE, 0, BUILD, "bridge-radius",                                              \
      "bridge wider holes, bracketed within N pixels, where no other view measured the surface; 0 bridges "            \
      "none")                                                                                                          \
    /* 1 = pixels that still have no depth after bridging take that of their surroundings, a guess with the confidence \
     * of bridged pixels. Needs bridge_radius above 0. Ignored in a stream, and with depth by stereo, which always     \
     * does so. */                                                                                                     \
    X(guess, toggle, 0, 1, T3R_FEATURE_COMPARISON, COMPARISON, 1, BUILD, "guess",                                      \
      "guess from the surroundings what depth is missing after --bridge-radius; not in a stream")                      \
    X(flying, toggle, 0, 1, 1, NONE, 0, BUILD, "flying",                                                               \
      "retain flying pixels last: points between surfaces, or in front of what another view measured")                 \
    X(redundancy, toggle, 0, 1, 1, NONE, 0, BUILD, "redundancy",                                                       \
      "let small budgets pass over points whose surface another view shows as finely")                                 \
    X(exposure, toggle, 0, 1, 1, NONE, 0, BUILD, "exposure", "bring the colours of all views to their mean exposure")  \
    /* 1 = the poses of a build's views are corrected first, by a rotation and a shift of each camera, at most 1/16    \
     * radian and 1/16 scene unit an axis. A correction is discarded unless it makes the views differ by at least a    \
     * 16th less. 0 = poses stay as given, which always holds with one view, with depth by stereo and with `warm`.     \
     * t3r_view_camera() returns them. In a stream poses stay, and the map may move after poses that jumped. */        \
    X(align, toggle, 0, 1, T3R_FEATURE_COMPARISON, COMPARISON, 1, BUILD, "align",                                      \
      "correct the poses of the views until they show the same surfaces in the same colours")                          \
    X(keep_analysis, toggle, 0, 1, 0, NONE, 0, FIELD, NULL,                                                            \
      "keep the analysis after the build, which t3r_rebuild() and a bounded loss need")                                \
    /* 1 = each build reuses the valid results of the previous one; 0 = every build starts from scratch. Views then    \
     * outlive the scene: t3r_add_view() adds to the last scene's views, and without room the newest replaces the      \
     * oldest. So a pair slides along a camera's path by one view at a time. A view that stays keeps its depth with    \
     * filled and bridged holes, its doubtful pixels and its texture. The K-means begin with the last centres and      \
     * take a sixth of the batches, and refinement takes half the passes, both rounded up. The scene's frame stays.    \
     * A build starts from scratch after t3r_init(), t3r_reset() or a failed build, if the exponent of the frame       \
     * changes, and beyond 512 scene units from its origin. A stream halves its passes from the second keyframe on.    \
     * The bits are a function of all calls since t3r_init() or t3r_reset(). A build from scratch has the bits of a    \
     * build with 0. Must be 0 with depth by stereo. */                                                                \
    X(warm, toggle, 0, 1, 0, STREAMS, 1, BUILD, "warm",                                                                \
      "let a build take over what still holds from the one before: with --slide and --stream of replay")               \
    /* 1 = the scene is built only by t3r_stream_keyframe(); 0 = scenes are built of all views at once. Must be 0      \
     * without views and with depth by stereo. */                                                                      \
    X(stream, toggle, 0, 1, 0, STREAMS, 1, FIELD, NULL,                                                                \
      "let a map of at most `gaussians` follow a camera with a depth sensor")                                          \
    /* 1 = a frame is measured before it touches the map, and refused if it cannot be trusted: t3r_refusal lists the   \
     * reasons. 0 = every frame with a depth is taken. Ignored without `stream`. */                                    \
    X(gate, toggle, 0, 1, 1, NONE, 0, STREAM, "gate",                                                                  \
      "refuse frames that are dark, blurred, covered or without depth, or that contradict the map")                    \
    X(half_life, number, 0, 1024, 32, NONE, 0, STREAM, "half-life",                                                    \
      "number of keyframes that halve the density of what they do not see; 0 = nothing fades")                         \
    /* 2 = a pass compares one pixel in 2 x 2, another one in each pass and view, for about a quarter of the time. 1 = \
     * every pixel, which always holds without `stream`. */                                                            \
    X(refine_stride, number, 0, 2, 0, NONE, 0, STREAM, "refine-stride",                                                \
      "compare one pixel in N x N in a pass of refinement; 0 = 2 where a Gaussian has 16 pixels and more, else 1")     \
    /* Takes two bytes a pixel for each. Each pass of refinement draws two of them in turn, and Gaussians that many    \
     * keyframes saw change by smaller steps, so the map keeps showing places that the camera has left. Without        \
     * room, the keyframe that the map needs least is forgotten. Ignored without `stream`. */                          \
    X(remember, number, 0, T3R_MAX_REMEMBERED, 0, NONE, 0, STREAM, "remember",                                         \
      "number of keyframes whose colours are remembered when their planes are gone, for refinement in "                \
      "turn")                                                                                                          \
    /* Each has its own part of the arena. The number never changes a bit. */                                          \
    X(workers, number, 1, T3R_MAX_WORKERS, 1, EXTRAS, 2, FIELD, NULL,                                                  \
      "number of tasks that t3r_hooks.parallel_for may run at once")                                                   \
    /* Bounds the time of an untrusted scene. */                                                                       \
    X(tile_splats, number, 0, T3R_MAX_GAUSSIANS, 0, NONE, 0, BUILD, "tile-splats",                                     \
      "draw a tile of 16 x 16 pixels from its N nearest Gaussians alone; 0 = from all")                                \
    X(seed, number, 0, UINT32_MAX, 1, NONE, 0, BUILD, "seed",                                                          \
      "seed of the K-means, of --allocate random and of ties in blue noise")

/* X(ENUMERATOR, name), a row a value, from the first that a configuration may have. */
#define T3R_WAVELETS(X) X(DB2, db2) X(HAAR, haar) X(CDF53, cdf53)
#define T3R_ALLOCATIONS(X)                                                                                             \
    X(DENSITY, density) /* over SuperClusters by |SC| x Texture(SC)^gamma, inside one by texture density */            \
    X(PAPER, paper)     /* GaussianTrim3R eq. 2: lowest texture first, each keeps N % */                               \
    X(PIXEL, pixel)     /* texture density without clusters */                                                         \
    X(UNIFORM, uniform) /* blue noise alone */                                                                         \
    X(RANDOM, random)   /* white noise of the seed */                                                                  \
    X(GIVEN, given)     /* by an importance of each pixel, which comes with the request */
#define T3R_DEPTHS(X)                                                                                                  \
    X(SENSOR, sensor) /* the frames' own */                                                                            \
    X(STEREO, stereo) /* the colours of two and more posed views; the frames' own depth is ignored */

#endif
