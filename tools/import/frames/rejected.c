/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/rejected.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "host/reason.h"
#include "import/frames/frame.h"

enum { REASON_BYTES = 1024 };
#define GONE UINT32_MAX

void rejected_mark(posed_frame *frame, const char *format, ...)
{
    char reason[REASON_BYTES];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    if (!frame->rejected) {
        frame->rejected = true;
        frame->wrong = strdup(reason);
    }
}

/* Keeps the triplets whose frames are all kept. places: the new index of each frame, or GONE. */
static int keep_triplets(posed_folder *folder, const uint32_t *places)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < folder->triplet_count; i++) {
        t3r_triplet triplet = folder->triplets[i];
        const uint32_t a = places[triplet.context[0]], b = places[triplet.context[1]], target = places[triplet.target];
        if (a != GONE && b != GONE && target != GONE) {
            triplet.context[0] = a;
            triplet.context[1] = b;
            triplet.target = target;
            folder->triplets[kept++] = triplet;
        }
    }
    const uint32_t lost = folder->triplet_count - kept;
    folder->triplet_count = kept;
    return lost == 0 ? 0
                     : text_list_add(&folder->remarks, "%" PRIu32 " triplets are left out with frames of theirs", lost);
}

int rejected_drop(posed_folder *folder, char *error, size_t error_bytes)
{
    uint32_t *places = malloc(((size_t)folder->frame_count + 1) * sizeof *places);
    const uint32_t count = folder->frame_count, noted = folder->left_out.frames.count;
    uint32_t kept = 0;
    int status = places != NULL ? 0 : -1;
    for (uint32_t i = 0; i < count && status == 0; i++) {
        posed_frame *frame = &folder->frames[i];
        const posed_frame moved = *frame;
        places[i] = frame->rejected ? GONE : kept;
        if (frame->rejected) {
            status = frame->wrong != NULL ? text_list_add(&folder->left_out.frames, "%s", frame->wrong) : -1;
            posed_frame_free(frame);
        } else {
            *frame = (posed_frame){0};
            folder->frames[kept++] = moved;
        }
    }
    if (status == 0) {
        folder->frame_count = kept;
        status = keep_triplets(folder, places);
    }
    free(places);
    if (status != 0) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    return kept > 0 || count == 0 ? 0 : t3r_reason(error, error_bytes, "%s", folder->left_out.frames.lines[noted]);
}

/* Makes one frame, and once more without depth if only that cannot be used. */
static int try_frame(const char *directory, posed_folder *folder, posed_frame *frame, uint32_t width, uint32_t height,
                     char *error, size_t error_bytes)
{
    int status = 0;
    for (bool again = true; again;) {
        import_buffers buffers;
        t3r_recorded_frame made;
        char reason[REASON_BYTES];
        status = import_frame(directory, frame, NULL, width, height, &buffers, &made, reason, sizeof reason);
        import_buffers_free(&buffers);
        again = status == IMPORT_NO_DEPTH;
        if (again) {
            free(frame->depth);
            frame->depth = NULL;
            status = text_list_add(&folder->left_out.depth, "%s", reason);
        } else if (status == IMPORT_NO_FRAME) {
            rejected_mark(frame, "%s", reason);
            status = 0;
        } else if (status != 0) {
            (void)t3r_reason(error, error_bytes, "%s", reason);
        }
    }
    return status;
}

int rejected_find(const char *directory, posed_folder *folder, uint32_t width, uint32_t height, char *error,
                  size_t error_bytes)
{
    const uint32_t noted = folder->left_out.depth.count;
    uint32_t with_depth = 0;
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        cli_progress("looking for what can be read", i, folder->frame_count);
        if (try_frame(directory, folder, &folder->frames[i], width, height, error, error_bytes) != 0) {
            return -1;
        }
        with_depth += folder->frames[i].depth != NULL && !folder->frames[i].rejected;
    }
    if (rejected_drop(folder, error, error_bytes) != 0) {
        return -1;
    }
    return with_depth > 0 || folder->left_out.depth.count == noted
               ? 0
               : t3r_reason(error, error_bytes, "%s", folder->left_out.depth.lines[noted]);
}
