/* SPDX-License-Identifier: Apache-2.0 */
/* The part of cJSON that readers of scene files use, for values that the browser's parser read (files_json.js). */
#ifndef TRIM3R_TOOLS_FILES_CJSON_H
#define TRIM3R_TOOLS_FILES_CJSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Values of cJSON.type. */
enum { CJSON_FALSE, CJSON_TRUE, CJSON_NULL, CJSON_NUMBER, CJSON_STRING, CJSON_ARRAY, CJSON_OBJECT };

typedef struct cJSON {
    struct cJSON *next, *child;
    int32_t type;
    char *valuestring; /* NULL unless it is a string */
    double valuedouble;
    char *string; /* its name in an object */
} cJSON;
_Static_assert(sizeof(cJSON) == 32 && offsetof(cJSON, string) == 24, "files_json.js writes it");

#define cJSON_ArrayForEach(each, array)                                                                                \
    for ((each) = (array) != NULL ? (array)->child : NULL; (each) != NULL; (each) = (each)->next)

bool cJSON_IsTrue(const cJSON *item);
bool cJSON_IsNumber(const cJSON *item);
bool cJSON_IsString(const cJSON *item);
bool cJSON_IsArray(const cJSON *item);
int cJSON_GetArraySize(const cJSON *array);
cJSON *cJSON_GetArrayItem(const cJSON *array, int index);
cJSON *cJSON_GetObjectItemCaseSensitive(const cJSON *object, const char *name);
void cJSON_Delete(cJSON *root);

#endif
