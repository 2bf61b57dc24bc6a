/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/methods.h"

#include "study/rivals/rival.h"

/* Each kind in one way. trim3r chooses an allocation itself; methods with a head of ours are refined. */
#define METHOD(NAME, KIND, WAY)                                                                                        \
    {                                                                                                                  \
        {NAME, (KIND) == METHOD_TRIM3R, (WAY) == METHOD_HEAD, rival_build}, KIND, WAY                                  \
    }
#define RIVALS(SUFFIX, WAY)                                                                                            \
    METHOD("random" SUFFIX, METHOD_RANDOM, WAY), METHOD("eagles" SUFFIX, METHOD_EAGLES, WAY),                          \
        METHOD("lightgaussian" SUFFIX, METHOD_LIGHTGAUSSIAN, WAY), METHOD("pup" SUFFIX, METHOD_PUP, WAY),              \
        METHOD("efficientgs" SUFFIX, METHOD_EFFICIENTGS, WAY)

const rival_method rival_methods[] = {
    RIVALS("", METHOD_PLAIN),
    METHOD("trim3r+finetune", METHOD_TRIM3R, METHOD_FINETUNE),
    RIVALS("+finetune", METHOD_FINETUNE),
    METHOD("trim3r+head", METHOD_TRIM3R, METHOD_HEAD),
    RIVALS("+head", METHOD_HEAD),
};
_Static_assert(sizeof rival_methods / sizeof rival_methods[0] == METHOD_COUNT - 1, "a method is missing");

const method *method_named(list_word name)
{
    const method *found = word_is(name, method_trim3r.name) ? &method_trim3r : NULL;
    for (uint32_t i = 0; i < METHOD_COUNT - 1; i++) {
        found = word_is(name, rival_methods[i].method.name) ? &rival_methods[i].method : found;
    }
    return found;
}
