/* SPDX-License-Identifier: Apache-2.0 */
#include "viewer/bundle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "viewer/bundle_layout.h"

#define MOST_BYTES (UINT64_C(1) << 30)

static void put_u16(FILE *out, uint32_t value)
{
    uint8_t bytes[2];
    t3r_store_le16(bytes, (uint16_t)value);
    fwrite(bytes, 1, sizeof bytes, out);
}

static void put_u32(FILE *out, uint32_t value)
{
    uint8_t bytes[4];
    t3r_store_le32(bytes, value);
    fwrite(bytes, 1, sizeof bytes, out);
}

static void put_u64(FILE *out, uint64_t value)
{
    put_u32(out, (uint32_t)value);
    put_u32(out, (uint32_t)(value >> 32));
}

static void align(FILE *out)
{
    for (long at = ftell(out); at % BUNDLE_ALIGN != 0; at++) {
        fputc(0, out);
    }
}

static void put_config(FILE *out, const t3r_config *config)
{
    uint32_t words[BUNDLE_CONFIG_WORDS];
    memcpy(words, config, sizeof words);
    put_u32(out, BUNDLE_CONFIG_WORDS);
    for (uint32_t i = 0; i < BUNDLE_CONFIG_WORDS; i++) {
        put_u32(out, words[i]);
    }
}

static void put_frame(FILE *out, const bundle_frame *f)
{
    const t3r_camera *c = &f->camera;
    put_u32(out, (uint32_t)c->fx_q16);
    put_u32(out, (uint32_t)c->fy_q16);
    put_u32(out, (uint32_t)c->cx_q16);
    put_u32(out, (uint32_t)c->cy_q16);
    for (int i = 0; i < 3; i++) {
        put_u64(out, (uint64_t)c->position_q32[i]);
    }
    for (int i = 0; i < 4; i++) {
        put_u32(out, (uint32_t)c->rotation_q30[i]);
    }
    put_u64(out, f->depth != NULL ? f->depth_unit_q40 : 0);
    put_u32(out, f->shown != NULL);
}

static void put_gaussian(FILE *out, const t3r_gaussian *g)
{
    for (int i = 0; i < 3; i++) {
        put_u32(out, (uint32_t)g->position_q20[i]);
    }
    for (int i = 0; i < 9; i++) {
        put_u16(out, (uint16_t)g->factor[i]);
    }
    fputc((uint8_t)g->factor_exponent, out);
    fputc(g->view, out);
    for (int i = 0; i < 3; i++) {
        put_u16(out, g->colour_q7[i]);
    }
    put_u16(out, g->opacity_q15);
    fputc(g->confidence, out);
}

static void put_far(FILE *out, const t3r_scene_far *far)
{
    uint64_t bits;
    memcpy(&bits, &far->times, sizeof bits);
    put_u32(out, far->index);
    put_u64(out, bits);
}

static void put_all(FILE *out, const bundle *b)
{
    const scene_file *scene = b->scene;
    const size_t pixels = (size_t)b->config.width * b->config.height;
    put_u32(out, BUNDLE_MAGIC);
    put_config(out, &b->config);
    put_u32(out, b->config.views);
    put_u32(out, b->frame_count);
    put_u32(out, (uint32_t)b->weight_bytes);
    put_u32(out, scene->count);
    put_u32(out, (uint32_t)scene->frame.exponent);
    for (int i = 0; i < 3; i++) {
        put_u64(out, (uint64_t)scene->frame.origin_q32[i]);
    }
    put_u32(out, scene->degree);
    put_u32(out, scene->mip);
    put_u32(out, scene->finer);
    put_u32(out, scene->far_count);
    for (uint32_t i = 0; i < b->frame_count; i++) {
        put_frame(out, &b->frames[i]);
    }
    align(out);
    if (b->weight_bytes > 0) {
        fwrite(b->weights, 1, b->weight_bytes, out);
    }
    for (uint32_t i = 0; i < b->frame_count; i++) {
        align(out);
        fwrite(b->frames[i].rgb, 3, pixels, out);
        if (b->frames[i].depth != NULL) {
            align(out);
            for (size_t at = 0; at < pixels; at++) {
                put_u16(out, b->frames[i].depth[at]);
            }
        }
        if (b->frames[i].shown != NULL) {
            align(out);
            fwrite(b->frames[i].shown, 1, pixels, out);
        }
    }
    align(out);
    for (uint32_t i = 0; i < scene->count; i++) {
        put_gaussian(out, &scene->gaussians[i]);
    }
    align(out);
    for (uint32_t i = 0; i < scene->far_count; i++) {
        put_far(out, &scene->far[i]);
    }
    align(out);
    for (size_t i = 0; scene->degree > 0 && i < scene->count * scene_file_harmonics_count(scene); i++) {
        put_u16(out, (uint16_t)scene->harmonics_q12[i]);
    }
}

uint8_t *bundle_bytes(const bundle *b, size_t *count)
{
    char *bytes = NULL;
    FILE *out = open_memstream(&bytes, count);
    if (out == NULL) {
        return NULL;
    }
    put_all(out, b);
    const int failed = ferror(out);
    if (fclose(out) != 0 || failed || *count > MOST_BYTES) {
        free(bytes);
        return NULL;
    }
    return (uint8_t *)bytes;
}
