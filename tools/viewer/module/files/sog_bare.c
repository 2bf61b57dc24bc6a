/* SPDX-License-Identifier: Apache-2.0 */
/* .sog without the libraries that unpack it: the page unpacks the archive, and decodes its pictures
 * (files_archive.js). */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "host/reason.h"
#include "scene/formats/sog/sog.h"
#include "scene/formats/sog/sog_archive.h"
#include "scene/formats/sog/webp_texels.h"
#include "scene/scene_format.h"

#define MAGIC "PK\x03\x04"

const scene_format scene_format_sog_bare = {.suffix = ".sog", .magic = MAGIC, .parse = sog_parse};

/* Returns a copy of a member of the archive, followed by a 0 that `count` excludes; NULL: there is no such
 * member. */
__attribute__((import_module("page"), import_name("member"))) extern uint8_t *page_member(const char *name,
                                                                                          size_t *count);

/* There is one archive: the one that the page unpacked. */
struct sog_archive {
    char unused;
};

sog_archive *sog_archive_open(const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    static sog_archive only;
    if (count < sizeof MAGIC - 1 || memcmp(bytes, MAGIC, sizeof MAGIC - 1) != 0) {
        (void)t3r_reason(error, error_bytes, "no zip archive that can be read");
        return NULL;
    }
    return &only;
}

uint8_t *sog_archive_read(sog_archive *archive, const char *name, size_t *count, char *error, size_t error_bytes)
{
    (void)archive;
    uint8_t *member = page_member(name, count);
    if (member == NULL) {
        (void)t3r_reason(error, error_bytes, "%s: the archive does not hold it", name);
    }
    return member;
}

void sog_archive_close(sog_archive *archive)
{
    (void)archive;
}

/* Takes a decoded picture: width, height, and 4 bytes a texel. */
int webp_texels_read(const uint8_t *bytes, size_t count, uint64_t most, webp_texels *out, char *error,
                     size_t error_bytes)
{
    enum { HEADER = 8 };
    *out = (webp_texels){0};
    const uint64_t texels = count < HEADER ? 0 : (uint64_t)t3r_load_le32(bytes) * t3r_load_le32(bytes + 4);
    if (texels == 0 || texels > most || count != HEADER + 4 * texels) {
        return t3r_reason(error, error_bytes, "no lossless WebP picture of at most %" PRIu64 " texels", most);
    }
    out->rgba = malloc((size_t)(4 * texels));
    if (out->rgba == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu64 " texels", texels);
    }
    memcpy(out->rgba, bytes + HEADER, (size_t)(4 * texels));
    out->width = t3r_load_le32(bytes);
    out->height = t3r_load_le32(bytes + 4);
    return 0;
}

void webp_texels_free(webp_texels *texels)
{
    free(texels->rgba);
    *texels = (webp_texels){0};
}
