/* SPDX-License-Identifier: Apache-2.0 */
#include "bench/bench_against.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/spread.h"
#include "cli/cli.h"
#include "cli/jobs/other_program.h"
#include "cli/tables/json_input.h"
#include "cli/tables/json_output.h"
#include "host/file_bytes.h"

#define ERROR_BYTES 512
#define LIST_BYTES 1024
#define HELP_SECONDS 10.0
#define TURN_SECONDS 600.0
#define THIS "/proc/self/exe"

/* State of a contest between the two programs. */
typedef struct contest_state {
    const bench_contest *contest;
    bool has_stages;                /* the other program takes --stages */
    bool shared[BENCH_STAGES_MOST]; /* of bench_stages: the other program has it */
    char list[LIST_BYTES];          /* the shared ones, for --stages */
    char this_alone[LIST_BYTES], other_alone[LIST_BYTES];
    double figure[2][BENCH_STAGES_MOST][BENCH_TURNS_MOST]; /* this program's, the other program's */
} contest_state;

static void add_word(char list[LIST_BYTES], const char *word)
{
    const size_t length = strlen(list);
    snprintf(list + length, LIST_BYTES - length, "%s%s", length > 0 ? "," : "", word);
}

/* ---- one run --------------------------------------------------------------------------------------------------- */

/* Returns the object that `bench --json` of that program prints; NULL after a message. If `allowed`, refused options
 * give no message. */
static cJSON *run_bench(const contest_state *s, const char *program, const char *stages, bool allowed)
{
    char list[LIST_BYTES + 16], error[ERROR_BYTES] = "";
    const char *arguments[BENCH_PASSED_MOST + 8] = {"trim3r", "bench", "--json", "--runs=1"};
    uint32_t count = 4;
    for (uint32_t i = 0; i < s->contest->passed_count; i++) {
        arguments[count++] = s->contest->passed[i];
    }
    if (stages != NULL) {
        snprintf(list, sizeof list, "--stages=%s", stages);
        arguments[count++] = list;
    }
    char *text;
    const int status =
        other_program_run(program, (char *const *)(uintptr_t)arguments, TURN_SECONDS, &text, error, sizeof error);
    cJSON *found = status == 0 ? json_parse(text, strlen(text), error, sizeof error) : NULL;
    free(text);
    if (status > 0 && allowed) {
        return NULL;
    }
    if (status > 0) {
        (void)cli_error(CLI_BAD_INPUT, "%s: its bench --json ended with exit status %d%s", program, status,
                        s->contest->passed_count > 0 ? "; it may lack an option that is given here" : "");
    } else if (!cJSON_IsObject(found)) {
        (void)(status == 0 ? cli_error(CLI_BAD_INPUT, "%s: its bench --json prints no JSON object: %s", program,
                                       found == NULL ? error : "another value")
                           : cli_error(CLI_BAD_INPUT, "%s", error));
        cJSON_Delete(found);
        found = NULL;
    }
    return found;
}

static double number_of(const cJSON *object, const char *key)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    return cJSON_IsNumber(item) ? item->valuedouble : 0;
}

/* ---- the other program ------------------------------------------------------------------------------------------- */

/* Asks whether the other program is a trim3r with a bench, and which options that takes. */
static int ask_for_help(contest_state *s)
{
    const char *other = s->contest->other;
    char error[ERROR_BYTES] = "", *text = NULL;
    FILE *file = t3r_file_open(other, error, sizeof error);
    if (file == NULL) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    fclose(file);
    const char *const arguments[] = {"trim3r", "bench", "--help", NULL};
    const int status =
        other_program_run(other, (char *const *)(uintptr_t)arguments, HELP_SECONDS, &text, error, sizeof error);
    if (status < 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    const bool known = status == 0 && strstr(text, "kmeans_ms") != NULL && strstr(text, "--json") != NULL;
    s->has_stages = strstr(text, "--stages") != NULL;
    free(text);
    return known ? CLI_OK
                 : cli_error(CLI_BAD_INPUT, "%s: not a trim3r program: its bench --help is not a bench's", other);
}

static bool ends_a_row(const char *key)
{
    const char *const ends[] = {"_ms", "_per_s", "_per_pixel"};
    const size_t length = strlen(key);
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        if (length > strlen(ends[i]) && strcmp(key + length - strlen(ends[i]), ends[i]) == 0) {
            return true;
        }
    }
    return false;
}

/* Whether a row of the other program is neither a row nor part of a row of this program. */
static bool is_foreign(const char *key)
{
    for (const bench_stage *stage = bench_stages; stage->key != NULL; stage++) {
        if (strcmp(key, stage->key) == 0 || (stage->each_key != NULL && strcmp(key, stage->each_key) == 0)) {
            return false;
        }
    }
    return ends_a_row(key);
}

static bool is_compared(const contest_state *s, uint32_t stage)
{
    /* both run on the same machine */
    return s->contest->chosen[stage] && strncmp(bench_stages[stage].key, "machine_", 8) != 0;
}

/* Returns the other program's output: for the chosen stages if it has them all, else for all that it has. NULL after a
 * message. */
static cJSON *try_other(const contest_state *s)
{
    char wanted[LIST_BYTES] = "";
    bool all = true;
    for (uint32_t i = 0; bench_stages[i].key != NULL; i++) {
        all = all && s->contest->chosen[i];
        if (is_compared(s, i)) {
            add_word(wanted, bench_stages[i].key);
        }
    }
    cJSON *found = s->has_stages && !all ? run_bench(s, s->contest->other, wanted, true) : NULL;
    return found != NULL ? found : run_bench(s, s->contest->other, NULL, false);
}

