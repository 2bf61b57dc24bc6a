/* JSON from other programs. */
#ifndef TRIM3R_TOOLS_JSON_INPUT_H
#define TRIM3R_TOOLS_JSON_INPUT_H

#include <stddef.h>

#include <cjson/cJSON.h>

/* Parses a text of at most T3R_LIMIT_JSON_VALUES values, which are counted before memory is allocated for them. Returns
 * NULL with "byte N: what" in error[] on failure; cJSON_Delete() the result. What follows the value is ignored. */
cJSON *json_parse(const char *text, size_t bytes, char *error, size_t error_bytes);

/* Finds the array of that name in an object; NULL if there is no such name. Returns 0, or -1 with a reason in error[].
 * An object instead of an array is refused, since cJSON would iterate over its members. */
int json_array(const cJSON *object, const char *name, const cJSON **array, char *error, size_t error_bytes);

#endif
