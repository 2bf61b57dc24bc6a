/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/tables/json_output.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"

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

static bool ran_out;

static void *watched_malloc(size_t bytes)
{
    void *memory = malloc(bytes);
    ran_out = ran_out || memory == NULL;
    return memory;
}

void json_watch_memory(void)
{
    ran_out = false;
    cJSON_InitHooks(&(cJSON_Hooks){watched_malloc, free});
}

char *json_text(cJSON *object)
{
    char *text = object == NULL ? NULL : cJSON_PrintUnformatted(object);
    cJSON_Delete(object);
    if (ran_out) {
        free(text);
        return NULL;
    }
    return text;
}

void json_print(cJSON *object)
{
    char *text = json_text(object);
    if (text == NULL) {
        exit(cli_error(CLI_BAD_INPUT, "out of memory for the JSON"));
    }
    puts(text);
    free(text);
}
