#include "study/evaluation/settings.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "core/hash.h"

/* A list with something between its items. */
typedef struct words {
    char *text;
    size_t length;
    char separator;
    bool leading; /* the separator stands before the first too */
} words;

static void add(words *w, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* What does not fit is cut off: the longest that there can be is half of it. */
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

static void add_switch(words *w, const char *name, uint32_t value, uint32_t usual)
{
    if (value != usual) {
        add(w, "%s-%s", name, value != 0 ? "on" : "off");
    }
}

static void add_number(words *w, const char *name, uint32_t value, uint32_t usual)
{
    if (value != usual) {
        add(w, "%s-%" PRIu32, name, value);
    }
}

/* A file's path is told by its hash: a name that fits among others. */
static void add_text(words *w, const char *name, const char *text, bool whole)
{
    uint64_t hash = t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)text, strlen(text));
    if (whole) {
        add(w, "%s-%s", name, text);
    } else {
        add(w, "%s-%08" PRIx32, name, (uint32_t)hash);
    }
}

static void add_rest(words *w, const reconstruction_options *s, const reconstruction_options *usual)
{
    if (s->automatic) {
        add(w, "max-loss-%.4g", s->max_loss);
    }
    if (s->gamma_q8 != usual->gamma_q8) {
        add(w, "gamma-%.4g", s->gamma_q8 / 256.0);
    }
    add_number(w, "keep-percent", s->paper_keep_percent, usual->paper_keep_percent);
    add_number(w, "fill-radius", s->fill_radius, usual->fill_radius);
    add_number(w, "bridge-radius", s->bridge_radius, usual->bridge_radius);
    add_switch(w, "flying", s->flying, usual->flying);
    add_switch(w, "redundancy", s->redundancy, usual->redundancy);
    add_switch(w, "exposure", s->exposure, usual->exposure);
    add_number(w, "views", s->context_views, usual->context_views);
    add_number(w, "seed", s->seed, usual->seed);
    if (s->points_of != NULL) {
        add_text(w, "prune", s->points_of, false);
    }
    if (s->importance != NULL) {
        add_text(w, "importance", s->importance, false);
    }
    if (s->mask_head != NULL) {
        add_text(w, "mask-head", s->mask_head, strchr(s->mask_head, '.') == NULL);
    }
    if (s->width != usual->width || s->height != usual->height) {
        add(w, "working-%" PRIu32 "x%" PRIu32, s->width, s->height);
    }
    add_number(w, "iterations", s->finetune_iterations, usual->finetune_iterations);
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
    add_number(&w, "refine", s->refine, usual.refine);
    if (s->allocation != usual.allocation) {
        add(&w, "%s", t3r_allocation_name(s->allocation));
    }
    if (s->depth != usual.depth) {
        add(&w, "%s", t3r_depth_name(s->depth));
    }
    if (s->wavelet != usual.wavelet) {
        add(&w, "%s", t3r_wavelet_name(s->wavelet));
    }
    add_number(&w, "levels", s->wavelet_levels, usual.wavelet_levels);
    add_number(&w, "k", s->clusters, usual.clusters);
    add_rest(&w, s, &usual);
    return code;
}
