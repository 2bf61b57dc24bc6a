/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/unreadable.h"

#include <inttypes.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "host/reason.h"
#include "import/frames/frame.h"

enum { REASON_BYTES = 512 };
#define GONE UINT32_MAX

typedef struct sorting {
    uint32_t *places; /* the new index of each frame, or GONE */
    uint32_t kept, with_depth, depth_lost;
    char first_reason[REASON_BYTES], first_depth_reason[REASON_BYTES];
} sorting;

/* Sorts out one frame: moves it to its new place, or drops it without one. */
static int sort_frame(const char *directory, posed_folder *folder, uint32_t index, sorting *s)
{
    posed_frame *frame = &folder->frames[index];
    char reason[REASON_BYTES];
    s->places[index] = GONE;
    if (import_check_picture(directory, frame, reason, sizeof reason) != 0) {
        (void)t3r_reason(s->first_reason, s->first_reason[0] == '\0' ? REASON_BYTES : 0, "%s", reason);
        posed_frame_free(frame);
        return text_list_add(&folder->left_out, "%s", reason);
    }
    if (frame->depth != NULL && import_check_depth(directory, frame, reason, sizeof reason) != 0) {
        (void)t3r_reason(s->first_depth_reason, s->first_depth_reason[0] == '\0' ? REASON_BYTES : 0, "%s", reason);
        free(frame->depth);
        frame->depth = NULL;
        s->depth_lost++;
        if (text_list_add(&folder->remarks, "depth is left out: %s", reason) != 0) {
            return -1;
        }
    }
    s->with_depth += frame->depth != NULL;
    s->places[index] = s->kept;
    const posed_frame moved = *frame;
    *frame = (posed_frame){0};
    folder->frames[s->kept++] = moved;
    return 0;
}

/* Keeps the triplets whose frames are all kept. */
static int keep_triplets(posed_folder *folder, const sorting *s)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < folder->triplet_count; i++) {
        t3r_triplet triplet = folder->triplets[i];
        const uint32_t a = s->places[triplet.context[0]], b = s->places[triplet.context[1]],
                       target = s->places[triplet.target];
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

int unreadable_leave_out(const char *directory, posed_folder *folder, char *error, size_t error_bytes)
{
    sorting s = {.places = malloc(((size_t)folder->frame_count + 1) * sizeof *s.places)};
    int status = s.places != NULL ? 0 : -1;
    const uint32_t count = folder->frame_count;
    for (uint32_t i = 0; i < count && status == 0; i++) {
        cli_progress("looking for what can be read", i, count);
        status = sort_frame(directory, folder, i, &s);
    }
    if (status == 0) {
        folder->frame_count = s.kept;
        status = keep_triplets(folder, &s);
    }
    if (status != 0) {
        status = t3r_reason(error, error_bytes, "out of memory");
    } else if (s.kept == 0) {
        status = t3r_reason(error, error_bytes, "%s", s.first_reason);
    } else if (s.depth_lost > 0 && s.with_depth == 0) {
        status = t3r_reason(error, error_bytes, "%s", s.first_depth_reason);
    }
    free(s.places);
    return status;
}
