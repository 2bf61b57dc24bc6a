/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/man_page.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cli/options/option_list.h"
#include "trim3r.h"

#define GROUPS_MOST 100
#define EXAMPLES "Examples:"

/* Prints text; escapes the characters special to roff. */
static void put(const char *text, size_t bytes)
{
    if (bytes > 0 && (text[0] == '.' || text[0] == '\'')) {
        fputs("\\&", stdout);
    }
    for (size_t i = 0; i < bytes; i++) {
        if (text[i] == '\\') {
            fputs("\\e", stdout);
        } else if (text[i] == '-') {
            fputs("\\-", stdout);
        } else {
            putchar(text[i]);
        }
    }
}

static void put_line(const char *text, size_t bytes)
{
    put(text, bytes);
    putchar('\n');
}

void man_page_begin(const char *name, const char *summary)
{
    const char *epoch = getenv("SOURCE_DATE_EPOCH");
    const time_t now = epoch != NULL && *epoch != '\0' ? (time_t)strtoll(epoch, NULL, 10) : time(NULL);
    char date[16] = "";
    struct tm day;
    if (gmtime_r(&now, &day) != NULL) {
        strftime(date, sizeof date, "%Y-%m-%d", &day);
    }
    fputs(".TH \"", stdout);
    put(name, strlen(name));
    printf("\" 1 \"%s\" \"trim3r %s\" \"trim3r\"\n.SH NAME\n", date, T3R_VERSION);
    put(name, strlen(name));
    fputs(" \\- ", stdout);
    put_line(summary, strlen(summary));
}

void man_page_section(const char *title)
{
    printf(".SH %s\n", title);
}

void man_page_text(const char *text)
{
    bool literal = false, parted = false, begun = false;
    for (const char *line = text; *line != '\0';) {
        const size_t bytes = strcspn(line, "\n");
        const bool as_is = line[0] == ' ';
        if (bytes == 0) {
            parted = begun;
        } else {
            if (literal && (!as_is || parted)) {
                puts(".fi");
                literal = false;
            }
            if (begun && (parted || as_is != literal)) {
                puts(".PP");
            }
            if (as_is && !literal) {
                puts(".nf");
                literal = true;
            }
            put_line(line, bytes);
            parted = false;
            begun = true;
        }
        line += bytes + (line[bytes] == '\n');
    }
    if (literal) {
        puts(".fi");
    }
}

void man_page_item(const char *name, const char *text)
{
    fputs(".TP\n\\fB", stdout);
    put(name, strlen(name));
    puts("\\fR");
    put_line(text, strlen(text));
}

void man_page_end(void)
{
    man_page_section("\"EXIT STATUS\"");
    man_page_item("0", "done");
    man_page_item("1", "bad input, or a difference that was found");
    man_page_item("2", "bad usage");
    man_page_item("3", "the budget or the arena is too small");
}

/* Returns the text as help shows it, from malloc() if a filter made it. */
static char *filtered(const struct argp *owner, int key, const char *text)
{
    char *shown = owner->help_filter != NULL ? owner->help_filter(key, text, NULL) : (char *)(uintptr_t)text;
    return shown;
}

static void release(char *shown, const char *text)
{
    if (shown != text) {
        free(shown);
    }
}

static void print_option(const option_row *row)
{
    const struct argp_option *o = row->option;
    fputs(".TP\n", stdout);
    if (option_has_short(o)) {
        printf("\\fB\\-%c\\fR, ", o->key);
    }
    fputs("\\fB\\-\\-", stdout);
    put(o->name, strlen(o->name));
    fputs("\\fR", stdout);
    if (o->arg != NULL) {
        const bool optional = (o->flags & OPTION_ARG_OPTIONAL) != 0;
        fputs(optional ? "[=\\fI" : "=\\fI", stdout);
        put(o->arg, strlen(o->arg));
        fputs(optional ? "\\fR]" : "\\fR", stdout);
    }
    putchar('\n');
    char *text = filtered(row->owner, o->key, o->doc);
    put_line(text != NULL ? text : "", text != NULL ? strlen(text) : 0);
    release(text, o->doc);
}

/* Prints "What is compared" for "What is compared:". */
static void print_heading(const char *text)
{
    const size_t bytes = strlen(text);
    fputs(".SS ", stdout);
    put_line(text, bytes > 0 && text[bytes - 1] == ':' ? bytes - 1 : bytes);
}

static void print_group(const option_list *list, int group)
{
    for (uint32_t i = 0; i < list->count; i++) {
        const struct argp_option *o = list->rows[i].option;
        if (list->rows[i].group == group && o->name == NULL && o->doc != NULL) {
            print_heading(o->doc);
        }
    }
    for (uint32_t i = 0; i < list->count; i++) {
        if (list->rows[i].group == group && option_is_shown(list->rows[i].option)) {
            print_option(&list->rows[i]);
        }
    }
}

