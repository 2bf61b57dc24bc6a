/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/file_options.h"

#include <errno.h>
#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/options/file_guard.h"
#include "cli/options/option_completion.h"
#include "cli/options/option_list.h"
#include "cli/options/standard_output.h"
#include "cli/tables/json_output.h"
#include "cli/text/edit_distance.h"
#include "cli/text/style.h"
#include "cli/text/word_list.h"

enum { KEY_LISTING = 0x8000, KEY_COMPLETE, KEY_COLOR, KEY_FORCE, LONG_OPTION = 0x10000 };

static void *must(void *memory)
{
    if (memory == NULL) {
        exit(cli_error(CLI_BAD_INPUT, "out of memory"));
    }
    return memory;
}

/* ---- files on the command line ----------------------------------------------------------------------------------- */

typedef struct file_list {
    named_file *items;
    uint32_t count;
    bool force;
} file_list;

static void add_path(file_list *files, const named_file *named, const char *path)
{
    if (files->count % 16 == 0) {
        files->items = must(realloc(files->items, (files->count + 16) * sizeof *files->items));
    }
    files->items[files->count] = *named;
    files->items[files->count++].path = path;
}

static void add_value(file_list *files, const struct argp_option *o, const char *value)
{
    named_file named = {.flags = o->flags};
    option_name(o, named.option);
    const char *colon = strchr(value, ':');
    if ((o->flags & OPTION_WRITES_BIT) != 0) {
        /* if an option is repeated, the last one counts */
        for (uint32_t i = 0; i < files->count; i++) {
            if (strcmp(files->items[i].option, named.option) == 0) {
                files->items[i].path = value;
                return;
            }
        }
    }
    if ((o->flags & OPTION_LIST) != 0) {
        for (list_word w = word_first(value); w.text != NULL; w = word_next(w)) {
            add_path(files, &named, must(strndup(w.text, w.length)));
        }
    } else {
        bool behind = (o->flags & OPTION_OR_DEVICE) != 0 && colon != NULL;
        add_path(files, &named, behind ? colon + 1 : value);
    }
}

static const struct argp_option *arguments_of(const option_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) {
        if (list->rows[i]->key == 0 && (list->rows[i]->flags & OPTION_READS) != 0) {
            return list->rows[i];
        }
    }
    return NULL;
}

/* Returns the letters of short options for getopt(). */
static char *short_options(const option_list *list)
{
    char *letters = must(calloc(list->count + 1, 3)), *end = letters;
    for (uint32_t i = 0; i < list->count; i++) {
        const struct argp_option *o = list->rows[i];
        if (option_has_short(o)) {
            *end++ = (char)o->key;
            *end = ':';
            end += o->arg != NULL;
            *end = '\0';
        }
    }
    return letters;
}

static const char *const of_argp[] = {"help", "usage", "HANG", "program-name"};
enum { OF_ARGP = sizeof of_argp / sizeof of_argp[0] };

/* Returns the long options for getopt(); `val` is LONG_OPTION plus the index in the list. */
static struct option *long_options(const option_list *list)
{
    struct option *all = must(calloc(list->count + OF_ARGP + 1, sizeof *all)), *next = all;
    for (uint32_t i = 0; i < list->count; i++) {
        const struct argp_option *o = list->rows[i];
        if (o->name != NULL && (o->flags & OPTION_DOC) == 0) {
            int takes = o->arg == NULL                          ? no_argument
                        : (o->flags & OPTION_ARG_OPTIONAL) != 0 ? optional_argument
                                                                : required_argument;
            *next++ = (struct option){o->name, takes, NULL, LONG_OPTION + (int)i};
        }
    }
    for (int i = 0; i < OF_ARGP; i++) {
        *next++ = (struct option){of_argp[i], optional_argument, NULL, '?'};
    }
    return all;
}

static const struct argp_option *option_of(const option_list *list, int got)
{
    for (uint32_t i = 0; i < list->count; i++) {
        if (got == LONG_OPTION + (int)i || (option_has_short(list->rows[i]) && list->rows[i]->key == got)) {
            return list->rows[i];
        }
    }
    return NULL;
}

/* Refuses an unknown long option, or one without its value: says so, suggests a similar one, and ends the process. argp
 * reports all other errors. */
