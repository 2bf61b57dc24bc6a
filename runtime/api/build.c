/* SPDX-License-Identifier: Apache-2.0 */
/* Builds a scene of the views; decides here what is requested and whether it is possible. */
#include "api/build_checks.h"
#include "core/config.h"
#include "loss/budget_choice.h"
#include "pipeline.h"
#include "state/state.h"

static const t3r_importance *importance_of(const t3r_build_order *order)
{
    return order->importance.planes != NULL ? &order->importance : NULL;
}

t3r_build_order t3r_order_of(const t3r_runtime *rt, const t3r_request *request)
{
    t3r_build_order order = {.build = t3r_build_of(&rt->config)};
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

t3r_status t3r_order_check(const t3r_runtime *rt, const t3r_request *request, const t3r_build_order *order)
{
    return t3r_order_checks(rt, request, order, NULL);
}

static t3r_status build(t3r_runtime *rt, t3r_build_order *order, t3r_scene *scene)
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
    t3r_build_order order;
    T3R_PASS(t3r_reconstruct_checks(rt, request, scene, &order, NULL));
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
    t3r_build_order order;
    T3R_PASS(t3r_rebuild_checks(rt, request, scene, &order, NULL));
    return build(rt, &order, scene);
}
