#include "reconstruction/replay/replay_expectation.h"

#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "host/file_bytes.h"
#include "mcap/reader_limits.h"
#include "cli/tables/json_input.h"
#include "cli/tables/json_output.h"

#define ERROR_BYTES 512

static int read_hash(const cJSON *item, uint64_t *hash)
{
    return cJSON_IsString(item) && hash_parse(item->valuestring, hash) == 0 ? 0 : -1;
}

/* Reads an array of hashes, or of objects with one. */
static int read_hashes(const cJSON *array, uint64_t **hashes, uint32_t *hash_count)
{
    int count = cJSON_GetArraySize(array);
    *hashes = calloc((size_t)count + 1, sizeof **hashes);
    if (*hashes == NULL) {
        return -1;
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, array)
    {
        const cJSON *hash = cJSON_IsObject(item) ? cJSON_GetObjectItemCaseSensitive(item, "hash") : item;
        if (read_hash(hash, &(*hashes)[(*hash_count)++]) != 0) {
            return -1;
        }
    }
    return 0;
}

int expectation_read(expectation *e, const char *text)
{
    *e = (expectation){0};
    if (text == NULL) {
        return CLI_OK;
    }
    e->given = true;
    if (hash_parse(text, &e->hash) == 0) {
        return CLI_OK;
    }
    char error[ERROR_BYTES] = "";
    size_t count;
    uint8_t *bytes = t3r_file_bytes(text, T3R_LIMIT_TEXT_BYTES, &count, error, sizeof error);
    if (bytes == NULL) {
        return cli_error(CLI_BAD_INPUT, "--expect takes 16 hexadecimal digits or a file: %s", error);
    }
    cJSON *root = json_parse((const char *)bytes, count, error, sizeof error);
    free(bytes);
    const cJSON *stages = cJSON_GetObjectItemCaseSensitive(root, "stages");
    const cJSON *keyframes = cJSON_GetObjectItemCaseSensitive(root, "keyframes");
    const cJSON *tiles = cJSON_GetObjectItemCaseSensitive(root, "tiles");
    const char *wrong = NULL;
    if (root == NULL) {
        wrong = error;
    } else if (read_hash(cJSON_GetObjectItemCaseSensitive(root, "hash"), &e->hash) != 0) {
        wrong = "has no field hash of 16 hexadecimal digits";
    }
    for (int stage = 0; wrong == NULL && stage < T3R_STAGE_COUNT; stage++) {
        const cJSON *item = cJSON_GetObjectItemCaseSensitive(stages, t3r_stage_name((t3r_stage)stage));
        if (item != NULL) {
            e->has_stage[stage] = true;
            wrong =
                read_hash(item, &e->stage[stage]) == 0 ? NULL : "has a stage whose hash is not 16 hexadecimal digits";
        }
    }
    if (wrong == NULL && cJSON_IsArray(tiles) && read_hashes(tiles, &e->tiles, &e->tile_count) != 0) {
        wrong = "has a tile whose hash is not 16 hexadecimal digits";
    }
    if (wrong == NULL && cJSON_IsArray(keyframes) && read_hashes(keyframes, &e->keyframes, &e->keyframe_count) != 0) {
        wrong = "has a keyframe whose hash is not 16 hexadecimal digits";
    }
    cJSON_Delete(root);
    return wrong == NULL ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s: %s", text, wrong);
}

void expectation_free(expectation *e)
{
    free(e->tiles);
    free(e->keyframes);
    e->tiles = e->keyframes = NULL;
}

t3r_stage expectation_missed(const expectation *e, const reconstruction *r, uint64_t hash, char *text,
                             size_t text_bytes)
{
    text[0] = '\0';
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (e->has_stage[stage] && !(r->stage_hashed[stage] && e->stage[stage] == r->stage_hash[stage])) {
            snprintf(text, text_bytes, "stage %s", t3r_stage_name((t3r_stage)stage));
            return (t3r_stage)stage;
        }
    }
    if (e->given && e->hash != hash) {
        snprintf(text, text_bytes, "the final hash");
    }
    return T3R_STAGE_COUNT;
}

int expectation_verdict(const expectation *e, const char *recording, uint64_t hash, const char *difference, bool quiet)
{
    if (difference[0] != '\0') {
        char expected[HASH_TEXT_BYTES], found[HASH_TEXT_BYTES];
        hash_text(e->hash, expected);
        hash_text(hash, found);
        return cli_error(CLI_BAD_INPUT, "%s: expected %s, found %s; first difference: %s", recording, expected, found,
                         difference);
    }
    if (e->given && !quiet) {
        puts("as expected");
    }
    return CLI_OK;
}

void expectation_add(cJSON *object, const expectation *e, const char *difference)
{
    if (e->given) {
        json_add_hash(object, "expected", e->hash);
        cJSON_AddBoolToObject(object, "match", difference[0] == '\0');
        cJSON_AddStringToObject(object, "first_difference", difference);
    }
}
