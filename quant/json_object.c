/* SPDX-License-Identifier: Apache-2.0 */
#include "json_object.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "quant_reason.h"

/* Whether a string has a \u0000. Backslashes stand in strings alone. */
static bool has_zero(const char *text, size_t bytes)
{
    for (size_t i = 0; i + 5 < bytes; i++) {
        if (text[i] == '\\') {
            if (memcmp(text + i, "\\u0000", 6) == 0) {
                return true;
            }
            i++;
        }
    }
    return false;
}

static int by_name(const void *left, const void *right)
{
    return strcmp(*(const char *const *)left, *(const char *const *)right);
}

/* Checks that the names of an object differ. */
static int check_names(const char *where, const cJSON *object, char *error, size_t error_bytes)
{
    size_t count = (size_t)cJSON_GetArraySize(object), i = 0;
    const char **names = malloc((count + 1) * sizeof *names);
    if (names == NULL) {
        return quant_reason(error, error_bytes, "out of memory");
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, object)
    {
        names[i++] = item->string;
    }
    qsort(names, count, sizeof *names, by_name);
    int status = 0;
    for (i = 1; i < count && status == 0; i++) {
        if (strcmp(names[i - 1], names[i]) == 0) {
            status = quant_reason(error, error_bytes, "%s: '%.64s' stands there twice", where, names[i]);
        }
    }
    free(names);
    return status;
}

/* The same of all objects within; cJSON bounds their depth. NOLINTNEXTLINE(misc-no-recursion) */
static int check_all_names(const char *where, const cJSON *item, char *error, size_t error_bytes)
{
    const cJSON *each;
    if (cJSON_IsObject(item) && check_names(where, item, error, error_bytes) != 0) {
        return -1;
    }
    cJSON_ArrayForEach(each, item)
    {
        if (each->child != NULL &&
            check_all_names(each->string != NULL ? each->string : where, each, error, error_bytes) != 0) {
            return -1;
        }
    }
    return 0;
}

cJSON *json_object_parse(const char *where, const char *text, size_t bytes, char *error, size_t error_bytes)
{
    const char *end = NULL;
    cJSON *root = cJSON_ParseWithLengthOpts(text, bytes, &end, 0);
    while (root != NULL && end < text + bytes && *end != '\0' && strchr(" \t\r\n", *end) != NULL) {
        end++;
    }
    if (!cJSON_IsObject(root) || end != text + bytes) {
        (void)quant_reason(error, error_bytes, "%s: not one JSON object", where);
    } else if (has_zero(text, bytes)) {
        (void)quant_reason(error, error_bytes, "%s: \\u0000 in a string", where);
    } else if (check_all_names(where, root, error, error_bytes) == 0) {
        return root;
    }
    cJSON_Delete(root);
    return NULL;
}