static void refuse_option(const option_list *list, const char *word)
{
    char name[64];
    const size_t length = strcspn(word, "=");
    const char *nearest = NULL;
    uint32_t least = EDIT_DISTANCE_NEAR + 1;
    if (strncmp(word, "--", 2) != 0 || length < 2 || length - 2 >= sizeof name) {
        return;
    }
    snprintf(name, sizeof name, "%.*s", (int)(length - 2), word + 2);
    for (int i = 0; i < OF_ARGP; i++) {
        if (strncmp(of_argp[i], name, strlen(name)) == 0) {
            return;
        }
    }
    for (uint32_t i = 0; i < list->count; i++) {
        const struct argp_option *o = list->rows[i];
        if (!option_is_shown(o)) {
            continue;
        }
        if (strncmp(o->name, name, strlen(name)) == 0) {
            if (strcmp(o->name, name) == 0 && o->arg != NULL && word[length] == '\0') {
                exit(cli_error(CLI_BAD_USAGE, "option '--%s' requires an argument: %s", name, o->arg));
            }
            return; /* an abbreviation, perhaps of several */
        }
        if (edit_distance(o->name, name) < least) {
            least = edit_distance(o->name, name);
            nearest = o->name;
        }
    }
    if (nearest != NULL) {
        exit(cli_error(CLI_BAD_USAGE, "there is no option --%s; did you mean --%s?", name, nearest));
    }
    exit(cli_error(CLI_BAD_USAGE, "unrecognized option '--%s'; trim3r %s --help lists them", name, cli_command()));
}

/* Reads the line like argp; false: argp will refuse it, or print help. */
static bool read_line(const option_list *list, int argc, char **argv, file_list *files)
{
    char **line = must(calloc((size_t)argc + 1, sizeof *line)), *letters = short_options(list);
    struct option *longs = long_options(list);
    memcpy(line, argv, (size_t)argc * sizeof *line);
    optind = 0;
    opterr = 0;
    int got;
    while ((got = getopt_long(argc, line, letters, longs, NULL)) != -1 && got != '?') {
        const struct argp_option *o = option_of(list, got);
        if (o->key == KEY_FORCE) {
            files->force = true;
        } else if (o->key == KEY_COLOR && !style_choose(optarg)) {
            exit(cli_error(CLI_BAD_USAGE, "--color takes auto, always or never, not '%s'", optarg));
        } else if ((o->flags & (OPTION_READS | OPTION_WRITES_BIT)) != 0 && optarg != NULL) {
            add_value(files, o, optarg);
        }
    }
    if (got == '?' && optind >= 1 && optind <= argc) {
        refuse_option(list, line[optind - 1]);
    }
    const struct argp_option *arguments = arguments_of(list);
    for (int i = optind; i < argc && arguments != NULL && got == -1; i++) {
        add_path(files, &(named_file){.option = "the argument", .flags = arguments->flags}, line[i]);
    }
    free(longs);
    free(letters);
    free(line);
    return got == -1;
}

/* Takes the output that is standard output off the list: it is no file that the guard knows. */
static void take_standard_output(file_list *files)
{
    named_file taken = {0};
    uint32_t rest = 0;
    for (uint32_t i = 0; i < files->count; i++) {
        const named_file *file = &files->items[i];
        if ((file->flags & OPTION_WRITES_BIT) == 0 || (file->flags & OPTION_OR_WORD) != 0 ||
            strcmp(file->path, STANDARD_OUTPUT_WORD) != 0) {
            files->items[rest++] = *file;
            continue;
        }
        if ((file->flags & OPTION_PIPE) == 0) {
            exit(cli_error(CLI_BAD_USAGE, "%s -: this output needs a file; ./- is one of that name", file->option));
        }
        if (taken.path != NULL) {
            exit(cli_error(CLI_BAD_USAGE, "%s - and %s - are both standard output", taken.option, file->option));
        }
        taken = *file;
    }
    files->count = rest;
    if (taken.path != NULL && standard_output_keep() != 0) {
        exit(cli_error(CLI_BAD_INPUT, "standard output: %s", strerror(errno)));
    }
}

/* ---- options common to all commands ------------------------------------------------------------------------------ */

