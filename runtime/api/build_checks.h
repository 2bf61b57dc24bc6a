/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of calls that build a scene by a request. */
#ifndef T3R_BUILD_CHECKS_H
#define T3R_BUILD_CHECKS_H

#include <stdbool.h>

#include "budget/importance.h"
#include "checks.h"
#include "core/fault.h"
#include "core/features.h"
#include "state/state.h"

/* A request, completed with the configuration's values. */
typedef struct t3r_build_order {
    t3r_build build;
    uint32_t max_loss_q8;      /* 0: exactly the budget */
    t3r_importance importance; /* no planes unless the allocation is `given` */
} t3r_build_order;

t3r_build_order t3r_order_of(const t3r_runtime *rt, const t3r_request *request);

/* Run t3r_order_checks(): for the status, and for a sentence. */
t3r_status t3r_order_check(const t3r_runtime *rt, const t3r_request *request, const t3r_build_order *order);
t3r_status t3r_order_fault(const t3r_runtime *rt, const t3r_request *request, const t3r_build_order *order,
                           t3r_fault *fault);

/* Checks that the library was built with everything the order needs. */
T3R_CHECKS t3r_support_checks(const t3r_build_order *order, t3r_fault *fault)
{
    T3R_MISUSE(fault,
               t3r_has(t3r_feature_of_head(order->build.head) | T3R_NEED(allocate, order->build.allocate) |
                       (order->max_loss_q8 != 0 ? T3R_HAS_LOSS : 0u)),
               T3R_ERR_UNSUPPORTED,
               !t3r_has(t3r_feature_of_head(order->build.head)) ? "this library was built without learned heads "
                                                                  "(T3R_FEATURE_LEARNED), which request.head needs"
               : order->max_loss_q8 != 0 && !t3r_has(T3R_HAS_LOSS)
                   ? "this library was built without the losses (T3R_FEATURE_REFINEMENT, T3R_FEATURE_EXTRAS) that "
                     "request.max_loss_q8 needs"
                   : "this library was built with T3R_ALLOCATE_DENSITY alone (T3R_FEATURE_EXTRAS): request.allocate is "
                     "#",
               order->build.allocate);
    return T3R_OK;
}

/* Checks that each added view has a readable plane. */
T3R_CHECKS t3r_importance_checks(const t3r_runtime *rt, const t3r_importance *importance, t3r_fault *fault)
{
    T3R_CHECK(fault, importance->stride_bytes % 2 == 0 && importance->stride_bytes / 2 >= rt->config.width,
              T3R_ERR_ARGUMENT,
              "request.importance_stride_bytes is @: a stride is in bytes, even, and at least the # of a row",
              importance->stride_bytes, 2 * rt->config.width);
    for (uint32_t v = 0; v < rt->views; v++) {
        const uint16_t *plane = importance->planes[v];
        T3R_CHECK(fault, plane != NULL && (uintptr_t)plane % _Alignof(uint16_t) == 0, T3R_ERR_ARGUMENT,
                  plane == NULL ? "request.importance[#] is NULL: each view has a plane"
                                : "request.importance[#] is not aligned for uint16_t",
                  v);
    }
    return T3R_OK;
}

/* Checks that every field of the request is in range. Without a feature, t3r_support_checks() has refused its fields.
 */
T3R_CHECKS t3r_request_checks(const t3r_runtime *rt, const t3r_request *request, const t3r_build_order *order,
                              t3r_fault *fault)
{
    T3R_CHECK(fault,
              !T3R_FEATURE_EXTRAS || request == NULL || request->importance == NULL ||
                  request->allocate == T3R_ALLOCATE_CONFIGURED || request->allocate == T3R_ALLOCATE_GIVEN,
              T3R_ERR_ARGUMENT, "request.allocate is @: with an importance it is T3R_ALLOCATE_GIVEN or 0",
              request->allocate);
    T3R_PASS(fault == NULL ? (t3r_is_build(&rt->config, &order->build) ? T3R_OK : T3R_ERR_ARGUMENT)
                           : t3r_build_checks(&rt->config, &order->build, fault));
    T3R_CHECK(fault, !T3R_FEATURE_LOSS || order->max_loss_q8 <= T3R_MAX_LOSS_Q8, T3R_ERR_ARGUMENT,
              "request.max_loss_q8 is @: a loss is 0..#, in 1/256 dB (10 dB)", order->max_loss_q8, T3R_MAX_LOSS_Q8);
    if (T3R_FEATURE_EXTRAS && order->importance.planes != NULL) {
        T3R_PASS(t3r_importance_checks(rt, &order->importance, fault));
    }
    return T3R_OK;
}

/* Checks that weights and planes which the order needs are there. A loss is measured on trial scenes of one analysis.
 */
