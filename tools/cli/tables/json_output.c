/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/tables/json_output.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void hash_text(uint64_t hash, char text[HASH_TEXT_BYTES])
{
    snprintf(text, HASH_TEXT_BYTES, "%016" PRIx64, hash);
}

int hash_parse(const char *text, uint64_t *hash)
{
    if (strncmp(text, "0x", 2) == 0) {
        text += 2;
    }
    if (strlen(text) != 16 || strspn(text, "0123456789abcdefABCDEF") != 16) {
        return -1;
    }
    *hash = strtoull(text, NULL, 16);
    return 0;
}

void json_add_hash(cJSON *object, const char *key, uint64_t hash)
{
    char text[HASH_TEXT_BYTES];
    hash_text(hash, text);
    cJSON_AddStringToObject(object, key, text);
}

void json_add_integer(cJSON *object, const char *key, int64_t value)
{
    char text[24];
    snprintf(text, sizeof text, "%" PRId64, value);
    cJSON_AddRawToObject(object, key, text);
}

void json_add_integers(cJSON *object, const char *key, const uint32_t *values, uint32_t count)
{
    cJSON *list = cJSON_AddArrayToObject(object, key);
    for (uint32_t i = 0; i < count; i++) {
        cJSON_AddItemToArray(list, cJSON_CreateNumber(values[i]));
    }
}

void json_print(cJSON *object)
{
    char *text = cJSON_PrintUnformatted(object);
    if (text != NULL) {
        puts(text);
        cJSON_free(text);
    }
    cJSON_Delete(object);
}
