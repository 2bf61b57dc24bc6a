/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/poses_source.h"

#include <string.h>

#define NAME_COUNT 3

static const char *const names_of[NAME_COUNT] = {"given", "estimate", "estimate-colour"};

bool poses_named(const char *name, poses_source *source)
{
    for (int i = 0; i < NAME_COUNT; i++) {
        if (strcmp(name, names_of[i]) == 0) {
            *source = (poses_source)i;
            return true;
        }
    }
    return false;
}

const char *poses_name(poses_source source)
{
    return names_of[source];
}