/* Prints the rows that name files, for the tests. */
static void print_listing(const option_list *list)
{
    cJSON *rows = cJSON_CreateArray();
    for (uint32_t i = 0; i < list->count; i++) {
        const struct argp_option *o = list->rows[i];
        if ((o->flags & (OPTION_READS | OPTION_WRITES_BIT)) == 0) {
            continue;
        }
        char name[32] = "";
        if (o->key != 0) {
            option_name(o, name);
        }
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "option", name);
        cJSON_AddBoolToObject(row, "reads", (o->flags & OPTION_READS) != 0);
        cJSON_AddBoolToObject(row, "writes", (o->flags & OPTION_WRITES_BIT) != 0);
        cJSON_AddBoolToObject(row, "folder", (o->flags & OPTION_FOLDER) != 0);
        cJSON_AddBoolToObject(row, "list", (o->flags & OPTION_LIST) != 0);
        cJSON_AddBoolToObject(row, "word", (o->flags & OPTION_OR_WORD) != 0);
        cJSON_AddBoolToObject(row, "pipe", (o->flags & OPTION_PIPE) != 0);
        cJSON_AddBoolToObject(row, "device", (o->flags & OPTION_OR_DEVICE) != 0);
        cJSON *kinds = cJSON_AddArrayToObject(row, "kinds");
        for (int k = 0; k < FILE_KINDS; k++) {
            if ((OPTION_KINDS(o->flags) >> k & 1) != 0) {
                cJSON_AddItemToArray(kinds, cJSON_CreateString(file_kind_name((file_kind)(1 << k))));
            }
        }
        cJSON_AddItemToArray(rows, row);
    }
    json_print(rows);
}

/* Returns the names of a command's arguments, which argp keeps one level down; NULL = it has none. */
static const char *arguments_text(const struct argp *argp)
{
    const char *text = argp->args_doc;
    for (const struct argp_child *c = argp->children; c != NULL && c->argp != NULL && text == NULL; c++) {
        text = arguments_text(c->argp);
    }
    return text;
}

static error_t parse_listing(int key, char *argument, struct argp_state *state)
{
    (void)argument;
    if (key == ARGP_KEY_INIT) {
        style_argp(state);
        return 0;
    }
    if (key == KEY_COLOR) {
        return 0; /* read_line() has handled it */
    }
    if (key != KEY_LISTING && key != KEY_COMPLETE) {
        return ARGP_ERR_UNKNOWN;
    }
    option_list list = option_list_of(state->root_argp);
    if (key == KEY_COMPLETE) {
        option_completion_print(&list, arguments_text(state->root_argp));
    } else {
        print_listing(&list);
    }
    exit(CLI_OK);
}

static error_t parse_force(int key, char *argument, struct argp_state *state)
{
    (void)argument, (void)state;
    return key == KEY_FORCE ? 0 : ARGP_ERR_UNKNOWN; /* read_line() has handled it */
}

static const struct argp_option listing_options[] = {
    {"color", KEY_COLOR, "auto|always|never", 0,
     "use of colours in messages and headings: auto (default), only on terminals; always; never", -1},
    {"file-options", KEY_LISTING, NULL, OPTION_HIDDEN, "the options that name files, as JSON", -1},
    {"complete", KEY_COMPLETE, NULL, OPTION_HIDDEN, "all options, for completion", -1},
    {0}};
static const struct argp_option force_options[] = {
    {"force", KEY_FORCE, NULL, 0, "replace also a file of another kind", -1}, {0}};
static const struct argp listing_argp = {.options = listing_options, .parser = parse_listing};
static const struct argp force_argp = {.options = force_options, .parser = parse_force};

/* ---- parsing ----------------------------------------------------------------------------------------------------- */

static bool any_is_written(const struct argp *argp)
{
    option_list list = option_list_of(argp);
    bool written = false;
    for (uint32_t i = 0; i < list.count; i++) {
        written = written || (list.rows[i]->flags & OPTION_WRITES_BIT) != 0;
    }
    option_list_free(&list);
    return written;
}

/* Returns the command's children and our own, from malloc(). */
static struct argp_child *all_children(const struct argp *argp)
{
    uint32_t count = 0;
    while (argp->children != NULL && argp->children[count].argp != NULL) {
        count++;
    }
    struct argp_child *all = must(calloc(count + 3, sizeof *all));
    for (uint32_t i = 0; i < count; i++) {
        all[i] = argp->children[i];
    }
    all[count].argp = &listing_argp;
    all[count + 1].argp = any_is_written(argp) ? &force_argp : NULL;
    return all;
}

void file_options_parse(const struct argp *argp, int argc, char **argv, void *input)
{
    struct argp whole = *argp;
    struct argp_child *children = all_children(argp);
    whole.children = children;
    option_list list = option_list_of(&whole);
    file_list files = {0};
    if (read_line(&list, argc, argv, &files)) {
        take_standard_output(&files);
        int code = file_guard_begin(files.items, files.count, files.force); /* keeps the items */
        if (code != CLI_OK) {
            exit(code);
        }
    }
    option_list_free(&list);
    if (argp_parse(&whole, argc, argv, 0, NULL, input) != 0) {
        exit(cli_error(CLI_BAD_INPUT, "out of memory for the options"));
    }
    int code = file_guard_find();
    if (code != CLI_OK) {
        exit(code);
    }
    free(children);
}
