/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/json_output.h"
#include "reconstruction/live/latency.h"
#include "reconstruction/replay/hash_report.h"
#include "reconstruction/replay/stream_run.h"

/* ---- sums over the run ------------------------------------------------------------------------------------------- */

/* Means of scores over the frames that have them; NaN without any. */
typedef struct means {
    uint32_t count, seen_count; /* frames; those of which a keyframe saw anything */
    held_scores of;
} means;

static void add_scores(means *m, const held_scores *scores)
{
    if (isnan(scores->psnr)) {
        return;
    }
    m->count++;
    m->of.psnr += scores->psnr;
    m->of.psnr_all += scores->psnr_all;
    m->of.seen += scores->seen;
    if (!isnan(scores->psnr_seen)) {
        m->seen_count++;
        m->of.psnr_seen += scores->psnr_seen;
    }
}

static means mean_of(const means *sums)
{
    means m = *sums;
    m.of.psnr /= m.count;
    m.of.psnr_all /= m.count;
    m.of.seen /= m.count;
    m.of.psnr_seen /= m.seen_count;
    return m;
}

static void find_means(const stream_run *s, means *live, means *final)
{
    *live = *final = (means){0};
    for (uint32_t i = 0; i < s->is.held_count; i++) {
        if (i < s->is.drawn) {
            add_scores(live, &s->held[i].live);
        }
        add_scores(final, &s->held[i].final);
    }
    *live = mean_of(live);
    *final = mean_of(final);
}

/* The keyframes, their times and passes. */
typedef struct work {
    latency times;
    uint64_t passes, planned;
} work;

static work work_of(const stream_run *s)
{
    work w = {0};
    for (uint32_t i = 0; i < s->is.row_count; i++) {
        const live_row *row = &s->rows[i];
        if (live_row_is_taken(row)) {
            latency_add(&w.times, row->milliseconds);
            w.passes += row->passes;
            w.planned += row->passes_planned;
        }
    }
    return w;
}

static bool is_comparable(const stream_run *s)
{
    return s->options->live.most_ms <= 0;
}

static bool is_hashed(const stream_run *s)
{
    return is_comparable(s) && !s->options->no_hash;
}

/* Returns how many of the first `rows` frames were skipped with this reason. */
static uint32_t count_skipped(const stream_run *s, uint32_t rows, const char *reason)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < rows; i++) {
        count += !live_row_is_taken(&s->rows[i]) && strcmp(live_row_decision(&s->rows[i]), reason) == 0;
    }
    return count;
}

/* Returns the reason of row i if the row is the first that was skipped with it, else NULL. */
static const char *new_reason(const stream_run *s, uint32_t i)
{
    const char *reason = live_row_decision(&s->rows[i]);
    return live_row_is_taken(&s->rows[i]) || count_skipped(s, i, reason) > 0 ? NULL : reason;
}

/* ---- JSON -------------------------------------------------------------------------------------------------------- */

static void add_number(cJSON *object, const char *key, double value)
{
    if (isnan(value) || isinf(value)) {
        cJSON_AddNullToObject(object, key);
    } else {
        cJSON_AddNumberToObject(object, key, value);
    }
}

/* Adds the keyframes, the skipped frames, and the count of each reason. */
static void add_rows(cJSON *root, const stream_run *s)
{
    cJSON *keyframes = cJSON_AddArrayToObject(root, "keyframes"), *skipped = cJSON_AddArrayToObject(root, "skipped");
    cJSON *counts = cJSON_AddObjectToObject(root, "skip_counts");
    for (uint32_t i = 0; i < s->is.row_count; i++) {
        const live_row *row = &s->rows[i];
        cJSON_AddItemToArray(live_row_is_taken(row) ? keyframes : skipped, live_row_json(row));
        const char *reason = new_reason(s, i);
        if (reason != NULL) {
            json_add_integer(counts, reason, count_skipped(s, s->is.row_count, reason));
        }
    }
}

/* Adds the scores of `when`, "live" or "final". */
static void add_scores_json(cJSON *object, const char *when, const held_scores *scores)
{
    const struct {
        const char *key;
        double value;
    } each[] = {{"psnr", scores->psnr},
                {"psnr_seen", scores->psnr_seen},
                {"psnr_all", scores->psnr_all},
                {"seen", scores->seen}};
    for (size_t i = 0; i < sizeof each / sizeof each[0]; i++) {
        char key[32];
        (void)snprintf(key, sizeof key, "%s_%s", when, each[i].key);
        add_number(object, key, each[i].value);
    }
}

static void add_held(cJSON *root, const stream_run *s)
{
    cJSON *list = cJSON_AddArrayToObject(root, "held_back");
    for (uint32_t i = 0; i < s->is.held_count; i++) {
        const held_back *h = &s->held[i];
        cJSON *item = cJSON_CreateObject();
        json_add_integer(item, "frame", h->frame);
        if (i < s->is.drawn) {
            add_scores_json(item, "live", &h->live);
        }
        add_scores_json(item, "final", &h->final);
        cJSON_AddItemToArray(list, item);
    }
    means live, final;
    find_means(s, &live, &final);
    add_scores_json(root, "live", &live.of);
    add_scores_json(root, "final", &final.of);
}

