/* SPDX-License-Identifier: Apache-2.0 */
/* 3DGS .ply, binary little-endian, with f_rest only for harmonics above degree 0: readers take their number from the
 * header. */
#include "scene/formats/ply/ply.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "host/little_floats.h"
#include "scene/scene_rows.h"

static void write_properties(FILE *file, const char *names)
{
    for (const char *name = names; *name != '\0';) {
        const size_t length = strcspn(name, " ");
        fprintf(file, "property float %.*s\n", (int)length, name);
        name += length + strspn(name + length, " ");
    }
}

static void put_floats(FILE *file, const double *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint8_t bytes[4];
        t3r_store_float(bytes, values[i]);
        fwrite(bytes, 1, sizeof bytes, file);
    }
}

static void put_vertex(FILE *file, const scene_row *row, uint32_t degree)
{
    const uint32_t rest = harmonics_rest(degree);
    put_floats(file, row->position, 3);
    put_floats(file, (const double[3]){0}, 3);
    put_floats(file, row->harmonic, 3);
    for (uint32_t i = 0; i < 3 * rest; i++) {
        put_floats(file, &row->rest[i % rest][i / rest], 1);
    }
    put_floats(file, &row->opacity_logit, 1);
    put_floats(file, row->log_scale, 3);
    put_floats(file, row->rotation, 4);
}

static void write_header(FILE *file, const scene_source *source)
{
    fputs("ply\nformat binary_little_endian 1.0\n", file);
    fputs(source->rows->mip ? PLY_MIP_COMMENT "\n" : "", file);
    if (source->flags & T3R_SCENE_COMMENTS) {
        fprintf(file, "comment trim3r bits_epoch %d\n", T3R_BITS_EPOCH);
        fprintf(file, "comment trim3r exponent %" PRId32 "\n", source->frame.exponent);
        int64_t origin_q32[3];
        scene_turn_origin(&source->turn, source->frame.origin_q32, origin_q32);
        fprintf(file, "comment trim3r origin_q32 %" PRId64 " %" PRId64 " %" PRId64 "\n", origin_q32[0], origin_q32[1],
                origin_q32[2]);
        fprintf(file, "comment trim3r local %d\n", (source->flags & T3R_SCENE_LOCAL) != 0);
        if (source->note != NULL) {
            fprintf(file, "comment trim3r %s\n", source->note);
        }
    }
    fprintf(file, "element vertex %" PRIu32 "\n", source->rows->count);
    write_properties(file, "x y z nx ny nz f_dc_0 f_dc_1 f_dc_2");
    for (uint32_t i = 0; i < 3 * harmonics_rest(source->degree); i++) {
        fprintf(file, "property float f_rest_%" PRIu32 "\n", i);
    }
    write_properties(file, "opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3");
    if (source->rows->backdrop > 0) { /* not above: some readers expect the element in the third line */
        fprintf(file, PLY_BACKDROP_COMMENT "%" PRIu32 "\n", source->rows->backdrop);
    }
    fputs("end_header\n", file);
}

int ply_write(FILE *file, const scene_source *source, char *error, size_t error_bytes)
{
    (void)error;
    (void)error_bytes;
    write_header(file, source);
    for (uint32_t i = 0; i < source->rows->count; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        put_vertex(file, &row, source->degree);
    }
    return 0;
}
