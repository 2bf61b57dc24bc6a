/* SPDX-License-Identifier: Apache-2.0 */
#include <stdlib.h>
#include <string.h>

#include "cli/tables/json_input.h"
#include "host/reason.h"

/* Returns the value of a text, in one piece of memory; NULL: the text is not JSON. */
__attribute__((import_module("page"), import_name("json"))) extern cJSON *page_json(const char *text, uint32_t bytes);

cJSON *json_parse(const char *text, size_t bytes, char *error, size_t error_bytes)
{
    cJSON *root = page_json(text, (uint32_t)bytes);
    if (root == NULL) {
        t3r_reason(error, error_bytes, "byte 0: not JSON");
    }
    return root;
}

static bool is_a(const cJSON *item, int32_t type)
{
    return item != NULL && item->type == type;
}

bool cJSON_IsTrue(const cJSON *item)
{
    return is_a(item, CJSON_TRUE);
}

bool cJSON_IsNumber(const cJSON *item)
{
    return is_a(item, CJSON_NUMBER);
}

bool cJSON_IsString(const cJSON *item)
{
    return is_a(item, CJSON_STRING);
}

bool cJSON_IsArray(const cJSON *item)
{
    return is_a(item, CJSON_ARRAY);
}

int cJSON_GetArraySize(const cJSON *array)
{
    int size = 0;
    const cJSON *each;
    cJSON_ArrayForEach(each, array)
    {
        size++;
    }
    return size;
}

cJSON *cJSON_GetArrayItem(const cJSON *array, int index)
{
    cJSON *each;
    cJSON_ArrayForEach(each, array)
    {
        if (index-- == 0) {
            return each;
        }
    }
    return NULL;
}

cJSON *cJSON_GetObjectItemCaseSensitive(const cJSON *object, const char *name)
{
    cJSON *each;
    cJSON_ArrayForEach(each, object)
    {
        if (each->string != NULL && strcmp(each->string, name) == 0) {
            return each;
        }
    }
    return NULL;
}

void cJSON_Delete(cJSON *root)
{
    free(root);
}