static void add_work(cJSON *root, const stream_run *s)
{
    const work w = work_of(s);
    if (s->resumed) {
        json_add_integer(root, "resumed_at", s->resumed_at);
    }
    cJSON *times = cJSON_AddObjectToObject(root, "keyframe_ms");
    cJSON_AddNumberToObject(times, "median", latency_of_share(&w.times, 50));
    cJSON_AddNumberToObject(times, "most_95", latency_of_share(&w.times, 95));
    cJSON_AddNumberToObject(times, "worst", w.times.worst);
    cJSON_AddNumberToObject(root, "keyframes_per_s", latency_rate(&w.times));
    json_add_integer(root, "passes", (int64_t)w.passes);
    json_add_integer(root, "passes_planned", (int64_t)w.planned);
    if (s->options->rounds > 0) {
        json_add_integer(root, "rounds", s->options->rounds);
        cJSON_AddNumberToObject(root, "rounds_ms", s->rounds_seconds * 1000);
    }
    if (s->options->live.most_ms > 0) {
        cJSON_AddNumberToObject(root, "max_ms", s->options->live.most_ms);
    }
}

void stream_print_json(const stream_run *s, uint64_t hash, const expectation *e, const char *difference)
{
    const reconstruction *r = &s->map.r;
    const live_options *o = &s->map.options;
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "recording", s->path);
    if (o->scene != NULL) {
        cJSON_AddStringToObject(root, "scene", o->scene);
    }
    cJSON_AddNumberToObject(root, "bits_epoch", T3R_BITS_EPOCH);
    json_add_integer(root, "every", o->every);
    json_add_integer(root, "overlap_q8", o->overlap_q8);
    json_add_integer(root, "at_hand", r->config.views);
    json_add_integer(root, "width", r->config.width);
    json_add_integer(root, "height", r->config.height);
    json_add_integer(root, "cap", r->config.gaussians);
    json_add_integer(root, "gaussians", r->scene.count);
    cJSON_AddStringToObject(root, "head", r->head.name);
    if (r->head.weights != NULL) {
        cJSON_AddStringToObject(root, "head_crc", r->head.crc);
    }
    json_add_integer(root, "arena_bytes", (int64_t)r->arena_bytes);
    add_work(root, s);
    add_rows(root, s);
    add_held(root, s);
    cJSON_AddBoolToObject(root, "comparable", is_comparable(s));
    if (is_hashed(s)) {
        hash_report_add_stages(root, r);
        json_add_hash(root, "hash", hash);
    }
    expectation_add(root, e, difference);
    json_print(root);
}

/* ---- text -------------------------------------------------------------------------------------------------------- */

void stream_print_begin(const stream_run *s)
{
    const reconstruction *r = &s->map.r;
    printf("%s: at most %" PRIu32 " Gaussians, head %s, arena %zu bytes\n", s->path, r->config.gaussians, r->head.name,
           r->arena_bytes);
    printf("a keyframe in %" PRIu32 " frames at least, %" PRIu32 " live\n", s->map.options.every, r->config.views);
}

static void print_skipped(const stream_run *s)
{
    bool any = false;
    for (uint32_t i = 0; i < s->is.row_count; i++) {
        const char *reason = new_reason(s, i);
        if (reason != NULL) {
            printf("%s%s %" PRIu32, any ? ", " : "skipped frames: ", reason, count_skipped(s, s->is.row_count, reason));
            any = true;
        }
    }
    printf("%s", any ? "\n" : "");
}

static void print_mean(const char *when, const means *m)
{
    printf("%-30s  %6" PRIu32 "  %10.2f  %7.2f, %3.0f %%  %10.2f\n", when, m->count, m->of.psnr, m->of.psnr_seen,
           100 * m->of.seen, m->of.psnr_all);
}

static void print_means(const stream_run *s)
{
    means live, final;
    find_means(s, &live, &final);
    if (final.count == 0) {
        return;
    }
    printf("held-back frames, PSNR in dB    frames  with depth  seen, of all    everywhere\n");
    if (live.count > 0) {
        print_mean("drawn after the next keyframe", &live);
    }
    print_mean("drawn from the final map", &final);
}

void stream_print(const stream_run *s, uint64_t hash)
{
    const live_options *o = &s->map.options;
    const work w = work_of(s);
    char spread[LATENCY_TEXT_BYTES];
    printf("%s: %" PRIu64 " keyframes of %" PRIu32 " frames, %.1f a second%s\n", s->path, w.times.count, s->is.next,
           latency_rate(&w.times), s->options->no_hash ? " without hashes" : "");
    printf("a keyframe: %s\n", latency_text(&w.times, spread));
    if (s->options->rounds > 0) {
        printf("%" PRIu32 " %s over all keyframes: %.1f s\n", s->options->rounds,
               s->options->rounds == 1 ? "round" : "rounds", s->rounds_seconds);
    }
    print_skipped(s);
    print_means(s);
    if (o->scene != NULL) {
        printf("%s: %" PRIu32 " Gaussians\n", o->scene, s->map.r.scene.count);
    }
    if (!is_comparable(s)) {
        printf("--max-ms %g: %" PRIu64 " of %" PRIu64 " passes; no hashes, as each run gives other bits\n", o->most_ms,
               w.passes, w.planned);
    }
    if (is_hashed(s)) {
        hash_report_print(&s->map.r, hash);
    }
}
