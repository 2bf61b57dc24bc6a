/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/chosen_head.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "head/weights.h"
#include "hidden_mask.h"
#include "host/file_bytes.h"
#include "trim3r_heads.h"
#include "weight_file.h"

#define FILE_END ".t3w"

static const struct {
    const char *name;
    const uint8_t *weights;
    const uint32_t *bytes;
} shipped[] = {
    {"tiny", t3r_head_tiny, &t3r_head_tiny_bytes},
    {"small", t3r_head_small, &t3r_head_small_bytes},
};
enum { SHIPPED = sizeof shipped / sizeof shipped[0] };

/* Whether the text is a name of the head without weights; `none` leaves it unadapted. */
static bool is_analytic(const char *text)
{
    return strcmp(text, "analytic") == 0 || strcmp(text, "none") == 0;
}

static int shipped_index(const char *text)
{
    for (int i = 0; i < SHIPPED; i++) {
        if (strcmp(text, shipped[i].name) == 0) {
            return i;
        }
    }
    return -1;
}

bool chosen_head_is_one(const char *text)
{
    size_t length = strlen(text), end = sizeof FILE_END - 1;
    return is_analytic(text) || shipped_index(text) >= 0 ||
           (length > end && strcmp(text + length - end, FILE_END) == 0);
}

/* Replaces the weights by the bytes, aligned; frees the bytes. */
static int own(chosen_head *chosen, uint8_t *bytes, size_t count)
{
    void *aligned;
    if (posix_memalign(&aligned, T3R_WEIGHTS_ALIGN, count + 1) != 0) {
        free(bytes);
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    memcpy(aligned, bytes, count);
    free(bytes);
    free(chosen->owned);
    chosen->weights = chosen->owned = aligned;
    chosen->bytes = count;
    return CLI_OK;
}

static int read_file(chosen_head *chosen, const char *path)
{
    char error[512] = "";
    size_t count;
    uint8_t *bytes = t3r_file_bytes(path, T3R_MAX_WEIGHTS_BYTES, &count, error, sizeof error);
    return bytes == NULL ? cli_error(CLI_BAD_INPUT, "%s", error) : own(chosen, bytes, count);
}

static int describe(chosen_head *chosen, const char *text)
{
    const char *error = t3r_weights_error(chosen->weights, chosen->bytes);
    if (error != NULL) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", text, error);
    }
    t3r_weights_header header = t3r_weights_header_of(chosen->weights);
    snprintf(chosen->crc, sizeof chosen->crc, "%08" PRIx32, header.crc);
    chosen->weight_bits = header.weight_bits;
    chosen->activation_bits = header.activation_bits;
    memcpy(chosen->name, (const char *)chosen->weights + WEIGHT_AT_NAME, sizeof chosen->name);
    bool one_width = header.weight_bits == header.activation_bits;
    snprintf(chosen->bits, sizeof chosen->bits, one_width ? "%u" : "%u/%u", (unsigned)header.weight_bits,
             (unsigned)header.activation_bits);
    return CLI_OK;
}

int chosen_head_open(chosen_head *chosen, const char *text)
{
    if (is_analytic(text)) {
        *chosen = (chosen_head){.head = T3R_HEAD_ANALYTIC, .unadapted = strcmp(text, "none") == 0};
        snprintf(chosen->name, sizeof chosen->name, "%s", text);
        return CLI_OK;
    }
    *chosen = (chosen_head){.head = T3R_HEAD_LEARNED};
    int at = shipped_index(text), code = CLI_OK;
    if (at >= 0) {
        chosen->weights = shipped[at].weights;
        chosen->bytes = *shipped[at].bytes;
    } else {
        code = read_file(chosen, text);
    }
    if (code == CLI_OK) {
        code = describe(chosen, text);
    }
    if (code != CLI_OK) {
        chosen_head_close(chosen);
    }
    return code;
}

int chosen_head_hide_mask(chosen_head *chosen)
{
    if (chosen->weights == NULL) {
        return CLI_OK;
    }
    size_t count;
    uint8_t *bytes = hidden_mask_make(chosen->weights, &count);
    int code = bytes == NULL ? cli_error(CLI_BAD_INPUT, "out of memory") : own(chosen, bytes, count);
    return code == CLI_OK ? describe(chosen, chosen->name) : code;
}

void chosen_head_close(chosen_head *chosen)
{
    free(chosen->owned);
    *chosen = (chosen_head){0};
}

void chosen_head_configure(const chosen_head *chosen, t3r_config *config)
{
    config->head = chosen->head;
    config->head_column_bytes =
        chosen->weights == NULL ? 0 : t3r_head_column_bytes(chosen->weights, chosen->bytes, config->width);
}

t3r_status chosen_head_bind(const chosen_head *chosen, t3r_runtime *runtime, t3r_ablation ablation)
{
    ablation.unadapted |= chosen->unadapted;
    t3r_status status = t3r_set_ablation(runtime, &ablation);
    return status == T3R_OK && chosen->weights != NULL ? t3r_bind_head(runtime, chosen->weights, chosen->bytes)
                                                       : status;
}
