/* SPDX-License-Identifier: Apache-2.0 */
#include "trim3r/scene/scene_source.h"

#include "cli/cli.h"
#include "host/reason.h"
#include "import/bags/bag_frames.h"
#include "import/bags/bag_pictures.h"
#include "import/folders/posed_folder.h"
#include "import/frames/frame.h"
#include "import/import_source.h"
#include "recording/recording.h"

#define ERROR_BYTES 1024
#define SAMPLED_MOST 8u /* frames of a bag whose poses are composed before it is imported */

static int look_at_folder(scene_source *source, const char *path)
{
    char error[ERROR_BYTES] = "";
    posed_folder folder;
    posed_folder_options how = posed_folder_look(path);
    how.without_poses = true; /* they are estimated where they are missing */
    int status = posed_folder_open(path, &how, &folder, error, sizeof error);
    for (uint32_t i = 0; i < folder.frame_count && status == 0; i++) {
        const posed_frame *frame = &folder.frames[i];
        source->posed += frame->posed;
        source->with_depth += frame->depth != NULL || frame->pointmap != NULL;
    }
    if (status == 0) {
        source->kind = folder.kind;
        source->frames = folder.frame_count;
        status = -1;
    }
    for (uint32_t i = 0; i < folder.frame_count && status != 0; i++) { /* the first picture that can be read */
        status = import_picture_size(path, &folder.frames[i], &source->width, &source->height, error, sizeof error);
    }
    posed_folder_close(&folder);
    return status == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s", error);
}

/* Returns to how many frames import gives a pose, by transforms or from another frame; found by a sample of them. */
static uint32_t composed_poses(const t3r_recording *recording)
{
    char error[ERROR_BYTES];
    bag_frames frames;
    const uint32_t count = t3r_recording_frame_count(recording), sampled = count < SAMPLED_MOST ? count : SAMPLED_MOST;
    uint32_t made = 0;
    const int status = bag_frames_open(&frames, recording, &(bag_frames_options){0}, error, sizeof error);
    for (uint32_t i = 0; i < sampled && status == 0; i++) {
        const uint32_t index = (uint32_t)((uint64_t)i * count / sampled);
        t3r_capture_frame frame;
        made += t3r_recording_frame(recording, index, &frame, error, sizeof error) == T3R_CAPTURE_FRAME &&
                bag_frames_make(&frames, index, &frame, error, sizeof error) == 0;
    }
    const uint32_t posed = made > frames.unposed ? made - frames.unposed : 0;
    bag_frames_close(&frames);
    return sampled > 0 ? (uint32_t)((uint64_t)posed * count / sampled) : 0;
}

static int look_at_recording(scene_source *source, const char *path)
{
    char error[ERROR_BYTES] = "";
    t3r_recording *recording = import_source_open(path);
    if (recording == NULL) {
        return CLI_BAD_INPUT;
    }
    bag_pictures pictures = {.large = true};
    t3r_recording_set_decoder(recording, bag_pictures_decoder(&pictures));
    const t3r_pairing_info pairing = t3r_recording_pairing(recording);
    source->is_recording = t3r_recording_import_reason(recording)[0] == '\0';
    source->kind = source->is_recording ? "a recording" : "a bag";
    source->frames = t3r_recording_frame_count(recording);
    source->posed = pairing.with_pose > 0 || source->is_recording ? pairing.with_pose : composed_poses(recording);
    source->with_depth = pairing.with_depth;
    for (uint32_t i = 0; i < source->frames && source->width == 0; i++) {
        t3r_capture_frame frame;
        if (t3r_recording_frame(recording, i, &frame, error, sizeof error) == T3R_CAPTURE_FRAME) {
            source->width = frame.frame.width;
            source->height = frame.frame.height;
        }
    }
    if (source->frames == 0) {
        const char *asks = t3r_recording_asks(recording);
        (void)t3r_reason(error, sizeof error, "no frames: %s", asks[0] != '\0' ? asks : t3r_recording_note(recording));
    }
    t3r_recording_close(recording);
    bag_pictures_free(&pictures);
    return source->width > 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s: %s", path, error);
}

int scene_source_look(scene_source *source, const char *path)
{
    const char *advice;
    *source = (scene_source){.frames = 0};
    switch (import_source_of(path, &advice)) {
    case IMPORT_FOLDER:
        return look_at_folder(source, path);
    case IMPORT_FOREIGN:
        return cli_error(CLI_BAD_INPUT, "%s: %s", path, advice);
    case IMPORT_RECORDING:
    default:
        return look_at_recording(source, path);
    }
}
