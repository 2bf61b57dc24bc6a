/* JSON of others. */
#ifndef TRIM3R_TOOLS_JSON_INPUT_H
#define TRIM3R_TOOLS_JSON_INPUT_H

#include <stddef.h>

#include <cjson/cJSON.h>

/* Parses a text of at most T3R_LIMIT_JSON_VALUES values, counted before any memory is asked for them. NULL with "byte
 * N: what" in error[]; cJSON_Delete() the rest. What stands behind the value is not looked at. */
cJSON *json_parse(const char *text, size_t bytes, char *error, size_t error_bytes);

/* The array of that name in an object, NULL where there is nothing of that name: 0, or -1 with a reason in error[].
 * An object in its place is refused, as cJSON walks its members like an array's. */
int json_array(const cJSON *object, const char *name, const cJSON **array, char *error, size_t error_bytes);

#endif
