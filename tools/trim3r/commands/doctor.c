/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r doctor: checks this machine and this build, and whether they give the right bits. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <dirent.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench/bench_kernels.h"
#include "bench/cpu_flags.h"
#include "bench/self_check.h"
#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/options/processor_options.h"
#include "cli/tables/json_output.h"
#include "cli/text/wrapped.h"
#include "host/cpu.h"
#include "host/text.h"
#include "kernels/kernels.h"
#include "pictures/heif.h"
#include "posing/opencv_module.h"
#include "trim3r_capture.h"

#define CAMERAS_FOLDER "/sys/class/video4linux"
#define CAMERAS_MOST 64
#define CAMERA_BYTES 128
#define INDENT 13u /* of what is found, after the names */

typedef struct options {
    uint64_t expected;
    bool json;
    processor_options processor;
} options;

enum { KEY_EXPECT = 0x1000 };

static const struct argp_option option_table[] = {
    {"expect", KEY_EXPECT, "HASH", 0, "hash that the self-check must give (this version's)", 0},
    {"json", OPTION_TO(options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->processor;
        return 0;
    case KEY_EXPECT:
        if (hash_parse(arg, &o->expected) != 0) {
            argp_error(state, "--expect takes 16 hexadecimal digits, not '%s'", arg);
        }
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, NULL, 0);
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child children[] = {{.argp = &processor_argp}, {0}};
static const struct argp argp = {
    .options = option_table,
    .parser = parse,
    .doc = "List the features of this machine and this build, and check that they give the same bits as every "
           "machine.\v"
           "Examples:\n"
           "  trim3r doctor\n"
           "  trim3r doctor --cpu-mask none --json\n"
           "  trim3r doctor --threads all\n"
           "\n"
           "The self-check builds a small scene of the built-in room and draws it, with the threads and vector "
           "extensions given. Its hash is the same on every machine; otherwise the exit status is 1, and a second "
           "build in plain C on one thread shows whether those are the cause.\n"
           "\n"
           "Cameras are listed by the system's names. None is opened.",
    .children = children,
};

/* ---- features -------------------------------------------------------------------------------------------------- */

typedef struct camera_list {
    char name[CAMERAS_MOST][CAMERA_BYTES]; /* "/dev/video0: its name" */
    uint32_t count;
} camera_list;

/* video2 before video10 */
static int compare_names(const void *a, const void *b)
{
    const size_t x = strcspn(a, ":"), y = strcspn(b, ":");
    return x != y ? (x > y) - (x < y) : strcmp(a, b);
}

/* Lists V4L2 devices from the kernel's list; opens nothing else. */
static void find_cameras(camera_list *list)
{
    list->count = 0;
    DIR *folder = opendir(CAMERAS_FOLDER);
    for (const struct dirent *entry;
         folder != NULL && list->count < CAMERAS_MOST && (entry = readdir(folder)) != NULL;) {
        char path[512], line[CAMERA_BYTES] = "";
        if (entry->d_name[0] == '.') {
            continue;
        }
        snprintf(path, sizeof path, CAMERAS_FOLDER "/%s/name", entry->d_name);
        FILE *file = fopen(path, "r");
        if (file != NULL) {
            line[fread(line, 1, sizeof line - 1, file)] = '\0';
            line[strcspn(line, "\n")] = '\0';
            fclose(file);
        }
        char *name = list->name[list->count++];
        snprintf(name, CAMERA_BYTES, "/dev/%.32s: %.80s", entry->d_name, line);
        t3r_text_clean(name);
    }
    if (folder != NULL) {
        closedir(folder);
    }
    qsort(list->name, list->count, sizeof list->name[0], compare_names);
}

/* Returns bytes of memory; 0 if the system does not report them. */
static int64_t memory_bytes(int name)
{
    const long pages = sysconf(name), page = sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0 ? (int64_t)pages * page : 0;
}

typedef struct machine {
    char cpu[CPU_FLAGS_BYTES], flags[CPU_FLAGS_BYTES], features[64], used[64];
    t3r_kernels kernels;
    long processors;
    int64_t memory, available;
    camera_list cameras;
    const pose_module *poses; /* NULL: no_poses says why */
    char no_poses[512];
    bool heif_there;
    char heif[512];            /* the library, or why it is not there */
    uint64_t hash, plain_hash; /* of the self-check; the second where the first is wrong */
} machine;

static void look_around(machine *m, const options *o)
{
    cpu_name(m->cpu);
    cpu_flags(m->flags);
    t3r_cpu_describe(t3r_cpu_features(), m->features, sizeof m->features);
    t3r_cpu_describe(o->processor.cpu, m->used, sizeof m->used);
    t3r_kernels_choose(&m->kernels, o->processor.cpu);
    m->processors = sysconf(_SC_NPROCESSORS_ONLN);
    m->memory = memory_bytes(_SC_PHYS_PAGES);
    m->available = memory_bytes(_SC_AVPHYS_PAGES);
    find_cameras(&m->cameras);
    m->poses = pose_module_load(m->no_poses, sizeof m->no_poses);
    m->heif_there = heif_describe(m->heif, sizeof m->heif) == 0;
}

/* ---- output ---------------------------------------------------------------------------------------------------- */

static void print_json(const machine *m, const options *o)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "version", T3R_VERSION);
    cJSON_AddNumberToObject(root, "bits_epoch", T3R_BITS_EPOCH);
    cJSON_AddStringToObject(root, "processor", m->cpu);
    cJSON_AddStringToObject(root, "cpu_flags", m->flags);
    cJSON_AddStringToObject(root, "cpu_features", m->features);
    cJSON_AddStringToObject(root, "cpu_used", m->used);
    bench_kernels_add_json(root, &m->kernels);
    json_add_integer(root, "processors", m->processors);
    json_add_integer(root, "threads", o->processor.threads);
    json_add_integer(root, "memory_bytes", m->memory);
    json_add_integer(root, "memory_free_bytes", m->available);
    cJSON *sources = cJSON_AddObjectToObject(root, "sources");
    for (uint32_t i = 0; i < t3r_capture_adapter_count(); i++) {
        const t3r_capture_adapter adapter = t3r_capture_adapter_of(i);
        cJSON_AddBoolToObject(sources, adapter.name, adapter.available);
    }
    cJSON_AddStringToObject(root, "formats", t3r_capture_formats());
    cJSON *cameras = cJSON_AddArrayToObject(root, "cameras");
    for (uint32_t i = 0; i < m->cameras.count; i++) {
        cJSON_AddItemToArray(cameras, cJSON_CreateString(m->cameras.name[i]));
    }
    cJSON_AddItemToObject(root, "heif", m->heif_there ? cJSON_CreateString(m->heif) : cJSON_CreateNull());
    cJSON_AddItemToObject(root, "poses", m->poses != NULL ? cJSON_CreateString(m->poses->version) : cJSON_CreateNull());
    json_add_hash(root, "hash", m->hash);
    json_add_hash(root, "expected", o->expected);
    cJSON_AddBoolToObject(root, "passed", m->hash == o->expected);
    json_print(root);
}

