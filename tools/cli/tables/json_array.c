/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/tables/json_input.h"
#include "host/reason.h"

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
