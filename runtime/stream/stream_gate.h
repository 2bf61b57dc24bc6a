/* SPDX-License-Identifier: Apache-2.0 */
/* Measures a frame before it touches the map, and decides whether it becomes a keyframe (SPEC.md, "Gate"). */
#ifndef T3R_STREAM_GATE_H
#define T3R_STREAM_GATE_H

#include <stdbool.h>

#include "state/state.h"
#include "state/views.h"
#include "trim3r.h"

/* Measures the developed planes of the slot, and puts the figures into the report: holes are not filled yet, and the
 * pose is in the map's frame. Without a keyframe the map agrees. */
void t3r_gate_measure(const t3r_runtime *rt, const t3r_view *view, t3r_stream_report *report);

/* Whether the frame sees the map otherwise, by the figures. False where there is too little to compare. */
bool t3r_gate_contradicts(const t3r_stream_report *report);

/* Whether the frame shows the map by the figures, and clearly better than by those from another pose. */
bool t3r_gate_agrees(const t3r_stream_report *report, const t3r_stream_report *other);

/* Whether poses may have jumped: the frame contradicts the map, as did frames before it, along one path. */
bool t3r_gate_suspects_jump(const t3r_runtime *rt, const t3r_view *view, const t3r_stream_report *report);

/* Decides by the figures and by how many frames in a row were refused, and notes the decision for the next frames. Sets
 * report->moved if the frame is taken although it contradicts or misses the map. */
t3r_refusal t3r_gate_decide(t3r_runtime *rt, const t3r_view *view, const t3r_camera *camera, t3r_stream_report *report);

#endif
