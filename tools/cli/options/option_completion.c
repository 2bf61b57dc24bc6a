/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/option_completion.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/options/file_options.h"

#define KIND_BYTES 256
#define WORD "abcdefghijklmnopqrstuvwxyz0123456789-"
#define NAME "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789."

/* Appends a word after `|`, unless it is there. */
static void append(char kind[KIND_BYTES], const char *word, size_t length)
{
    char text[64];
    snprintf(text, sizeof text, "%.*s", (int)length, word);
    const size_t used = strlen(kind);
    if (strstr(kind, text) == NULL && used + strlen(text) + 2 < KIND_BYTES) {
        snprintf(kind + used, KIND_BYTES - used, "%s%s", used > 0 ? "|" : "", text);
    }
}

/* Collects the values that a placeholder lists: min and full of "BYTES[K|M|G]|min|full", tiny and none of
 * "tiny|FILE.t3w|none,...". */
static void add_words(const char *placeholder, char kind[KIND_BYTES])
{
    bool outside = true;
    for (const char *at = placeholder; *at != '\0';) {
        const size_t length = strcspn(at, "|[],");
        if (outside && length > 0 && strspn(at, WORD) == length && at[length] != '[') {
            append(kind, at, length);
        }
        at += length;
        outside = *at == ']' || (outside && *at != '[');
        at += *at != '\0';
    }
}

static void add_endings_of(file_kind kinds, char kind[KIND_BYTES])
{
    const char *ending;
    for (int i = 0; (ending = file_kind_ending(kinds, i)) != NULL; i++) {
        append(kind, ending, strlen(ending));
    }
}

/* Collects the endings of the files that placeholders name: of SCENE.ply those of all scenes, of FILE.npz its own. */
static void add_endings(const char *placeholders, char kind[KIND_BYTES])
{
    for (const char *at = placeholders; *at != '\0';) {
        char name[64];
        const size_t length = strspn(at, NAME);
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        char *dot = strchr(name, '.');
        if (strstr(name, "...") != NULL) { /* an ellipsis after it */
            *strstr(name, "...") = '\0';
        }
        if (dot != NULL && dot > name && *dot == '.') {
            const file_kind named = file_kind_named(name);
            if (named == 0 || named == FILE_OTHER) {
                append(kind, dot, strlen(dot));
            } else {
                add_endings_of(named, kind);
            }
        }
        at += length > 0 ? length : 1;
    }
}

/* Writes the kind of a file: "file", or "file:" and the endings, then the words that may stand for one; "files" for
 * several with commas between them. */
static void file_text(const char *placeholders, int flags, char kind[KIND_BYTES])
{
    char endings[KIND_BYTES] = "";
    if ((flags & OPTION_WRITES_BIT) != 0) {
        add_endings_of(OPTION_KINDS(flags), endings);
    } else {
        add_endings(placeholders, endings);
    }
    if ((flags & OPTION_OR_WORD) != 0) {
        add_words(placeholders, endings);
    }
    snprintf(kind, KIND_BYTES, "file%s%s%.*s", (flags & OPTION_LIST) != 0 ? "s" : "", endings[0] != '\0' ? ":" : "",
             KIND_BYTES - 8, endings);
}

static void value_text(const struct argp_option *o, char kind[KIND_BYTES])
{
    kind[0] = '\0';
    if (o->arg == NULL) {
        return;
    }
    if ((o->flags & (OPTION_READS | OPTION_WRITES_BIT)) != 0) {
        file_text(o->arg, o->flags, kind);
        return;
    }
    add_words(o->arg, kind);
    if (kind[0] == '\0') {
        snprintf(kind, KIND_BYTES, "value");
    }
}

void option_completion_print(const option_list *list, const char *args_doc)
{
    char kind[KIND_BYTES];
    file_text(args_doc != NULL ? args_doc : "", OPTION_READS, kind);
    printf("*\t%s\targuments\n", kind);
    for (uint32_t i = 0; i < list->count; i++) {
        const struct argp_option *o = list->rows[i];
        if (!option_is_shown(o)) {
            continue;
        }
        const char *help = o->doc != NULL ? o->doc : "";
        value_text(o, kind);
        printf("--%s\t%s\t%s\n", o->name, kind, help);
        if (option_has_short(o)) {
            printf("-%c\t%s\t%s\n", o->key, kind, help);
        }
    }
    puts("--help\t\tgive this help list");
}
