/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/tables/json_input.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "host/reason.h"
#include "mcap/reader_limits.h"

/* Bounds the number of values: a value begins the text, or follows a bracket, a brace or a comma outside strings. *zero
 * receives the place of a \u0000 in a string, which would end it; SIZE_MAX: there is none. */
static size_t most_values(const char *text, size_t bytes, size_t *zero)
{
    size_t values = 1;
    bool quoted = false;
    *zero = SIZE_MAX;
    for (size_t i = 0; i < bytes; i++) {
        if (text[i] == '"') {
            quoted = !quoted;
        } else if (quoted) {
            *zero = bytes - i > 5 && memcmp(text + i, "\\u0000", 6) == 0 ? i : *zero;
            i += text[i] == '\\';
        } else {
            values += text[i] == '[' || text[i] == '{' || text[i] == ',';
        }
    }
    return values;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Returns a name that an object has twice; NULL: none, or no memory to look. */
static const char *name_given_twice(const cJSON *object)
{
    const cJSON *each;
    size_t count = 0;
    const char **names = malloc(((size_t)cJSON_GetArraySize(object) + 1) * sizeof *names), *twice = NULL;
    cJSON_ArrayForEach(each, object)
    {
        if (names != NULL) {
            names[count++] = each->string;
        }
    }
    if (count > 1) {
        qsort(names, count, sizeof *names, compare_names);
    }
    for (size_t i = 1; i < count && twice == NULL; i++) {
        twice = strcmp(names[i - 1], names[i]) == 0 ? names[i] : NULL;
    }
    free(names);
    return twice;
}

/* Looks for such a name in all objects; cJSON bounds the depth of the text. */
static const char *find_twice(const cJSON *item)
{
    const char *twice = cJSON_IsObject(item) ? name_given_twice(item) : NULL;
    const cJSON *each;
    cJSON_ArrayForEach(each, item)
    {
        if (twice == NULL && each->child != NULL) {
            twice = find_twice(each);
        }
    }
    return twice;
}

cJSON *json_parse(const char *text, size_t bytes, char *error, size_t error_bytes)
{
    size_t zero;
    if (most_values(text, bytes, &zero) > T3R_LIMIT_JSON_VALUES) {
        t3r_reason(error, error_bytes, "byte 0: JSON of more than %d values", T3R_LIMIT_JSON_VALUES);
        return NULL;
    }
    if (zero != SIZE_MAX) {
        t3r_reason(error, error_bytes, "byte %zu: \\u0000 in a string", zero);
        return NULL;
    }
    const char *end = NULL;
    cJSON *root = cJSON_ParseWithLengthOpts(text, bytes, &end, 0);
    size_t at = end == NULL ? 0 : (size_t)(end - text);
    if (root == NULL) {
        t3r_reason(error, error_bytes, "byte %zu: not JSON (NaN and Infinity are not either)", at);
        return NULL;
    }
    while (at < bytes && (text[at] == '\0' || strchr(" \t\r\n", text[at]) != NULL)) { /* .glb files are padded */
        at++;
    }
    const char *twice = find_twice(root);
    if (at < bytes || twice != NULL) {
        if (at < bytes) {
            t3r_reason(error, error_bytes, "byte %zu: more follows the JSON", at);
        } else {
            t3r_reason(error, error_bytes, "the name %.60s stands twice in one object", twice);
        }
        cJSON_Delete(root);
        return NULL;
    }
    return root;
}

/* Returns the length of a number of Python's json at the front that JSON has not; 0: there is none. */
static size_t number_of_python(const char *text, size_t bytes)
{
    static const char *const names[] = {"NaN", "Infinity", "-Infinity"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const size_t length = strlen(names[i]);
        if (length <= bytes && memcmp(text, names[i], length) == 0) {
            return length;
        }
    }
    return 0;
}

cJSON *json_parse_python(const char *text, size_t bytes, char *error, size_t error_bytes)
{
    char *copy = malloc(bytes + 1);
    bool quoted = false;
    if (copy == NULL) {
        t3r_reason(error, error_bytes, "out of memory");
        return NULL;
    }
    memcpy(copy, text, bytes);
    for (size_t i = 0; i < bytes; i++) {
        const size_t number = quoted ? 0 : number_of_python(text + i, bytes - i);
        if (number > 0) {
            memset(copy + i, ' ', number);
            memset(copy + i, '"', 2);
            i += number - 1;
        } else if (text[i] == '"') {
            quoted = !quoted;
        } else if (quoted && text[i] == '\\') {
            i++;
        }
    }
    cJSON *root = json_parse(copy, bytes, error, error_bytes);
    free(copy);
    return root;
}
