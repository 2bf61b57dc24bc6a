/* SPDX-License-Identifier: Apache-2.0 */
/* Stubs for builds without learned heads: api/checks.c refuses builds that ask for one. */
#include "head.h"
#include "weights.h"

#if !T3R_FEATURE_LEARNED

uint32_t t3r_head_learned(const t3r_head_input *input, uint32_t begin, uint32_t end, t3r_gaussian *out)
{
    (void)input;
    (void)begin;
    (void)end;
    (void)out;
    return 0;
}

size_t t3r_head_learned_packed_bytes(const void *weights, uint32_t width)
{
    (void)weights;
    (void)width;
    return SIZE_MAX;
}

t3r_status t3r_weights_check(const void *weights, size_t bytes)
{
    (void)weights;
    (void)bytes;
    return T3R_ERR_UNSUPPORTED;
}

t3r_weights_header t3r_weights_header_of(const void *weights)
{
    (void)weights;
    return (t3r_weights_header){.layers = 0};
}

t3r_layer t3r_weights_layer(const void *weights, uint32_t index)
{
    (void)weights;
    (void)index;
    return (t3r_layer){.outputs = 0};
}

#endif
