#include "options.h"

#include <stddef.h>

#include "report.h"
#include "semihost.h"

enum { LINE_BYTES = 512 };

typedef struct number_option {
    const char *key;
    size_t offset;
} number_option;

static const number_option numbers[] = {
    {"width", offsetof(options, width)},       {"height", offsetof(options, height)},
    {"views", offsetof(options, views)},       {"gaussians", offsetof(options, gaussians)},
    {"clusters", offsetof(options, clusters)}, {"cluster_batches", offsetof(options, cluster_batches)},
    {"refine", offsetof(options, refine)},     {"learned", offsetof(options, learned)},
    {"hashes", offsetof(options, hashes)},     {"plain", offsetof(options, plain)},
    {"cpu", offsetof(options, cpu)},           {"arena", offsetof(options, arena)},
};

static _Noreturn void refuse(const char *word, const char *why)
{
    report_text("error: ", word, ": ", why);
    semihost_exit(1);
}

/* Returns the text after "key=", or NULL. */
static const char *value_of(const char *word, const char *key)
{
    while (*key != '\0' && *word == *key) {
        word++;
        key++;
    }
    return *key == '\0' && *word == '=' ? word + 1 : NULL;
}

static uint32_t number(const char *word, const char *text)
{
    uint32_t value = 0;
    for (const char *digit = text; *digit != '\0' || digit == text; digit++) {
        if (*digit < '0' || *digit > '9' || value > (UINT32_MAX - 9) / 10) {
            refuse(word, "no number");
        }
        value = value * 10 + (uint32_t)(*digit - '0');
    }
    return value;
}

static void take(options *o, char *word)
{
    const struct {
        const char *key, **text;
    } texts[] = {{"frames", &o->frames}, {"view", &o->view}, {"scene", &o->scene}};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        const char *value = value_of(word, texts[i].key);
        if (value != NULL) {
            *texts[i].text = value;
            return;
        }
    }
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        const char *value = value_of(word, numbers[i].key);
        if (value != NULL) {
            *(uint32_t *)((uint8_t *)o + numbers[i].offset) = number(word, value);
            return;
        }
    }
    refuse(word, "not known");
}

void options_read(options *o)
{
    static char line[LINE_BYTES];
    *o = (options){.frames = "", .view = "", .scene = ""};
    char *word = semihost_command_line(line, sizeof line);
    if (word == NULL) {
        refuse("command line", "too long");
    }
    while (*word != '\0') {
        char *end = word;
        while (*end != ' ' && *end != '\0') {
            end++;
        }
        char *next = *end == ' ' ? end + 1 : end;
        *end = '\0';
        if (*word != '\0') {
            take(o, word);
        }
        word = next;
    }
    if (o->frames[0] == '\0' || o->width == 0 || o->height == 0 || o->views == 0 || o->gaussians == 0) {
        refuse("command line", "frames=, width=, height=, views= and gaussians= are needed");
    }
}
