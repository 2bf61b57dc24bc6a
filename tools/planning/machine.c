/* SPDX-License-Identifier: Apache-2.0 */
#include "planning/machine.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "cli/files/whole_file.h"
#include "cli/tables/json_input.h"
#include "cli/tables/json_output.h"
#include "host/file_bytes.h"
#include "host/reason.h"

#define FORMAT 1
#define FORMAT_KEY "trim3r_machine"

/* ---- reading ----------------------------------------------------------------------------------------------------- */

/* Reads a whole number in [low, high] of that name. Returns 0, or -1 with the reason. */
static int number_of(const cJSON *object, const char *key, double low, double high, uint32_t *value, char *error,
                     size_t error_bytes)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    const double number = cJSON_IsNumber(item) ? item->valuedouble : -1;
    if (!(number >= low && number <= high) || number != floor(number)) {
        return t3r_reason(error, error_bytes, "\"%s\" must be a whole number %.0f..%.0f", key, low, high);
    }
    *value = (uint32_t)number;
    return 0;
}

static bool is_work(const char *name)
{
    for (int work = 0; work < WORK_KIND_COUNT; work++) {
        if (strcmp(name, work_name((work_kind)work)) == 0) {
            return true;
        }
    }
    return false;
}

static int prices_of(const cJSON *root, work_prices *prices, char *error, size_t error_bytes)
{
    const cJSON *object = cJSON_GetObjectItemCaseSensitive(root, "picoseconds"), *item;
    if (!cJSON_IsObject(object)) {
        return t3r_reason(error, error_bytes, "there is no object \"picoseconds\"");
    }
    cJSON_ArrayForEach(item, object)
    {
        if (!is_work(item->string)) {
            return t3r_reason(error, error_bytes, "\"picoseconds\" has the unknown kind of work \"%.32s\"",
                              item->string);
        }
    }
    for (int work = 0; work < WORK_KIND_COUNT; work++) {
        if (number_of(object, work_name((work_kind)work), 0, UINT32_MAX, &prices->milli[work], error, error_bytes) !=
            0) {
            return -1;
        }
    }
    return 0;
}

static int fill(machine *m, const cJSON *root, char *error, size_t error_bytes)
{
    uint32_t format = 0, epoch = 0;
    const cJSON *cpu = cJSON_GetObjectItemCaseSensitive(root, "cpu_used");
    if (!cJSON_IsObject(root) || cJSON_GetObjectItemCaseSensitive(root, FORMAT_KEY) == NULL) {
        return t3r_reason(error, error_bytes, "not a file of trim3r bench --calibrate");
    }
    if (number_of(root, FORMAT_KEY, FORMAT, FORMAT, &format, error, error_bytes) != 0 ||
        number_of(root, "bits_epoch", 0, UINT32_MAX, &epoch, error, error_bytes) != 0 ||
        number_of(root, "threads", 1, T3R_MAX_WORKERS, &m->threads, error, error_bytes) != 0) {
        return -1;
    }
    if (epoch != T3R_BITS_EPOCH) {
        return t3r_reason(error, error_bytes,
                          "measured with bits epoch %u, and this is %d: run trim3r bench --calibrate again",
                          (unsigned)epoch, T3R_BITS_EPOCH);
    }
    if (!cJSON_IsString(cpu) || strlen(cpu->valuestring) >= sizeof m->cpu) {
        return t3r_reason(error, error_bytes, "\"cpu_used\" must be a text of at most %zu bytes", sizeof m->cpu - 1);
    }
    snprintf(m->cpu, sizeof m->cpu, "%s", cpu->valuestring);
    return prices_of(root, &m->prices, error, error_bytes);
}

int machine_parse(machine *m, const char *text, size_t bytes, char *error, size_t error_bytes)
{
    cJSON *root = json_parse(text, bytes, error, error_bytes);
    const int result = root != NULL ? fill(m, root, error, error_bytes) : -1;
    cJSON_Delete(root);
    return result;
}

int machine_read(machine *m, const char *path, char *error, size_t error_bytes)
{
    size_t bytes;
    char why[256] = "";
    char *text = (char *)t3r_file_bytes(path, MACHINE_MAX_BYTES, &bytes, error, error_bytes);
    if (text == NULL) {
        return -1;
    }
    const int result = machine_parse(m, text, bytes, why, sizeof why);
    if (result != 0) {
        t3r_reason(error, error_bytes, "%s: %s", path, why);
    }
    free(text);
    return result;
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

static char *text_of(const machine *m)
{
    cJSON *root = cJSON_CreateObject();
    json_add_integer(root, FORMAT_KEY, FORMAT);
    json_add_integer(root, "bits_epoch", T3R_BITS_EPOCH);
    json_add_integer(root, "threads", m->threads);
    cJSON_AddStringToObject(root, "cpu_used", m->cpu);
    cJSON *prices = cJSON_AddObjectToObject(root, "picoseconds");
    for (int work = 0; work < WORK_KIND_COUNT; work++) {
        json_add_integer(prices, work_name((work_kind)work), m->prices.milli[work]);
    }
    char *text = cJSON_Print(root);
    cJSON_Delete(root);
    return text;
}

int machine_write(const machine *m, const char *path, char *error, size_t error_bytes)
{
    t3r_whole_file file;
    char *text = text_of(m);
    if (text == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    int result = whole_file_begin(&file, path, error, error_bytes);
    if (result == 0) {
        fprintf(file.stream, "%s\n", text);
        result = t3r_whole_file_commit(&file, NULL, error, error_bytes);
    }
    free(text);
    return result;
}
