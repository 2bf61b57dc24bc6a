/* SPDX-License-Identifier: Apache-2.0 */
/* The methods that trim3r is compared with: each as published, fine-tuned, or as the choice of points for our head. */
#ifndef TRIM3R_TOOLS_RIVALS_METHODS_H
#define TRIM3R_TOOLS_RIVALS_METHODS_H

#include "cli/text/word_list.h"
#include "reconstruction/method.h"
#include "study/rivals/scores/kinds.h"

typedef struct rival_method {
    method method;
    method_kind kind;
    method_way way;
} rival_method;

/* Each kind in each way. The first is method_trim3r; RIVAL_METHOD() names the others. */
#define METHOD_COUNT (METHOD_WAY_COUNT * METHOD_KIND_COUNT)
#define RIVAL_METHOD(kind, way) (&rival_methods[(way)*METHOD_KIND_COUNT + (kind)-1].method)
extern const rival_method rival_methods[METHOD_COUNT - 1];

const method *method_named(list_word name);

static inline method_kind method_kind_of(const method *m)
{
    return m == &method_trim3r ? METHOD_TRIM3R : ((const rival_method *)m)->kind;
}

static inline method_way method_way_of(const method *m)
{
    return m == &method_trim3r ? METHOD_PLAIN : ((const rival_method *)m)->way;
}

/* Whether our head makes Gaussians at a rival's points. */
static inline bool method_ranks_for_head(const method *m)
{
    return method_way_of(m) == METHOD_HEAD && method_kind_of(m) != METHOD_TRIM3R;
}

#endif
