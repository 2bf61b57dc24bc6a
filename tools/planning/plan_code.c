/* SPDX-License-Identifier: Apache-2.0 */
#include "planning/plan_code.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdbool.h>

/* The name of a value in trim3r.h is a prefix with the value's name in capitals; other values are numbers. */
typedef struct value_names {
    const char *prefix; /* NULL: a number */
    const char *(*name)(uint32_t);
} value_names;

#define NAMES_number                                                                                                   \
    {                                                                                                                  \
        NULL, NULL                                                                                                     \
    }
#define NAMES_q8 NAMES_number
#define NAMES_toggle NAMES_number
#define NAMES_wavelet                                                                                                  \
    {                                                                                                                  \
        "T3R_WAVELET_", t3r_wavelet_name                                                                               \
    }
#define NAMES_allocation                                                                                               \
    {                                                                                                                  \
        "T3R_ALLOCATE_", t3r_allocation_name                                                                           \
    }
#define NAMES_head                                                                                                     \
    {                                                                                                                  \
        "T3R_HEAD_", t3r_head_name                                                                                     \
    }
#define NAMES_depth                                                                                                    \
    {                                                                                                                  \
        "T3R_DEPTH_", t3r_depth_name                                                                                   \
    }

static void write_value(FILE *file, const value_names *names, uint32_t value)
{
    if (names->prefix == NULL) {
        fprintf(file, "%" PRIu32, value);
        return;
    }
    fputs(names->prefix, file);
    for (const char *letter = names->name(value); *letter != '\0'; letter++) {
        fputc(toupper((unsigned char)*letter), file);
    }
}

void plan_code_settings(FILE *file, const t3r_config *config, const char *head, const char *indent)
{
    const t3r_config usual = t3r_default_config(config->width, config->height, config->views, config->max_gaussians);
    fprintf(file, "%st3r_config config = t3r_default_config(%" PRIu32 ", %" PRIu32 ", %" PRIu32 ", %" PRIu32 ");\n",
            indent, config->width, config->height, config->views, config->max_gaussians);
#define ASSIGN(field, kind, ...)                                                                                       \
    if (config->field != usual.field) {                                                                                \
        fprintf(file, "%sconfig." #field " = ", indent);                                                               \
        write_value(file, &(const value_names)NAMES_##kind, config->field);                                            \
        fputs(";\n", file);                                                                                            \
    }
    T3R_SETTINGS(ASSIGN)
#undef ASSIGN
    if (config->head == T3R_HEAD_LEARNED) {
        fprintf(file, "%s/* after t3r_init(): t3r_bind_head() with the weights of %s */\n", indent, head);
    }
}

void plan_code_header(FILE *file, const t3r_config *config, const t3r_plan_info *plan, const char *head)
{
    fputs("/* The settings and the static memory of one runtime, made by trim3r plan --header:\n"
          " *\n"
          " *     static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_PLANNED_BYTES];\n"
          " *     const t3r_config config = t3r_planned_config();\n"
          " *     t3r_init(&runtime, arena, sizeof arena, &config);\n"
          " *     t3r_set_cpu(runtime, t3r_cpu_found()); */\n"
          "#ifndef TRIM3R_PLANNED_H\n"
          "#define TRIM3R_PLANNED_H\n\n"
          "#include \"trim3r.h\"\n\n",
          file);
    fprintf(file,
            "#if T3R_VERSION_MAJOR != %d || T3R_VERSION_MINOR != %d || T3R_BITS_EPOCH != %d\n"
            "#error \"made by trim3r " T3R_VERSION ", bits epoch %d: make it again by this version's program\"\n"
            "#endif\n\n",
            T3R_VERSION_MAJOR, T3R_VERSION_MINOR, T3R_BITS_EPOCH, T3R_BITS_EPOCH);
    fprintf(file,
            "/* Bytes of the arena: for full speed, and the least that works. A library without some features needs no "
            "more. */\n"
            "#define T3R_PLANNED_BYTES %zu\n"
            "#define T3R_PLANNED_MIN_BYTES %zu\n\n",
            plan->bytes, plan->min_bytes);
    fputs("static inline t3r_config t3r_planned_config(void)\n{\n", file);
    plan_code_settings(file, config, head, "    ");
    fputs("    return config;\n}\n\n#endif\n", file);
}
