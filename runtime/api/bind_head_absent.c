/* SPDX-License-Identifier: Apache-2.0 */
/* Stub for builds without learned heads: no weights can be bound. */
#include "state/state.h"

#if !T3R_FEATURE_LEARNED

t3r_status t3r_bind_head(t3r_runtime *rt, const void *weights, size_t bytes)
{
    (void)bytes;
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    return weights == NULL ? T3R_OK : T3R_ERR_UNSUPPORTED;
}

const char *t3r_weights_error(const void *weights, size_t bytes)
{
    (void)weights;
    (void)bytes;
    return "this library was built without learned heads";
}

uint32_t t3r_head_column_bytes(const void *weights, size_t bytes, uint32_t width)
{
    (void)weights;
    (void)bytes;
    (void)width;
    return 0;
}

uint32_t t3r_head_crc(const t3r_runtime *rt)
{
    (void)rt;
    return 0;
}

#endif
