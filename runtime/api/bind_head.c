/* SPDX-License-Identifier: Apache-2.0 */
/* Binds the weights of a learned head. */
#include "api/bind_head_checks.h"

t3r_status t3r_bind_head(t3r_runtime *rt, const void *weights, size_t bytes)
{
    T3R_PASS(t3r_bind_head_checks(rt, weights, bytes, NULL));
    if (weights == NULL) {
        rt->weights = NULL;
        return T3R_OK;
    }
    rt->weights = weights;
    rt->head_crc = t3r_weights_header_of(weights).crc;
    return T3R_OK;
}

uint32_t t3r_head_column_bytes(const void *weights, size_t bytes, uint32_t width)
{
    if (width == 0 || width > T3R_MAX_SIDE || t3r_weights_check(weights, bytes) != T3R_OK) {
        return 0;
    }
    const size_t columns = T3R_HEAD_COLUMNS_(width), work = t3r_head_learned_work_bytes(weights, width);
    size_t a_column = work <= T3R_HEAD_KERNEL_BYTES ? 1 : (work - T3R_HEAD_KERNEL_BYTES + columns - 1) / columns;
    return a_column > UINT32_MAX ? UINT32_MAX : (uint32_t)a_column;
}

uint32_t t3r_head_crc(const t3r_runtime *rt)
{
    return rt == NULL ? 0 : rt->head_crc;
}
