/* SPDX-License-Identifier: Apache-2.0 */
/* Sentences about errors of calls that plan and open an arena, and bind something to a runtime. */
#include "api/bind_head_checks.h"
#include "api/open_checks.h"
#include "sentence.h"

/* Shows a feature of this library, as "stereo=0". */
#define FEATURE_TEXT_(FEATURE, name) " " #name "=" T3R_TEXT_(T3R_FEATURE_##FEATURE)

/* Writes the sentence of a program that was compiled otherwise than the library. */
static t3r_status mismatched(t3r_fault *fault)
{
    t3r_note(fault,
             "the program was compiled with another trim3r.h than this library's (" T3R_VERSION
             "), with other T3R_FEATURE_... than its" T3R_FEATURE_ROWS(
                 FEATURE_TEXT_) ", or by a compiler that lays structs out otherwise",
             0, 0, 0, 0);
    return T3R_ERR_INTERFACE;
}

static t3r_status planned(const t3r_config *config, const t3r_plan_info *plan, t3r_fault *fault)
{
    T3R_CHECK(fault, plan != NULL, T3R_ERR_ARGUMENT, "plan is NULL");
    return t3r_plan_bytes_checks(config, &plan->min_bytes, &plan->bytes, fault);
}

const char *t3r_plan_error(t3r_status status, const t3r_config *config, const t3r_plan_info *plan, char *text,
                           size_t text_bytes)
{
    t3r_fault fault;
    const t3r_status found = status == T3R_ERR_INTERFACE ? mismatched(&fault) : planned(config, plan, &fault);
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

const char *t3r_plan_bytes_error(t3r_status status, const t3r_config *config, const size_t *min_bytes,
                                 const size_t *bytes, char *text, size_t text_bytes)
{
    t3r_fault fault;
    const t3r_status found =
        status == T3R_ERR_INTERFACE ? mismatched(&fault) : t3r_plan_bytes_checks(config, min_bytes, bytes, &fault);
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

const char *t3r_plan_within_error(t3r_status status, size_t bytes, const t3r_config *config, char *text,
                                  size_t text_bytes)
{
    t3r_fault fault;
    const t3r_status found =
        status == T3R_ERR_INTERFACE ? mismatched(&fault) : t3r_plan_within_checks(bytes, config, &fault);
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

/* Checks the pointer that t3r_init() and t3r_attach() fill. */
static t3r_status opened(t3r_status status, t3r_runtime *const *rt, t3r_fault *fault)
{
    T3R_CHECK(fault, rt != NULL, T3R_ERR_ARGUMENT, "rt is NULL: it receives the runtime");
    return status == T3R_ERR_INTERFACE ? mismatched(fault) : T3R_OK;
}

const char *t3r_init_error(t3r_status status, t3r_runtime *const *rt, const void *arena, size_t arena_bytes,
                           const t3r_config *config, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_layout layout;
    t3r_status found = opened(status, rt, &fault);
    found = found == T3R_OK ? t3r_init_checks(arena, arena_bytes, config, &layout, &fault) : found;
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

const char *t3r_attach_error(t3r_status status, t3r_runtime *const *rt, const void *arena, size_t arena_bytes,
                             char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_layout layout;
    t3r_status found = opened(status, rt, &fault);
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
