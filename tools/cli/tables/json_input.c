#include "cli/tables/json_input.h"

#include <stdbool.h>
#include <stdint.h>

#include "mcap/reader_limits.h"
#include "host/reason.h"

/* Bounds the number of values: a value begins the text, or follows a bracket, a brace or a comma outside strings. */
static size_t most_values(const char *text, size_t bytes)
{
    size_t values = 1;
    bool quoted = false;
    for (size_t i = 0; i < bytes; i++) {
        if (text[i] == '"') {
            quoted = !quoted;
        } else if (quoted) {
            i += text[i] == '\\';
        } else {
            values += text[i] == '[' || text[i] == '{' || text[i] == ',';
        }
    }
    return values;
}

cJSON *json_parse(const char *text, size_t bytes, char *error, size_t error_bytes)
{
    if (most_values(text, bytes) > T3R_LIMIT_JSON_VALUES) {
        t3r_reason(error, error_bytes, "byte 0: JSON of more than %d values", T3R_LIMIT_JSON_VALUES);
        return NULL;
    }
    const char *end = NULL;
    cJSON *root = cJSON_ParseWithLengthOpts(text, bytes, &end, 0);
    if (root == NULL) {
        t3r_reason(error, error_bytes, "byte %zu: not JSON (NaN and Infinity are not either)",
                   end == NULL ? 0 : (size_t)(end - text));
    }
    return root;
}

int json_array(const cJSON *object, const char *name, const cJSON **array, char *error, size_t error_bytes)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    *array = NULL;
    if (item != NULL && !cJSON_IsArray(item)) {
        return t3r_reason(error, error_bytes, "%s: not an array", name);
    }
    *array = item;
    return 0;
}