T3R_CHECKS t3r_need_checks(const t3r_runtime *rt, const t3r_build_order *order, t3r_fault *fault)
{
    T3R_MISUSE(fault, t3r_has_head(rt, order->build.head), T3R_ERR_STATE, T3R_NO_HEAD_TEXT);
    T3R_MISUSE(fault,
               !T3R_FEATURE_EXTRAS || order->build.allocate != T3R_ALLOCATE_GIVEN || order->importance.planes != NULL,
               T3R_ERR_STATE, "the allocation is T3R_ALLOCATE_GIVEN, and request.importance is NULL");
    T3R_MISUSE(
        fault, !T3R_FEATURE_LOSS || order->max_loss_q8 == 0 || (rt->config.keep_analysis && rt->config.refine > 0),
        T3R_ERR_STATE, "config.keep_analysis is # and config.refine is #: request.max_loss_q8 needs both above 0",
        rt->config.keep_analysis, rt->config.refine);
    return T3R_OK;
}

/* Checks everything but the state of views and analysis. */
T3R_CHECKS t3r_order_checks(const t3r_runtime *rt, const t3r_request *request, const t3r_build_order *order,
                            t3r_fault *fault)
{
    T3R_PASS(t3r_support_checks(order, fault));
    T3R_PASS(t3r_request_checks(rt, request, order, fault));
    return t3r_need_checks(rt, order, fault);
}

/* Returns the sentence for a state with too few views. */
static inline const char *t3r_no_views_text(const t3r_runtime *rt)
{
    if (t3r_is_stream(&rt->config)) {
        return "this runtime is a stream's: t3r_stream_keyframe() builds its scene";
    }
    if (rt->config.views == 0) {
        return "config.views is 0: this runtime draws scenes and builds none";
    }
    if (rt->views > 0) {
        return "there is # view: depth by stereo needs two and more";
    }
    return rt->has_scene ? "there are no views: t3r_scene_begin(), and t3r_render() without config.keep_analysis, "
                           "discard them; call t3r_reset(), then t3r_add_view()"
                         : "there are no views: call t3r_add_view() first";
}

/* *order becomes the order of the request. */
T3R_CHECKS t3r_ordering_checks(const t3r_runtime *rt, const t3r_request *request, const t3r_scene *scene,
                               t3r_build_order *order, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, scene != NULL, T3R_ERR_ARGUMENT, "scene is NULL");
    *order = t3r_order_of(rt, request);
    return fault == NULL ? t3r_order_check(rt, request, order) : t3r_order_fault(rt, request, order, fault);
}

T3R_CHECKS t3r_reconstruct_checks(const t3r_runtime *rt, const t3r_request *request, const t3r_scene *scene,
                                  t3r_build_order *order, t3r_fault *fault)
{
    T3R_PASS(t3r_ordering_checks(rt, request, scene, order, fault));
    T3R_MISUSE(fault, !t3r_is_stream(&rt->config) && rt->views >= (t3r_is_by_stereo(&rt->config) ? 2u : 1u),
               T3R_ERR_STATE, t3r_no_views_text(rt), rt->views);
    return T3R_OK;
}

T3R_CHECKS t3r_rebuild_checks(const t3r_runtime *rt, const t3r_request *request, const t3r_scene *scene,
                              t3r_build_order *order, t3r_fault *fault)
{
    T3R_PASS(t3r_ordering_checks(rt, request, scene, order, fault));
    T3R_MISUSE(fault, rt->config.keep_analysis, T3R_ERR_STATE,
               "config.keep_analysis is 0: t3r_rebuild() needs it, and t3r_reconstruct() does not");
    T3R_MISUSE(fault, rt->analysed, T3R_ERR_STATE, "there is no analysis: call t3r_reconstruct() first");
    return T3R_OK;
}

/* Checks what t3r_rebuild_least() adds to a rebuild. */
T3R_CHECKS t3r_least_checks(const t3r_runtime *rt, const t3r_request *request, uint32_t least_psnr_q8,
                            const t3r_target *picture, const t3r_scene *scene, const t3r_least *found, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, picture != NULL, T3R_ERR_ARGUMENT, "picture is NULL");
    T3R_MISUSE(fault, scene != NULL, T3R_ERR_ARGUMENT, "scene is NULL");
    T3R_MISUSE(fault, found != NULL, T3R_ERR_ARGUMENT, "found is NULL");
    T3R_MISUSE(fault, T3R_FEATURE_LOSS, T3R_ERR_UNSUPPORTED,
               "this library was built without losses (T3R_FEATURE_REFINEMENT, T3R_FEATURE_EXTRAS)");
    T3R_MISUSE(fault, least_psnr_q8 >= 1 && least_psnr_q8 <= T3R_MAX_PSNR_Q8, T3R_ERR_ARGUMENT,
               "least_psnr_q8 is @: a PSNR is 1..#, in 1/256 dB (100 dB)", least_psnr_q8, T3R_MAX_PSNR_Q8);
    T3R_MISUSE(fault, request == NULL || request->max_loss_q8 == 0, T3R_ERR_ARGUMENT,
               "request.max_loss_q8 is #: it must be 0 with a PSNR", request->max_loss_q8);
    T3R_MISUSE(fault, picture->rgb != NULL, T3R_ERR_ARGUMENT, "picture.rgb is NULL: it is memory for a view");
    T3R_MISUSE(fault, picture->width == rt->config.width && picture->height == rt->config.height, T3R_ERR_ARGUMENT,
               "picture is of # x # pixels: it must be of the working size, # x #", picture->width, picture->height,
               rt->config.width, rt->config.height);
    return T3R_OK;
}

#endif
