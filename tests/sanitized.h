/* SPDX-License-Identifier: Apache-2.0 */
/* Whether sanitizers watch, or branches are counted: what only repeats may then repeat less. */
#ifndef TRIM3R_TESTS_SANITIZED_H
#define TRIM3R_TESTS_SANITIZED_H

#ifndef __has_feature
#define __has_feature(x) 0 /* clang's */
#endif

#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__ || __has_feature(address_sanitizer) ||                 \
    defined T3R_COVERAGE
#define T3R_SANITIZED 1
#else
#define T3R_SANITIZED 0
#endif

#endif
