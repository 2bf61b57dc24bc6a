/* What a replay is to find again: a hash, or the JSON of an earlier run. */
#ifndef TRIM3R_TOOLS_REPLAY_EXPECTATION_H
#define TRIM3R_TOOLS_REPLAY_EXPECTATION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cjson/cJSON.h>

#include "reconstruction/reconstruction.h"

/* What an earlier run found: of a lone hash only the last field. */
typedef struct expectation {
    bool given;
    bool has_stage[T3R_STAGE_COUNT];
    uint64_t stage[T3R_STAGE_COUNT];
    uint64_t *tiles; /* heap; NULL = none */
    uint32_t tile_count;
    uint64_t *keyframes; /* heap; of a stream, the hash behind each; NULL = none */
    uint32_t keyframe_count;
    uint64_t hash;
} expectation;

/* From 16 hexadecimal digits or a file; NULL: nothing is expected. An exit status of cli.h; expectation_free() is due
 * whatever it is. */
int expectation_read(expectation *e, const char *text);
void expectation_free(expectation *e);

/* The first stage whose hash differs, named in the text, or the hash of the whole as T3R_STAGE_COUNT; "" when all is as
 * expected. */
t3r_stage expectation_missed(const expectation *e, const reconstruction *r, uint64_t hash, char *text,
                             size_t text_bytes);

/* Says how it went, unless `quiet` when all is well; the exit status. */
int expectation_verdict(const expectation *e, const char *recording, uint64_t hash, const char *difference, bool quiet);
/* The same among the fields of a JSON object. */
void expectation_add(cJSON *object, const expectation *e, const char *difference);

#endif
