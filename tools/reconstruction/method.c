#include "reconstruction/method.h"

#include <string.h>

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

method_id method_named(const char *text, size_t length)
{
    method_id m = 0;
    while (m < METHOD_COUNT && (strlen(method_name(m)) != length || strncmp(text, method_name(m), length) != 0)) {
        m++;
    }
    return m;
}
