#include "reconstruction/method.h"

const char *method_name(method_id m)
{
    static const char *const names[METHOD_COUNT] = {"trim3r",
                                                    "random",
                                                    "eagles",
                                                    "lightgaussian",
                                                    "pup",
                                                    "efficientgs",
                                                    "trim3r+finetune",
                                                    "random+finetune",
                                                    "eagles+finetune",
                                                    "lightgaussian+finetune",
                                                    "pup+finetune",
                                                    "efficientgs+finetune",
                                                    "trim3r+head",
                                                    "random+head",
                                                    "eagles+head",
                                                    "lightgaussian+head",
                                                    "pup+head",
                                                    "efficientgs+head"};
    return names[m];
}

method_id method_named(list_word name)
{
    method_id m = 0;
    while (m < METHOD_COUNT && !word_is(name, method_name(m))) {
        m++;
    }
    return m;
}
