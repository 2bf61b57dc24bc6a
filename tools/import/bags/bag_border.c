/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/bag_border.h"

#include "cli/cli.h"
#include "host/reason.h"
#include "import/bags/bag_size.h"
#include "import/frames/crop.h"

/* Makes the edges even, so that pixels which share a colour stay together. */
static void make_even(t3r_crop *part)
{
    const uint32_t right = (part->x + part->width) & ~1u, bottom = (part->y + part->height) & ~1u;
    part->x += part->x & 1;
    part->y += part->y & 1;
    part->width = right - part->x;
    part->height = bottom - part->y;
}

static bool shares_colours(t3r_pixel_format format)
{
    return format == T3R_PIXEL_YUYV || format == T3R_PIXEL_UYVY || format == T3R_PIXEL_NV12;
}

const char *bag_border_find(const t3r_recording *recording, picture_inner *inner)
{
    const uint32_t count = t3r_recording_frame_count(recording);
    const char *wrong = NULL;
    bool shared = false;
    border_search search;
    border_search_begin(&search);
    for (uint32_t i = 0; i < count && search.possible && wrong == NULL; i++) {
        char error[512], lost[512];
        t3r_capture_frame frame;
        cli_progress("looking for a border", i, count);
        if (t3r_recording_frame_readable(recording, i, &frame, lost, sizeof lost, error, sizeof error) ==
            T3R_CAPTURE_FRAME) {
            picture colour;
            shared = shared || shares_colours(frame.frame.format);
            wrong = bag_size_colour(&frame.frame, &colour);
            if (wrong == NULL && border_search_add(&search, &colour) != 0) {
                wrong = "out of memory";
            }
            picture_free(&colour);
        }
    }
    *inner = border_search_end(&search);
    if (inner->width != 0 && shared) {
        make_even(&inner->part);
    }
    return wrong;
}

int bag_border_cut(const picture_inner *inner, t3r_capture_frame *frame, char *error, size_t error_bytes)
{
    t3r_frame *f = &frame->frame;
    if (inner->width == 0) {
        return 0;
    }
    if (f->width != inner->width || f->height != inner->height) {
        return t3r_reason(error, error_bytes, "%ux%u pixels, but the border is that of %ux%u", f->width, f->height,
                          inner->width, inner->height);
    }
    if (f->depth != NULL) {
        const t3r_crop part =
            import_crop_in_proportion(&inner->part, f->width, f->height, f->depth_width, f->depth_height);
        f->depth += (size_t)part.y * f->depth_stride_bytes + (size_t)part.x * 2;
        f->depth_width = part.width;
        f->depth_height = part.height;
    }
    bag_size_crop(&inner->part, f);
    bag_size_crop_camera(&inner->part, &frame->camera);
    return 0;
}
