/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of weights that are bound. */
#ifndef T3R_BIND_HEAD_CHECKS_H
#define T3R_BIND_HEAD_CHECKS_H

#include "core/fault.h"
#include "head/head.h"
#include "head/weights.h"
#include "layout/arena.h"
#include "state/state.h"

T3R_CHECKS t3r_bind_head_checks(const t3r_runtime *rt, const void *weights, size_t bytes, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    if (weights == NULL) {
        return T3R_OK;
    }
    const t3r_config *c = &rt->config;
    T3R_CHECK(fault, T3R_FEATURE_LEARNED, T3R_ERR_UNSUPPORTED,
              "this library was built without learned heads (T3R_FEATURE_LEARNED)");
    T3R_MISUSE(fault, c->views > 0, T3R_ERR_STATE, "config.views is 0: this runtime draws scenes and needs no head");
    const t3r_status status = t3r_weights_check(weights, bytes);
    T3R_CHECK(fault, status == T3R_OK, status, t3r_weights_error(weights, bytes));
    T3R_CHECK(fault, t3r_head_learned_work_bytes(weights, c->width) <= T3R_HEAD_WORK_(c->width, c->head_column_bytes),
              T3R_ERR_WEIGHTS,
              "config.head_column_bytes is #: this head needs # in views # pixels wide (t3r_head_column_bytes())",
              c->head_column_bytes, t3r_head_column_bytes(weights, bytes, c->width), c->width);
    return T3R_OK;
}

#endif
