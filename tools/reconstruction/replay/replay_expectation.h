/* SPDX-License-Identifier: Apache-2.0 */
/* The expected result of a replay: a hash, or the JSON of an earlier run. */
#ifndef TRIM3R_TOOLS_REPLAY_EXPECTATION_H
#define TRIM3R_TOOLS_REPLAY_EXPECTATION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cjson/cJSON.h>

#include "reconstruction/reconstruction.h"

/* The result of an earlier run; only the last field for a single hash. */
typedef struct expectation {
    bool given;
    bool has_stage[T3R_STAGE_COUNT];
    uint64_t stage[T3R_STAGE_COUNT];
    uint64_t *tiles; /* heap; NULL = none */
    uint32_t tile_count;
    uint64_t *keyframes; /* heap; for a stream, the hash after each keyframe; NULL = none */
    uint32_t keyframe_count;
    uint64_t hash;
} expectation;

/* Reads 16 hexadecimal digits or a file; NULL: nothing is expected. Returns an exit status of cli.h; call
 * expectation_free() in any case. */
int expectation_read(expectation *e, const char *text);
void expectation_free(expectation *e);

/* Returns the first stage whose hash differs, with its name in the text, or T3R_STAGE_COUNT for the hash of the whole;
 * the text is "" when all hashes are as expected. */
t3r_stage expectation_missed(const expectation *e, const reconstruction *r, uint64_t hash, char *text,
                             size_t text_bytes);

/* Reports the result, unless `quiet` and all matches; returns the exit status. */
int expectation_verdict(const expectation *e, const char *recording, uint64_t hash, const char *difference, bool quiet);
/* Adds the same to a JSON object. */
void expectation_add(cJSON *object, const expectation *e, const char *difference);

#endif
