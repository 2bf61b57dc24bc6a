/* A small float head with every kind of layer, random but repeatable, ranges included. */
#ifndef T3R_TESTS_SAMPLE_HEAD_H
#define T3R_TESTS_SAMPLE_HEAD_H

#include "float_head.h"

/* float_head_free() releases it. */
void sample_head(float_head *head, uint64_t seed);

#endif
