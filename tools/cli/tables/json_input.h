/* SPDX-License-Identifier: Apache-2.0 */
/* JSON from other programs. */
#ifndef TRIM3R_TOOLS_JSON_INPUT_H
#define TRIM3R_TOOLS_JSON_INPUT_H

#include <stddef.h>

#include <cjson/cJSON.h>

/* Parses a text of at most T3R_LIMIT_JSON_VALUES values, which are counted before memory is allocated for them. Returns
 * NULL with "byte N: what" in error[] on failure; cJSON_Delete() the result. Text after the value, a name
 * twice in one object, and \u0000 in a string are refused: programs read them differently. */
cJSON *json_parse(const char *text, size_t bytes, char *error, size_t error_bytes);

/* Does the same, but takes NaN, Infinity and -Infinity, which Python writes, as empty texts: what needs a number there
 * can be left out. */
cJSON *json_parse_python(const char *text, size_t bytes, char *error, size_t error_bytes);

/* Finds the array of that name in an object; NULL if there is no such name. Returns 0, or -1 with a reason in error[].
 * An object instead of an array is refused, since cJSON would iterate over its members. */
int json_array(const cJSON *object, const char *name, const cJSON **array, char *error, size_t error_bytes);

#endif