static void print_text(const machine *m, const options *o)
{
    char line[600];
    printf("%-12s %s, bits epoch %d\n", "trim3r", T3R_VERSION, T3R_BITS_EPOCH);
    printf("%-12s %s\n", "processor", m->cpu[0] != '\0' ? m->cpu : "unnamed");
    printf("%-12s %s; used: %s\n", "features", m->features, m->used);
    bench_kernels_print(&m->kernels, INDENT);
    printf("%-12s %ld processors; used: %" PRIu32 "\n", "threads", m->processors, o->processor.threads);
    printf("%-12s %" PRId64 " MiB, %" PRId64 " MiB free\n", "memory", m->memory >> 20, m->available >> 20);
    for (uint32_t i = 0; i < t3r_capture_adapter_count(); i++) {
        const t3r_capture_adapter adapter = t3r_capture_adapter_of(i);
        snprintf(line, sizeof line, "%s: %s", adapter.name, adapter.says);
        wrapped_print(stdout, INDENT, i == 0 ? "sources" : "", line);
    }
    printf("%-12s %s\n", "formats", t3r_capture_formats());
    for (uint32_t i = 0; i < m->cameras.count; i++) {
        printf("%-12s %s\n", i == 0 ? "cameras" : "", m->cameras.name[i]);
    }
    if (m->cameras.count == 0) {
        printf("%-12s none\n", "cameras");
    }
    snprintf(line, sizeof line, "PNG, JPEG; HEIC and AVIF: %s", m->heif);
    wrapped_print(stdout, INDENT, "pictures", line);
    wrapped_print(stdout, INDENT, "poses", m->poses != NULL ? m->poses->version : m->no_poses);
    char text[HASH_TEXT_BYTES];
    hash_text(m->hash, text);
    printf("%-12s %s, %s\n", "self-check", text, m->hash == o->expected ? "as on every machine" : "wrong");
}

/* Returns exit status 1 with the cause, if known. */
static int verdict(const machine *m, const options *o)
{
    char found[HASH_TEXT_BYTES], expected[HASH_TEXT_BYTES];
    if (m->hash == o->expected) {
        return CLI_OK;
    }
    hash_text(m->hash, found);
    hash_text(o->expected, expected);
    return cli_error(CLI_BAD_INPUT, "the self-check gives %s, not %s; %s", found, expected,
                     m->plain_hash == o->expected ? "plain C on one thread gives the right one"
                                                  : "plain C on one thread gives a wrong one, too");
}

int command_doctor(int argc, char **argv)
{
    options o = {.expected = SELF_CHECK_HASH, .processor = processor_defaults()};
    file_options_parse(&argp, argc, argv, &o);

    machine *m = calloc(1, sizeof *m);
    if (m == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    look_around(m, &o);
    int code = self_check_run(&o.processor, &m->hash);
    if (code == CLI_OK && m->hash != o.expected) {
        code = self_check_run(&(processor_options){.threads = 1, .cpu = 0}, &m->plain_hash);
    }
    if (code == CLI_OK && o.json) {
        print_json(m, &o);
    } else if (code == CLI_OK) {
        print_text(m, &o);
    }
    code = code == CLI_OK ? verdict(m, &o) : code;
    free(m);
    return code;
}
