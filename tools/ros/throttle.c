/* SPDX-License-Identifier: Apache-2.0 */
#include "ros/throttle.h"

#include <stdio.h>
#include <string.h>

/* Whether two lines are the same except for their numbers, which change from line to line. */
static bool is_alike(const char *a, const char *b)
{
    static const char digits[] = "0123456789";
    for (;; a++, b++) {
        a += strspn(a, digits);
        b += strspn(b, digits);
        if (*a != *b || *a == '\0') {
            return *a == *b;
        }
    }
}

bool throttle_passes(throttle *t, const char *text, int64_t now_ns, uint64_t *more)
{
    if (t->last[0] != '\0' && is_alike(t->last, text) && now_ns - t->last_ns < THROTTLE_INTERVAL_NS) {
        t->held_back++;
        return false;
    }
    *more = t->held_back;
    *t = (throttle){.last_ns = now_ns};
    snprintf(t->last, sizeof t->last, "%s", text);
    return true;
}
