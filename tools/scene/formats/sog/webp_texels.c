/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/sog/webp_texels.h"

#include <errno.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/reason.h"

void webp_texels_free(webp_texels *texels)
{
    free(texels->rgba);
    *texels = (webp_texels){0};
}

#ifdef T3R_WEBP

#include <webp/decode.h>
#include <webp/encode.h>

int webp_texels_read(const uint8_t *bytes, size_t count, uint64_t most, webp_texels *out, char *error,
                     size_t error_bytes)
{
    int width = 0, height = 0;
    *out = (webp_texels){0};
    if (WebPGetInfo(bytes, count, &width, &height) == 0) {
        return t3r_reason(error, error_bytes, "not a WebP picture");
    }
    const uint64_t texels = (uint64_t)width * (uint64_t)height;
    if (texels > most) {
        return t3r_reason(error, error_bytes, "a picture of %dx%d; at most %" PRIu64 " texels are read", width, height,
                          most);
    }
    out->rgba = malloc((size_t)texels * 4);
    if (out->rgba == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for a picture of %dx%d", width, height);
    }
    if (WebPDecodeRGBAInto(bytes, count, out->rgba, (size_t)texels * 4, width * 4) == NULL) {
        webp_texels_free(out);
        return t3r_reason(error, error_bytes, "a damaged WebP picture");
    }
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    return 0;
}

/* Encodes exactly, including the bytes of texels with an alpha of 0. */
static int encode(const webp_texels *texels, WebPMemoryWriter *writer)
{
    enum { LEVEL = 6 };
    WebPConfig config;
    WebPPicture picture;
    if (!WebPConfigInit(&config) || !WebPConfigLosslessPreset(&config, LEVEL) || !WebPPictureInit(&picture)) {
        return -1;
    }
    config.exact = 1;
    picture.use_argb = 1;
    picture.width = (int)texels->width;
    picture.height = (int)texels->height;
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = writer;
    const int made = WebPPictureImportRGBA(&picture, texels->rgba, 4 * (int)texels->width) &&
                     WebPEncode(&config, &picture) && picture.error_code == VP8_ENC_OK;
    WebPPictureFree(&picture);
    return made ? 0 : -1;
}

static bool is_whole(const webp_texels *texels, const uint8_t *bytes, size_t count)
{
    webp_texels back;
    const size_t texel_count = (size_t)texels->width * texels->height;
    return webp_texels_read(bytes, count, texel_count, &back, NULL, 0) == 0 &&
           memcmp(back.rgba, texels->rgba, 4 * texel_count) == 0;
}

/* Whether a picture reads back, tried in a process of its own: where memory runs out, libwebp 1.2.4 writes damaged
 * pictures and reports success, and its reader crashes. */
static bool reads_back(const webp_texels *texels, const uint8_t *bytes, size_t count)
{
    int status = -1;
    const pid_t child = fork();
    if (child == 0) {
        _exit(is_whole(texels, bytes, count) ? 0 : 1);
    }
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

int webp_texels_write(const webp_texels *texels, uint8_t **bytes, size_t *count, char *error, size_t error_bytes)
{
    WebPMemoryWriter writer;
    WebPMemoryWriterInit(&writer);
    const int result = encode(texels, &writer);
    *bytes = result == 0 ? malloc(writer.size) : NULL;
    *count = writer.size;
    if (*bytes != NULL) {
        memcpy(*bytes, writer.mem, writer.size);
    }
    WebPMemoryWriterClear(&writer);
    if (*bytes != NULL && !reads_back(texels, *bytes, *count)) {
        free(*bytes);
        *bytes = NULL;
    }
    return *bytes != NULL ? 0
                          : t3r_reason(error, error_bytes, "a picture of %" PRIu32 "x%" PRIu32 " was not made",
                                       texels->width, texels->height);
}

#else

int webp_texels_read(const uint8_t *bytes, size_t count, uint64_t most, webp_texels *out, char *error,
                     size_t error_bytes)
{
    (void)bytes;
    (void)count;
    (void)most;
    *out = (webp_texels){0};
    return t3r_reason(error, error_bytes, "this build has no libwebp");
}

int webp_texels_write(const webp_texels *texels, uint8_t **bytes, size_t *count, char *error, size_t error_bytes)
{
    (void)texels;
    *bytes = NULL;
    *count = 0;
    return t3r_reason(error, error_bytes, "this build has no libwebp");
}

#endif