/* Chooses what is compared: the chosen stages that the other program has. */
static int share_stages(contest_state *s, const cJSON *theirs)
{
    const cJSON *item;
    for (uint32_t i = 0; bench_stages[i].key != NULL; i++) {
        if (!is_compared(s, i)) {
            continue;
        }
        s->shared[i] = number_of(theirs, bench_stages[i].key) > 0;
        add_word(s->shared[i] ? s->list : s->this_alone, bench_stages[i].key);
    }
    cJSON_ArrayForEach(item, theirs)
    {
        if (cJSON_IsNumber(item) && is_foreign(item->string)) {
            add_word(s->other_alone, item->string);
        }
    }
    return s->list[0] != '\0'
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "%s: it has none of the stages: %s", s->contest->other, s->this_alone);
}

/* ---- the turns ------------------------------------------------------------------------------------------------- */

static int take_turns(contest_state *s)
{
    for (uint32_t turn = 0; turn < s->contest->turns; turn++) {
        for (uint32_t half = 0; half < 2; half++) {
            /* each program goes first equally often */
            const uint32_t who = (half + turn) % 2;
            cJSON *found =
                run_bench(s, who == 0 ? THIS : s->contest->other, who == 0 || s->has_stages ? s->list : NULL, false);
            if (found == NULL) {
                return CLI_BAD_INPUT;
            }
            bool whole = true;
            for (uint32_t i = 0; bench_stages[i].key != NULL; i++) {
                if (s->shared[i]) {
                    s->figure[who][i][turn] = number_of(found, bench_stages[i].key);
                    whole = whole && s->figure[who][i][turn] > 0;
                }
            }
            cJSON_Delete(found);
            if (!whole) {
                return cli_error(CLI_BAD_INPUT, "%s: a stage has no figure any more", s->contest->other);
            }
            cli_progress("turns", turn * 2 + half, s->contest->turns * 2);
        }
    }
    cli_progress_end();
    return CLI_OK;
}

/* ---- results ----------------------------------------------------------------------------------------------------- */

/* Returns the ratio of this program's speed to the other's, over the pairs of all turns. */
static spread ratio_of(const contest_state *s, uint32_t stage)
{
    double ratios[BENCH_TURNS_MOST];
    for (uint32_t turn = 0; turn < s->contest->turns; turn++) {
        const double ours = s->figure[0][stage][turn], theirs = s->figure[1][stage][turn];
        ratios[turn] = bench_stage_is_rate(bench_stages[stage].key) ? ours / theirs : theirs / ours;
    }
    return spread_of(ratios, s->contest->turns);
}

static void print_text(contest_state *s)
{
    printf("%-22s %10s %10s  %s\n", "", "this", "other", "times as fast (least to most)");
    for (uint32_t i = 0; bench_stages[i].key != NULL; i++) {
        if (s->shared[i]) {
            const spread ratio = ratio_of(s, i);
            printf("%-22s %10.3f %10.3f  %6.2f  (%.2f to %.2f)\n", bench_stages[i].key,
                   spread_of(s->figure[0][i], s->contest->turns).median,
                   spread_of(s->figure[1][i], s->contest->turns).median, ratio.median, ratio.least, ratio.most);
        }
    }
    if (s->this_alone[0] != '\0') {
        printf("the other has no %s\n", s->this_alone);
    }
    if (s->other_alone[0] != '\0') {
        printf("this one has no %s\n", s->other_alone);
    }
}

static void print_json(contest_state *s)
{
    cJSON *root = cJSON_CreateObject(), *stages;
    cJSON_AddStringToObject(root, "against", s->contest->other);
    json_add_integer(root, "turns", s->contest->turns);
    stages = cJSON_AddObjectToObject(root, "stages");
    for (uint32_t i = 0; bench_stages[i].key != NULL; i++) {
        if (s->shared[i]) {
            const spread ratio = ratio_of(s, i);
            cJSON *row = cJSON_AddObjectToObject(stages, bench_stages[i].key);
            cJSON_AddNumberToObject(row, "this", spread_of(s->figure[0][i], s->contest->turns).median);
            cJSON_AddNumberToObject(row, "other", spread_of(s->figure[1][i], s->contest->turns).median);
            cJSON_AddNumberToObject(row, "ratio", ratio.median);
            cJSON_AddNumberToObject(row, "ratio_min", ratio.least);
            cJSON_AddNumberToObject(row, "ratio_max", ratio.most);
        }
    }
    cJSON_AddStringToObject(root, "this_alone", s->this_alone);
    cJSON_AddStringToObject(root, "other_alone", s->other_alone);
    json_print(root);
}

int bench_against(const bench_contest *contest)
{
    contest_state *s = calloc(1, sizeof *s);
    if (s == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    s->contest = contest;
    int code = ask_for_help(s);
    cJSON *theirs = code == CLI_OK ? try_other(s) : NULL;
    code = code == CLI_OK && theirs == NULL ? CLI_BAD_INPUT : code;
    code = code == CLI_OK ? share_stages(s, theirs) : code;
    cJSON_Delete(theirs);
    code = code == CLI_OK ? take_turns(s) : code;
    if (code == CLI_OK && contest->json) {
        print_json(s);
    } else if (code == CLI_OK) {
        print_text(s);
    }
    free(s);
    return code;
}
