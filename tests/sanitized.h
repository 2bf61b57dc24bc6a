/* SPDX-License-Identifier: Apache-2.0 */
/* Whether sanitizers run, or branches are counted: loops that only repeat may then take fewer rounds. */
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