/* Prints groups in argp's order: from 0 up, then the negative ones. */
static void print_options(const struct argp *argp)
{
    option_list list = option_list_of(argp);
    man_page_section("OPTIONS");
    for (int group = 0; group < GROUPS_MOST; group++) {
        print_group(&list, group);
    }
    for (int group = -GROUPS_MOST; group < 0; group++) {
        print_group(&list, group);
    }
    man_page_item("-?, --help", "print a list of options");
    man_page_item("--usage", "print a short list of options");
    option_list_free(&list);
}

/* Finds the lines under "Examples:", up to the first that does not begin with a blank; *bytes is 0 if there are
 * none. */
static const char *examples_in(const char *text, size_t *bytes)
{
    *bytes = 0;
    const char *start = text != NULL ? strstr(text, EXAMPLES "\n") : NULL;
    if (start == NULL) {
        return NULL;
    }
    start += strlen(EXAMPLES "\n");
    const char *end = start;
    while (*end == ' ') {
        end += strcspn(end, "\n");
        end += *end == '\n';
    }
    *bytes = (size_t)(end - start);
    return start;
}

static void print_part(const char *title, const char *text, size_t bytes)
{
    char *part = strndup(text, bytes);
    if (part != NULL && strspn(part, "\n") < bytes) {
        if (title != NULL) {
            man_page_section(title);
        }
        man_page_text(part + strspn(part, "\n"));
    }
    free(part);
}

/* Prints the notes, and their examples in a section of their own. */
static void print_notes(const char *text)
{
    size_t bytes;
    const char *examples = examples_in(text, &bytes);
    if (bytes == 0) {
        print_part("NOTES", text, strlen(text));
        return;
    }
    const size_t before = (size_t)(examples - text) - strlen(EXAMPLES "\n");
    const char *after = examples + bytes;
    char *notes = calloc(strlen(text) + 1, 1);
    if (notes != NULL) {
        memcpy(notes, text, before);
        strcpy(notes + before, after);
        print_part("NOTES", notes, strlen(notes));
    }
    free(notes);
    print_part("EXAMPLES", examples, bytes);
}

/* Writes the text that help prints after the options, in argp's order: each parser's own before its children's. */
static void add_notes(FILE *out, const struct argp *argp)
{
    const char *notes = argp->doc != NULL ? strchr(argp->doc, '\v') : NULL;
    char *shown = notes != NULL ? filtered(argp, ARGP_KEY_HELP_POST_DOC, notes + 1) : NULL;
    char *more = filtered(argp, ARGP_KEY_HELP_EXTRA, NULL);
    fprintf(out, "%s\n%s\n", shown != NULL ? shown : "", more != NULL ? more : "");
    if (notes != NULL) {
        release(shown, notes + 1);
    }
    free(more);
    for (const struct argp_child *c = argp->children; c != NULL && c->argp != NULL; c++) {
        add_notes(out, c->argp);
    }
}

/* Returns the parser whose description and arguments help prints: the first that has them. */
static const struct argp *described(const struct argp *argp)
{
    const struct argp *found = argp->doc != NULL ? argp : NULL;
    for (const struct argp_child *c = argp->children; found == NULL && c != NULL && c->argp != NULL; c++) {
        found = described(c->argp);
    }
    return found;
}

static void print_synopsis(const char *command, const char *arguments)
{
    man_page_section("SYNOPSIS");
    for (const char *line = arguments != NULL ? arguments : "";;) {
        const size_t bytes = strcspn(line, "\n");
        printf("%s.B trim3r %s\n[\\fIOPTION\\fR...] ", line != arguments && arguments != NULL ? ".br\n" : "", command);
        put_line(line, bytes);
        if (line[bytes] == '\0') {
            break;
        }
        line += bytes + 1;
    }
}

void man_page_of_command(const char *command, const char *summary, const struct argp *argp)
{
    char name[64], *notes = NULL;
    size_t bytes;
    snprintf(name, sizeof name, "trim3r-%s", command);
    const struct argp *about = described(argp);
    FILE *out = open_memstream(&notes, &bytes);
    man_page_begin(name, summary);
    print_synopsis(command, about->args_doc);
    print_part("DESCRIPTION", about->doc, strcspn(about->doc, "\v"));
    print_options(argp);
    if (out != NULL) {
        add_notes(out, argp);
        if (fclose(out) == 0) {
            print_notes(notes);
        }
        free(notes);
    }
    man_page_end();
    man_page_section("\"SEE ALSO\"");
    puts(".BR trim3r (1)");
}
