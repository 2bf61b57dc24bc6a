#include "views.h"

#include "core/features.h"
#include "core/scene_frame.h"
#include "state.h"

t3r_view t3r_view_of(const t3r_runtime *rt, uint32_t index)
{
    const size_t pixels = T3R_PIXELS_(rt->config.width, rt->config.height), words = (pixels + 31) / 32;
    const uint32_t plane = t3r_is_stream(&rt->config) ? 0 : index; /* a stream analyses one keyframe at a time */
    uint8_t *colour = (uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_COLOUR) + 3 * pixels * index;
    const t3r_camera *camera = &rt->camera[index];
    t3r_view view = {
        .width = rt->config.width,
        .height = rt->config.height,
        .colour = {colour, colour + pixels, colour + 2 * pixels},
        .depth = (uint16_t *)t3r_buffer_at(rt, T3R_BUFFER_DEPTH) + pixels * index,
        .validity = (uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_VALIDITY) + pixels * index,
        .texture = (uint16_t *)t3r_buffer_at(rt, T3R_BUFFER_TEXTURE) + pixels * plane,
        .key = (uint16_t *)t3r_buffer_at(rt, T3R_BUFFER_KEYS) + pixels * plane,
        .label = (uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_LABELS) + pixels * plane,
        .mask = (uint32_t *)t3r_buffer_at(rt, T3R_BUFFER_MASK) + words * plane,
        .fx_q16 = camera->fx_q16,
        .fy_q16 = camera->fy_q16,
        .cx_q16 = camera->cx_q16,
        .cy_q16 = camera->cy_q16,
        .depth_unit_q40 = rt->depth_unit_q40[index],
    };
    if (index < rt->views) {
        /* in range once there is an analysis; t3r_analyse() computes it again in the frame that it chooses */
        (void)t3r_pose_in_scene(camera, &rt->frame, &view.pose);
    }
    return view;
}

bool t3r_is_reliable_anywhere(const t3r_view *view)
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    for (size_t i = 0; i < pixels; i++) {
        if (t3r_is_reliable(view->validity[i])) {
            return true;
        }
    }
    return false;
}

void t3r_views_of(const t3r_runtime *rt, t3r_view views[T3R_MAX_VIEWS])
{
    for (uint32_t v = 0; v < rt->config.views; v++) {
        views[v] = t3r_view_of(rt, v);
    }
}

uint8_t t3r_confidence_of(uint8_t validity)
{
    static const struct {
        uint8_t unmarked, covered, doubtful;
    } confidence[] = {
        [T3R_NO_DEPTH] = {0, 0, 0},
        [T3R_FILLED] = {128, 96, 32},
        [T3R_BRIDGED] = {24, 16, 24}, /* never doubtful */
        [T3R_MEASURED] = {255, 192, 64},
    };
    t3r_depth_source source = t3r_depth_source_of(validity);
    return t3r_is_doubtful(validity)  ? confidence[source].doubtful
           : t3r_is_covered(validity) ? confidence[source].covered
                                      : confidence[source].unmarked;
}

void t3r_reset_comparison(const t3r_view *views, uint32_t count)
{
    for (uint32_t v = 0; v < count; v++) {
        size_t pixels = T3R_PIXELS_(views[v].width, views[v].height);
        for (size_t i = 0; i < pixels; i++) {
            uint8_t *validity = &views[v].validity[i];
            if (t3r_is_bridged(*validity)) {
                *validity = T3R_NO_DEPTH;
                views[v].depth[i] = 0;
            }
            *validity = t3r_unmarked(*validity);
        }
    }
}

void t3r_reset_covered(const t3r_view *view)
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    for (size_t i = 0; i < pixels; i++) {
        view->validity[i] &= T3R_DEPTH_SOURCE_BITS | T3R_MARK_DOUBTFUL;
    }
}
