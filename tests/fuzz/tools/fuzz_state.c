/* SPDX-License-Identifier: Apache-2.0 */
/* Damages of the file of a stream (`replay --stream --state F --resume`): the replay continues to the end, or refuses
 * the file with a reason. The file's hash agrees with most damages, so that the fields are reached. */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "core/hash.h"
#include "reconstruction/replay/replay_stream.h"
#include "room/room.h"
#include "scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SIDE = 32, FRAMES = 4, SAVED_FRAMES = 3, BUDGET = 40, EDIT_BYTES = 6 };

/* Holds a recording, and the state after its first frames; made once. */
typedef struct sound {
    t3r_recording *recording;
    uint8_t *bytes;
    size_t count;
    char path[600]; /* of the state */
} sound;

static void write_room(const char *path)
{
    static uint8_t rgb[SIDE * SIDE * 3];
    static uint16_t depth[SIDE * SIDE];
    const t3r_recording_header header = {
        .camera = "camera", .source = "room", .clock = "synthetic", .depth_unit = 0.001};
    FILE *file = fopen(path, "wb");
    t3r_recorder *recorder = malloc(t3r_recorder_bytes());
    bool written = file != NULL && recorder != NULL && t3r_recorder_begin(recorder, t3r_file_sink(file), &header) == 0;
    for (uint32_t i = 0; i < FRAMES && written; i++) {
        t3r_recorded_frame frame = {.stamp_ns = (int64_t)i * 33333333,
                                    .format = T3R_PIXEL_RGB24,
                                    .width = SIDE,
                                    .height = SIDE,
                                    .planes = {rgb},
                                    .stride_bytes = {SIDE * 3},
                                    .depth = depth,
                                    .depth_width = SIDE,
                                    .depth_height = SIDE};
        room_frame(i, SIDE, SIDE, 1, rgb, depth);
        room_recorded_camera(i, SIDE, SIDE, &frame.camera);
        written = t3r_recorder_frame(recorder, &frame) == 0;
    }
    if (!written || t3r_recorder_end(recorder) != 0 || fclose(file) != 0) {
        abort();
    }
    free(recorder);
}

/* Replays the room up to that frame; with a state that exists, from there on. */
static int replay(const sound *s, uint32_t until)
{
    const replay_stream_options options = {
        .live = {.every = 2, .state = s->path, .resume = true}, .has_until = true, .until_frame = until, .json = true};
    const expectation none = {0};
    reconstruction_options settings;
    reconstruction_defaults(&settings);
    settings.gaussians = BUDGET;
    settings.head = "analytic";
    settings.config.refine = 1;
    return replay_stream(&options, s->recording, "room.mcap", &settings, &none);
}

static void read_state(sound *s)
{
    FILE *file = fopen(s->path, "rb");
    if (file == NULL || fseek(file, 0, SEEK_END) != 0) {
        abort();
    }
    s->count = (size_t)ftell(file);
    s->bytes = malloc(s->count);
    rewind(file);
    if (s->bytes == NULL || fread(s->bytes, 1, s->count, file) != s->count) {
        abort();
    }
    fclose(file);
}

static void write_state(const char *path, const uint8_t *bytes, size_t count)
{
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(bytes, 1, count, file) != count || fclose(file) != 0) {
        abort();
    }
}

static scratch folder;

static void remove_folder(void)
{
    scratch_close(&folder);
}

static sound make(void)
{
    char error[256] = "";
    sound s = {.recording = NULL};
    if (scratch_open(&folder) != 0 || atexit(remove_folder) != 0 || freopen("/dev/null", "w", stdout) == NULL) {
        abort();
    }
    write_room(scratch_path(&folder, "room.mcap"));
    s.recording = t3r_recording_open(folder.path, error, sizeof error);
    snprintf(s.path, sizeof s.path, "%s", scratch_path(&folder, "run.t3s"));
    if (s.recording == NULL || replay(&s, SAVED_FRAMES - 1) != CLI_OK) {
        abort();
    }
    read_state(&s);
    return s;
}

static void damage(uint8_t *bytes, size_t *count, const uint8_t *data, size_t size)
{
    const uint8_t kind = data[0];
    for (data++, size--; size >= EDIT_BYTES; data += EDIT_BYTES, size -= EDIT_BYTES) {
        const uint32_t value = (uint32_t)data[4] << (data[5] % 32), last = (uint32_t)(*count - sizeof value);
        uint32_t at;
        memcpy(&at, data, sizeof at);
        /* counts are near the beginning; rows and frames held back near the end */
        at = data[5] & 32 ? last - at % 4096 : data[5] & 64 ? at % 1024 : at % last;
        memcpy(bytes + at, &value, data[5] & 128 ? sizeof value : 1);
    }
    if (kind % 8 == 0) {
        *count -= *count * kind / 256;
    }
    if (kind % 4 != 1 && *count > sizeof(uint64_t)) {
        const uint64_t hash = t3r_hash_bytes(T3R_HASH_START, bytes, *count - sizeof hash);
        memcpy(bytes + *count - sizeof hash, &hash, sizeof hash);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static sound s;
    char error[512] = "";
    if (s.recording == NULL) {
        s = make();
    }
    if (size == 0) {
        return 0;
    }
    uint8_t *bytes = malloc(s.count);
    size_t count = s.count;
    memcpy(bytes, s.bytes, s.count);
    damage(bytes, &count, data, size);
    write_state(s.path, bytes, count);
    free(bytes);
    cli_keep_errors(error, sizeof error);
    const int code = replay(&s, FRAMES - 1);
    if (code != CLI_OK && error[0] == '\0') {
        abort();
    }
    return 0;
}
