/* SPDX-License-Identifier: Apache-2.0 */
#include "mjpeg.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>

#include <jpeglib.h>

#include "jpeg_damage.h"
#include "jpeg_scans.h"

struct t3r_mjpeg {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    t3r_jpeg_scans scans;
    jmp_buf back;
    bool ends_early; /* the image has no end marker */
    char message[JMSG_LENGTH_MAX];
};

static void give_up(j_common_ptr jpeg)
{
    t3r_mjpeg *self = jpeg->client_data;
    jpeg->err->format_message(jpeg, self->message);
    longjmp(self->back, 1);
}

static void emit(j_common_ptr jpeg, int level)
{
    t3r_mjpeg *self = jpeg->client_data;
    if (!t3r_jpeg_is_harmless(jpeg, level, &self->ends_early)) {
        give_up(jpeg);
    }
}

static void refuse(j_common_ptr jpeg, const char *reason)
{
    t3r_mjpeg *self = jpeg->client_data;
    snprintf(self->message, sizeof self->message, "%s", reason);
    longjmp(self->back, 1);
}

static int create(t3r_mjpeg *self)
{
    self->jpeg.err = jpeg_std_error(&self->errors);
    self->errors.error_exit = give_up;
    self->errors.emit_message = emit;
    self->jpeg.client_data = self;
    if (setjmp(self->back) != 0) {
        return -1;
    }
    jpeg_create_decompress(&self->jpeg); /* keeps err and client_data */
    t3r_jpeg_watch_scans(&self->jpeg, &self->scans, refuse);
    return 0;
}

t3r_mjpeg *t3r_mjpeg_open(void)
{
    t3r_mjpeg *self = calloc(1, sizeof *self);
    if (self == NULL) {
        return NULL;
    }
    if (create(self) != 0) {
        free(self);
        return NULL;
    }
    return self;
}

void t3r_mjpeg_close(t3r_mjpeg *self)
{
    if (self != NULL) {
        jpeg_destroy_decompress(&self->jpeg);
        free(self);
    }
}

const char *t3r_mjpeg_decode(t3r_mjpeg *self, const uint8_t *jpeg, size_t bytes, uint32_t width, uint32_t height,
                             uint8_t *rgb)
{
    if (setjmp(self->back) != 0) {
        jpeg_abort_decompress(&self->jpeg);
        return self->message;
    }
    self->ends_early = false;
    jpeg_mem_src(&self->jpeg, jpeg, (unsigned long)bytes);
    jpeg_read_header(&self->jpeg, TRUE);
    if (self->jpeg.image_width != width || self->jpeg.image_height != height) {
        jpeg_abort_decompress(&self->jpeg);
        return "the JPEG has another size";
    }
    self->jpeg.out_color_space = JCS_RGB;
    self->jpeg.dct_method = JDCT_ISLOW;
    self->jpeg.do_fancy_upsampling = FALSE;
    jpeg_start_decompress(&self->jpeg);
    while (self->jpeg.output_scanline < height) {
        JSAMPROW row = rgb + (size_t)self->jpeg.output_scanline * width * 3;
        jpeg_read_scanlines(&self->jpeg, &row, 1);
    }
    if (self->ends_early && !t3r_jpeg_is_whole(&self->jpeg)) {
        refuse((j_common_ptr)&self->jpeg, "the image ends before its last scans");
    }
    jpeg_finish_decompress(&self->jpeg);
    return NULL;
}
