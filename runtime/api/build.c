/* SPDX-License-Identifier: Apache-2.0 */
/* Builds a scene of the views; decides here what is requested and whether it is possible. */
#include "api/checks.h"
#include "core/config.h"
#include "core/features.h"
#include "loss/budget_choice.h"
#include "pipeline.h"
#include "state/state.h"

/* A request, completed with the configuration's values. */
typedef struct build_order {
    t3r_build build;
    uint32_t max_loss_q8;      /* 0: exactly the budget */
    t3r_importance importance; /* no planes unless the allocation is `given` */
} build_order;

static const t3r_importance *importance_of(const build_order *order)
{
    return order->importance.planes != NULL ? &order->importance : NULL;
}

static build_order order_of(const t3r_runtime *rt, const t3r_request *request)
{
    build_order order = {.build = t3r_build_of(&rt->config)};
    if (request == NULL) {
        return order;
    }
    order.build.gaussians = request->gaussians != 0 ? request->gaussians : order.build.gaussians;
    if (request->importance != NULL) {
        order.build.allocate = T3R_ALLOCATE_GIVEN;
    } else if (request->allocate != T3R_ALLOCATE_CONFIGURED) {
        order.build.allocate = request->allocate;
    }
    order.build.head = request->head != T3R_HEAD_CONFIGURED ? request->head : order.build.head;
    order.max_loss_q8 = request->max_loss_q8;
    order.importance = (t3r_importance){request->importance, request->importance_stride_bytes};
    return order;
}

/* Whether each added view has a readable plane. */
static bool is_importance(const t3r_runtime *rt, const t3r_importance *importance)
{
    if (importance->stride_bytes % 2 != 0 || importance->stride_bytes / 2 < rt->config.width) {
        return false;
    }
    for (uint32_t v = 0; v < rt->views; v++) {
        const uint16_t *plane = importance->planes[v];
        if (plane == NULL || (uintptr_t)plane % _Alignof(uint16_t) != 0) {
            return false;
        }
    }
    return true;
}

/* Whether an importance comes only with the allocation `given`. */
static bool agrees(const t3r_request *request)
{
    return request == NULL || request->importance == NULL || request->allocate == T3R_ALLOCATE_CONFIGURED ||
           request->allocate == T3R_ALLOCATE_GIVEN;
}

static bool is_request(const t3r_runtime *rt, const t3r_request *request, const build_order *order)
{
    return agrees(request) && t3r_is_build(&rt->config, &order->build) && order->max_loss_q8 <= T3R_MAX_LOSS_Q8 &&
           (order->importance.planes == NULL || is_importance(rt, &order->importance));
}

/* Whether the library was built with everything the order needs. */
static bool is_supported(const build_order *order)
{
    return t3r_has(t3r_feature_of_head(order->build.head) | T3R_NEED(allocate, order->build.allocate) |
                   (order->max_loss_q8 != 0 ? T3R_HAS_LOSS : 0u));
}

/* Whether views, weights and planes that the order needs are there. A loss is measured on trial scenes of one
 * analysis. */
static bool can_be_built(const t3r_runtime *rt, const build_order *order)
{
    return t3r_has_head(rt, order->build.head) &&
           (order->build.allocate != T3R_ALLOCATE_GIVEN || order->importance.planes != NULL) &&
           (order->max_loss_q8 == 0 || (rt->config.keep_analysis && rt->config.refine > 0));
}

static bool has_views(const t3r_runtime *rt)
{
    return !t3r_is_stream(&rt->config) && rt->views >= (t3r_is_by_stereo(&rt->config) ? 2u : 1u);
}

static t3r_status build(t3r_runtime *rt, build_order *order, t3r_scene *scene)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    t3r_status status = T3R_OK;
    if (order->max_loss_q8 != 0) {
        status = t3r_choose_budget(rt, views, order->max_loss_q8, &order->build, importance_of(order));
        rt->has_scene = 0; /* the scene is the trial's */
    }
    if (status == T3R_OK) {
        status = t3r_build_scene(rt, views, &order->build, importance_of(order));
    }
    return status == T3R_OK ? t3r_get_scene(rt, scene) : status;
}

t3r_status t3r_reconstruct(t3r_runtime *rt, const t3r_request *request, t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL, T3R_ERR_ARGUMENT);
    build_order order = order_of(rt, request);
    T3R_REFUSE_UNLESS(is_supported(&order), T3R_ERR_UNSUPPORTED);
    T3R_REFUSE_UNLESS(is_request(rt, request, &order), T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(has_views(rt) && can_be_built(rt, &order), T3R_ERR_STATE);
    rt->has_scene = 0;
    rt->analysed = 0;
    t3r_status status = t3r_analyse(rt);
    if (status == T3R_OK && rt->follows) {
        order.build.refine = t3r_following_passes_of(&rt->config);
    }
    if (status == T3R_OK) {
        status = build(rt, &order, scene);
    }
    if (status != T3R_OK) {
        t3r_reuse_nothing(rt);
    }
    return status;
}

t3r_status t3r_rebuild(t3r_runtime *rt, const t3r_request *request, t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL, T3R_ERR_ARGUMENT);
    build_order order = order_of(rt, request);
    T3R_REFUSE_UNLESS(is_supported(&order), T3R_ERR_UNSUPPORTED);
    T3R_REFUSE_UNLESS(is_request(rt, request, &order), T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(rt->config.keep_analysis && rt->analysed && can_be_built(rt, &order), T3R_ERR_STATE);
    return build(rt, &order, scene);
}
