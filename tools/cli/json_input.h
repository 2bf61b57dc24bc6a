/* JSON of others. */
#ifndef TRIM3R_TOOLS_JSON_INPUT_H
#define TRIM3R_TOOLS_JSON_INPUT_H

#include <stddef.h>

#include <cjson/cJSON.h>

/* Parses a text of at most T3R_LIMIT_JSON_VALUES values, counted before any memory is asked for them. NULL with "byte
 * N: what" in error[]; cJSON_Delete() the rest. What stands behind the value is not looked at. */
cJSON *json_parse(const char *text, size_t bytes, char *error, size_t error_bytes);

#endif
