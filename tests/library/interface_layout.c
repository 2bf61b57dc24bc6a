/* SPDX-License-Identifier: Apache-2.0 */
/* The layout of the structs of trim3r.h as constants: a compiler with another layout writes others. */
#include "trim3r.h"

#define TYPE(type) sizeof(type),
#define FIELD(type, field) offsetof(type, field), T3R_FIELD_BYTES_(type, field),

const uint16_t layout[] = {T3R_INTERFACE_TYPES_(TYPE) T3R_INTERFACE_FIELDS_(FIELD)};
