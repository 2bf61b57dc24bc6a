/* SPDX-License-Identifier: Apache-2.0 */
/* The JSON of float heads. */
#ifndef T3R_QUANT_JSON_OBJECT_H
#define T3R_QUANT_JSON_OBJECT_H

#include <stddef.h>

#include <cjson/cJSON.h>

/* Parses a text that is one JSON object; white space may follow. `where` names it in reasons. Refuses \u0000, which
 * would end a string early, and names that stand twice in an object. Returns NULL with the reason in error[];
 * cJSON_Delete() the result. */
cJSON *json_object_parse(const char *where, const char *text, size_t bytes, char *error, size_t error_bytes);

#endif
