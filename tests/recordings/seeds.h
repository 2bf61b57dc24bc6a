/* SPDX-License-Identifier: Apache-2.0 */
/* Recordings to start a fuzzer from: small, whole and cut, chunked and not, without CRCs where these would reject
 * every changed byte. */
#ifndef T3R_TESTS_SEEDS_H
#define T3R_TESTS_SEEDS_H

/* Writes the seeds into an existing folder; 0, or -1. */
int seeds_write(const char *folder);

#endif
