/* SPDX-License-Identifier: Apache-2.0 */
#include "prepare_rival.h"

#include <stdbool.h>
#include <stdlib.h>

#include "state/state.h"
#include "study/rivals/scores/choose.h"
#include "study/rivals/scores/score.h"

typedef struct ranking {
    splat_model model;
    splat_view views[T3R_MAX_VIEWS];
    double *score;  /* per Gaussian */
    uint32_t *kept; /* indices */
} ranking;

static bool rank(ranking *r, const t3r_runtime *rt, const t3r_scene *scene, const t3r_camera *cameras, uint32_t views,
                 method_kind kind, uint32_t count, uint32_t seed)
{
    bool done = splat_model_of(&r->model, scene->gaussians, scene->count);
    for (uint32_t v = 0; v < views && done; v++) {
        splat_camera camera = splat_camera_of(&cameras[v], &scene->frame, rt->config.width, rt->config.height);
        done = splat_view_open(&r->views[v], &camera, scene->count) && splat_view_project(&r->views[v], &r->model);
    }
    r->score = malloc(((size_t)scene->count + 1) * sizeof *r->score);
    r->kept = malloc(((size_t)count + 1) * sizeof *r->kept);
    return done && r->score != NULL && r->kept != NULL && score_of(kind, &r->model, r->views, views, seed, r->score) &&
           rival_choose(r->score, r->model.surfaces, scene->count, count, r->kept);
}

t3r_status prepare_rival(const t3r_runtime *rt, const t3r_scene *scene, const t3r_camera *cameras, uint32_t views,
                         method_kind kind, uint32_t count, uint32_t seed, uint16_t *const planes[])
{
    ranking r = {.score = NULL};
    t3r_status status = rank(&r, rt, scene, cameras, views, kind, count, seed) ? T3R_OK : T3R_ERR_ARENA;
    if (status == T3R_OK && !rival_planes(rt, scene, views, r.kept, count, planes)) {
        status = T3R_ERR_STATE;
    }
    for (uint32_t v = 0; v < views; v++) {
        splat_view_close(&r.views[v]);
    }
    splat_model_free(&r.model);
    free(r.score);
    free(r.kept);
    return status;
}
