/* SPDX-License-Identifier: Apache-2.0 */
/* Checks with sentences. A list of checks is an inline function with a `fault`, which two functions instantiate. A call
 * of the interface passes NULL: it needs the status alone, and the compiler drops the sentences. The function of the
 * same name with the suffix _error passes a fault, and runs the same checks again to find the sentence. */
#ifndef T3R_FAULT_H
#define T3R_FAULT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "assertion.h"
#include "trim3r.h"

/* The sentence of a failed check. */
typedef struct t3r_fault {
    const char *text;  /* # stands for the next number, @ for it without a sign, % for the features that are its bits */
    const char *after; /* NULL, or what follows the text */
    int64_t number[4];
} t3r_fault;

void t3r_note(t3r_fault *fault, const char *text, int64_t first, int64_t second, int64_t third, int64_t fourth);

#define T3R_NOTE_(fault, text, first, second, third, fourth, ...)                                                      \
    t3r_note((fault), (text), (int64_t)(first), (int64_t)(second), (int64_t)(third), (int64_t)(fourth))

/* Leaves the list with the status unless the condition holds. The sentence and up to four numbers follow; they are
 * evaluated only if a fault is wanted. */
#define T3R_CHECK(fault, condition, status, ...)                                                                       \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            if ((fault) != NULL) {                                                                                     \
                T3R_NOTE_(fault, __VA_ARGS__, 0, 0, 0, 0, 0);                                                          \
            }                                                                                                          \
            return (status);                                                                                           \
        }                                                                                                              \
    } while (0)

/* Does the same for misuse of the interface: a null pointer, or calls out of order. A debug build may stop there. */
#define T3R_MISUSE(fault, condition, status, ...)                                                                      \
    do {                                                                                                               \
        T3R_ASSERT((fault) != NULL || (condition));                                                                    \
        T3R_CHECK(fault, condition, status, __VA_ARGS__);                                                              \
    } while (0)

/* Leaves the list with the status of another list, or of a check that has one, unless it is T3R_OK. */
#define T3R_PASS(checks)                                                                                               \
    do {                                                                                                               \
        const t3r_status passed_ = (checks);                                                                           \
        if (passed_ != T3R_OK) {                                                                                       \
            return passed_;                                                                                            \
        }                                                                                                              \
    } while (0)

/* A list of checks, and a condition in one. Both instances are inlined, so that the call keeps its size. Where branches
 * are counted, they share a function instead: an inlined one has only those that its arguments leave open. */
#ifdef T3R_CHECKS_APART
#define T3R_LIST_ static __attribute__((noinline, unused))
#else
#define T3R_LIST_ static inline __attribute__((always_inline))
#endif
#define T3R_CHECKS T3R_LIST_ t3r_status
#define T3R_CONDITION T3R_LIST_ bool

/* Checks the argument that most calls have. */
T3R_CHECKS t3r_runtime_checks(const t3r_runtime *rt, t3r_fault *fault)
{
    T3R_MISUSE(fault, rt != NULL, T3R_ERR_ARGUMENT, "rt is NULL: t3r_init() and t3r_attach() make a runtime");
    return T3R_OK;
}

#endif
