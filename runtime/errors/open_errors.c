/* SPDX-License-Identifier: Apache-2.0 */
/* Sentences about errors of calls that plan and open an arena, and bind something to a runtime. */
#include "api/bind_head_checks.h"
#include "api/open_checks.h"
#include "sentence.h"

#define OR_FEATURE(FEATURE, name) | T3R_HAS_##FEATURE

/* Checks that the program was compiled as this library. */
static t3r_status agreed(uint64_t digest, t3r_fault *fault)
{
    const uint64_t differing = digest ^ t3r_header_interface();
    T3R_CHECK(fault, (differing & ~(uint64_t)(T3R_HAS_NONE T3R_FEATURE_ROWS(OR_FEATURE))) == 0, T3R_ERR_INTERFACE,
              "the program was compiled with another trim3r.h than this library's (" T3R_VERSION
              "), or by a compiler that lays structs out otherwise");
    T3R_CHECK(fault, differing == 0, T3R_ERR_INTERFACE,
              "this library was built with %, and the program otherwise: compile it with the same", differing);
    return T3R_OK;
}

static t3r_status planned(uint64_t digest, const t3r_config *config, const t3r_plan_info *plan, t3r_fault *fault)
{
    T3R_PASS(agreed(digest, fault));
    T3R_CHECK(fault, plan != NULL, T3R_ERR_ARGUMENT, "plan is NULL");
    return t3r_plan_bytes_checks(config, &plan->min_bytes, &plan->bytes, fault);
}

const char *t3r_plan_as_error(t3r_status status, uint64_t digest, const t3r_config *config, const t3r_plan_info *plan,
                              char *text, size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, planned(digest, config, plan, &fault), &fault, text, text_bytes);
}

const char *t3r_plan_bytes_as_error(t3r_status status, uint64_t digest, const t3r_config *config,
                                    const size_t *min_bytes, const size_t *bytes, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_status found = agreed(digest, &fault);
    found = found == T3R_OK ? t3r_plan_bytes_checks(config, min_bytes, bytes, &fault) : found;
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

const char *t3r_plan_within_as_error(t3r_status status, uint64_t digest, size_t bytes, const t3r_config *config,
                                     char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_status found = agreed(digest, &fault);
    found = found == T3R_OK ? t3r_plan_within_checks(bytes, config, &fault) : found;
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

const char *t3r_set_preset_as_error(t3r_status status, uint64_t digest, t3r_preset preset, const t3r_config *config,
                                    const char *const *weights, char *text, size_t text_bytes)
{
    (void)weights; /* may be NULL */
    t3r_fault fault;
    t3r_status found = agreed(digest, &fault);
    found = found == T3R_OK ? t3r_set_preset_checks(preset, config, &fault) : found;
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

/* Checks the pointer that t3r_init() and t3r_attach() fill, and the program. */
static t3r_status opened(uint64_t digest, t3r_runtime *const *rt, t3r_fault *fault)
{
    T3R_CHECK(fault, rt != NULL, T3R_ERR_ARGUMENT, "rt is NULL: it receives the runtime");
    return agreed(digest, fault);
}

const char *t3r_init_as_error(t3r_status status, uint64_t digest, t3r_runtime *const *rt, const void *arena,
                              size_t arena_bytes, const t3r_config *config, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_layout layout;
    t3r_status found = opened(digest, rt, &fault);
    found = found == T3R_OK ? t3r_init_checks(arena, arena_bytes, config, &layout, &fault) : found;
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

const char *t3r_attach_as_error(t3r_status status, uint64_t digest, t3r_runtime *const *rt, const void *arena,
                                size_t arena_bytes, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_layout layout;
    t3r_status found = opened(digest, rt, &fault);
    found = found == T3R_OK ? t3r_attach_checks(arena, arena_bytes, &layout, &fault) : found;
    if (found == T3R_OK && status == T3R_ERR_EPOCH) {
        t3r_note(&fault, "arena is damaged, or another build of this library laid it out", 0, 0, 0, 0);
        found = status;
    }
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

const char *t3r_set_cpu_error(t3r_status status, const t3r_runtime *rt, uint32_t features, char *text,
                              size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, t3r_set_cpu_checks(rt, features, &fault), &fault, text, text_bytes);
}

const char *t3r_bind_head_error(t3r_status status, const t3r_runtime *rt, const void *weights, size_t bytes, char *text,
                                size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, t3r_bind_head_checks(rt, weights, bytes, &fault), &fault, text, text_bytes);
}
