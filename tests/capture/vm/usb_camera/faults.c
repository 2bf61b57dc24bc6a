/* SPDX-License-Identifier: Apache-2.0 */
#include "faults.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

int faults_add(faults *self, const char *text)
{
    static const char *const names[] = {
        [FAULT_ERROR] = "error",   [FAULT_CUT] = "cut",     [FAULT_STALL] = "stall",
        [FAULT_UNPLUG] = "unplug", [FAULT_LEAVE] = "leave",
    };
    planned_fault added = {0};
    char name[8] = "";
    if (self->count == FAULTS_MOST ||
        sscanf(text, "%" SCNu32 ".%" SCNu32 "=%7s", &added.stream, &added.frame, name) != 3) {
        return -1;
    }
    for (fault_kind kind = FAULT_ERROR; kind <= FAULT_LEAVE; kind++) {
        if (strcmp(names[kind], name) == 0) {
            added.kind = kind;
            self->list[self->count++] = added;
            return 0;
        }
    }
    return -1;
}

fault_kind faults_at(const faults *self, uint32_t stream, uint32_t frame)
{
    for (uint32_t i = 0; i < self->count; i++) {
        if (self->list[i].stream == stream && self->list[i].frame == frame) {
            return self->list[i].kind;
        }
    }
    return FAULT_NONE;
}
