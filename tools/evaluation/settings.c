/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/settings.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "core/hash.h"
#include "reconstruction/options/settings.h"

/* A list with a separator between its items. */
typedef struct words {
    char *text;
    size_t length;
    char separator;
    bool leading; /* a separator also precedes the first */
} words;

static void add(words *w, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Appends, and truncates what does not fit; the longest list needs half of the room. */
static void add(words *w, const char *format, ...)
{
    if ((w->length > 0 || w->leading) && w->length + 1 < EVALUATION_SETTINGS_BYTES) {
        w->text[w->length++] = w->separator;
        w->text[w->length] = '\0';
    }
    va_list arguments;
    va_start(arguments, format);
    int count = vsnprintf(w->text + w->length, EVALUATION_SETTINGS_BYTES - w->length, format, arguments);
    va_end(arguments);
    w->length += count > 0 ? (size_t)count : 0;
    w->length = w->length < EVALUATION_SETTINGS_BYTES ? w->length : EVALUATION_SETTINGS_BYTES - 1;
}

static void add_number(words *w, const char *name, uint32_t value, uint32_t usual)
{
    if (value != usual) {
        add(w, "%s-%" PRIu32, name, value);
    }
}

/* Appends a file's path as its hash, to keep the name short. */
static void add_text(words *w, const char *name, const char *text, bool whole)
{
    uint64_t hash = t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)text, strlen(text));
    if (whole) {
        add(w, "%s-%s", name, text);
    } else {
        add(w, "%s-%08" PRIx32, name, (uint32_t)hash);
    }
}

/* Whether rows have a column of their own for it. */
static bool has_column(const setting *s)
{
    static const char *const columns[] = {"refine", "allocate", "depth", "wavelet", "levels", "clusters"};
    bool found = false;
    for (size_t i = 0; i < sizeof columns / sizeof columns[0]; i++) {
        found = found || strcmp(s->option, columns[i]) == 0;
    }
    return found;
}

/* Adds the settings of the runtime that are not the default: those with a column of their own, or the others. Values
 * of an enumeration have no name of their setting. */
static void add_settings(words *w, bool columns, const t3r_config *config, const t3r_config *usual)
{
    for (uint32_t i = 0; i < settings_count; i++) {
        const setting *s = &settings_table[i];
        if (has_column(s) == columns && setting_value(s, config) != setting_value(s, usual)) {
            char value[32];
            setting_text(s, config, value, sizeof value);
            const bool named = s->kind == SETTING_name;
            add(w, "%s%s%s", named ? "" : s->option, named ? "" : "-", value);
        }
    }
}

static void add_rest(words *w, const reconstruction_options *s, const reconstruction_options *usual)
{
    if (s->automatic) {
        add(w, "max-loss-%.4g", s->max_loss);
    }
    if (s->min_psnr > 0) {
        add(w, "min-psnr-%.4g", s->min_psnr);
    }
    add_settings(w, false, &s->config, &usual->config);
    add_number(w, "views", s->context_views, usual->context_views);
    if (s->poses != POSES_GIVEN) {
        add(w, "poses-%s", poses_name(s->poses));
    }
    if (s->points_of != NULL) {
        add_text(w, "prune", s->points_of, false);
    }
    if (s->scene != NULL) {
        add_text(w, "file", s->scene, false);
    }
    if (s->importance != NULL) {
        add_text(w, "importance", s->importance, false);
    }
    if (s->mask_head != NULL) {
        add_text(w, "mask-head", s->mask_head, strchr(s->mask_head, '.') == NULL);
    }
    if (s->config.width != 0) {
        add(w, "working-%" PRIu32 "x%" PRIu32, s->config.width, s->config.height);
    }
    add_number(w, "iterations", s->finetune.iterations, usual->finetune.iterations);
    add_number(w, "rounds", s->finetune.rounds, usual->finetune.rounds);
    if (s->finetune.pruned_widths) {
        add(w, "pruned-widths");
    }
    if (s->finetune.published_rates) {
        add(w, "published-rates");
    }
    if (s->arena == ARENA_MIN) {
        add(w, "arena-min");
    } else if (s->arena == ARENA_BYTES) {
        add(w, "arena-%" PRIu64, s->arena_bytes);
    }
}

void evaluation_settings_rest(const reconstruction_options *settings, char text[EVALUATION_SETTINGS_BYTES])
{
    reconstruction_options usual;
    reconstruction_defaults(&usual);
    words w = {.text = text, .separator = ' '};
    add_rest(&w, settings, &usual);
    if (w.length == 0) {
        add(&w, "default");
    }
}

static int add_head(words *w, const char *text)
{
    chosen_head head;
    int code = chosen_head_open(&head, text);
    if (code == CLI_OK) {
        bool whole = head.weights == NULL || strcmp(head.bits, "8") == 0;
        add(w, "%s", head.name);
        if (!whole) {
            add(w, "w%ua%u", head.weight_bits, head.activation_bits);
        }
        chosen_head_close(&head);
    }
    return code;
}

int evaluation_settings_suffix(const reconstruction_options *settings, bool named, char text[EVALUATION_SETTINGS_BYTES])
{
    const reconstruction_options *s = settings;
    reconstruction_options usual;
    reconstruction_defaults(&usual);
    words w = {.text = text, .separator = '_', .leading = true};
    text[0] = '\0';
    int code = named && strcmp(s->head, CHOSEN_HEAD_DEFAULT) != 0 ? add_head(&w, s->head) : CLI_OK;
    add_settings(&w, true, &s->config, &usual.config);
    add_rest(&w, s, &usual);
    return code;
}
