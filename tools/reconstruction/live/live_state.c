/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/live/live_state.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "core/hash.h"
#include "host/file_bytes.h"
#include "reconstruction/options/settings.h"

#define MAGIC "T3RSTATE"
#define ERROR_BYTES 512
#define MORE_MOST ((size_t)1 << 30)

/* Fields whose change makes another stream, compared as bytes. */
typedef struct identity {
    char magic[8];
    uint64_t interface; /* t3r_interface() */
    t3r_config config;
    uint32_t every, overlap_q8;
    char head_crc[12];
    uint64_t arena_bytes;
} identity;

typedef struct file_head {
    identity of;
    uint32_t since, keyframes;
    uint64_t stage_hash[T3R_STAGE_COUNT];
    uint8_t stage_hashed[T3R_STAGE_COUNT];
    uint64_t lines_bytes, more_bytes;
} file_head;

static void identify(const live_map *map, identity *of)
{
    memset(of, 0, sizeof *of); /* also the padding */
    memcpy(of->magic, MAGIC, sizeof of->magic);
    of->interface = t3r_interface();
    of->config = map->r.config;
    of->every = map->options.every;
    of->overlap_q8 = map->options.overlap_q8;
    memcpy(of->head_crc, map->r.head.crc, sizeof map->r.head.crc);
    of->arena_bytes = map->r.arena_bytes;
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

static void put(FILE *out, const void *bytes, size_t count, uint64_t *hash)
{
    if (count > 0) { /* else bytes may be NULL */
        fwrite(bytes, 1, count, out);
        *hash = t3r_hash_bytes(*hash, bytes, count);
    }
}

int live_state_write(const char *path, const live_map *map, const live_state *state)
{
    char error[ERROR_BYTES] = "";
    t3r_whole_file file;
    file_head head;
    memset(&head, 0, sizeof head);
    identify(map, &head.of);
    head.since = map->since;
    head.keyframes = map->keyframes;
    memcpy(head.stage_hash, map->r.stage_hash, sizeof head.stage_hash);
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        head.stage_hashed[stage] = map->r.stage_hashed[stage];
    }
    head.lines_bytes = state->lines_bytes;
    head.more_bytes = state->more_bytes;
    if (whole_file_begin(&file, path, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    uint64_t hash = T3R_HASH_START;
    put(file.stream, &head, sizeof head, &hash);
    put(file.stream, map->r.arena, map->r.arena_bytes, &hash);
    put(file.stream, state->more, state->more_bytes, &hash);
    fwrite(&hash, 1, sizeof hash, file.stream);
    return t3r_whole_file_commit(&file, NULL, error, sizeof error) == 0 ? CLI_OK
                                                                        : cli_error(CLI_BAD_INPUT, "%s", error);
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

/* Reports the first difference that a user can name. */
static int refuse(const char *path, const identity *saved, const identity *wanted)
{
    if (memcmp(saved->magic, wanted->magic, sizeof wanted->magic) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: not the state of a stream", path);
    }
    if (saved->interface != wanted->interface) {
        return cli_error(CLI_BAD_INPUT, "%s: written by another version of this program", path);
    }
    for (uint32_t i = 0; i < settings_count; i++) {
        const setting *s = &settings_table[i];
        if (setting_value(s, &saved->config) != setting_value(s, &wanted->config)) {
            char text[32];
            setting_text(s, &saved->config, text, sizeof text);
            return cli_error(CLI_BAD_INPUT, "%s: written with --%s %s", path, s->option, text);
        }
    }
    const char *other = saved->every != wanted->every             ? "--every"
                        : saved->overlap_q8 != wanted->overlap_q8 ? "--overlap"
                        : memcmp(saved->head_crc, wanted->head_crc, sizeof wanted->head_crc) != 0
                            ? "--head"
                            : "--working, --at-hand, --threads, --arena or budget";
    return cli_error(CLI_BAD_INPUT, "%s: written with another %s", path, other);
}

static int take(const char *path, const uint8_t *bytes, size_t count, live_map *map, live_state *state)
{
    file_head head;
    identity wanted;
    uint64_t hash;
    identify(map, &wanted);
    memset(&head, 0, sizeof head);
    memcpy(&head, bytes, count < sizeof head ? count : sizeof head);
    if (memcmp(&head.of, &wanted, sizeof wanted) != 0) {
        return refuse(path, &head.of, &wanted);
    }
    const size_t arena_bytes = map->r.arena_bytes, fixed_bytes = sizeof head + arena_bytes + sizeof hash;
    if (count < fixed_bytes || head.more_bytes != count - fixed_bytes ||
        (memcpy(&hash, bytes + count - sizeof hash, sizeof hash), hash) !=
            t3r_hash_bytes(T3R_HASH_START, bytes, count - sizeof hash)) {
        return cli_error(CLI_BAD_INPUT, "%s: damaged", path);
    }
    const t3r_config own = *t3r_get_config(map->r.runtime);
    memcpy(map->r.arena, bytes + sizeof head, arena_bytes);
    memcpy(map->r.stage_hash, head.stage_hash, sizeof head.stage_hash);
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        map->r.stage_hashed[stage] = head.stage_hashed[stage] != 0;
    }
    map->since = head.since;
    map->keyframes = head.keyframes;
    *state = (live_state){
        .lines_bytes = head.lines_bytes, .more = malloc(head.more_bytes + 1), .more_bytes = head.more_bytes};
    if (state->more == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    memcpy(state->more, bytes + sizeof head + arena_bytes, head.more_bytes);
    const int code = live_map_attach(map);
    if (code == CLI_OK && memcmp(t3r_get_config(map->r.runtime), &own, sizeof own) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: its arena has other settings", path); /* fewer workers than threads, say */
    }
    return code;
}

int live_state_read(const char *path, live_map *map, live_state *state)
{
    char error[ERROR_BYTES] = "";
    size_t count;
    *state = (live_state){0};
    uint8_t *bytes = t3r_file_bytes(path, map->r.arena_bytes + MORE_MOST, &count, error, sizeof error);
    if (bytes == NULL) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    const int code = take(path, bytes, count, map, state);
    free(bytes);
    return code;
}
