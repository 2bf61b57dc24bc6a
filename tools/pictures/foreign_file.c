/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/foreign_file.h"

#include <stdbool.h>
#include <string.h>
#include <strings.h>

#include "pictures/heif.h"

#define HEIF                                                                                                           \
    "HEIC is not read: this build has no libheif (Debian: libheif-dev); heif-convert IN.heic OUT.jpg makes JPEG of it"
#define WEBP "WebP is not read; dwebp IN.webp -o OUT.png makes PNG of it"
#define TIFF "TIFF is not read; convert IN.tif OUT.png makes PNG of it"
#define OTHER "BMP and GIF are not read; convert IN OUT.png makes PNG of them"
#define VIDEO "a video is not read; ffmpeg -i IN -vf fps=5 FOLDER/%05d.png makes pictures of it"

/* Kinds by their first bytes, the more special ones first; '?' stands for any byte. */
static const struct kind {
    const char *magic;
    size_t bytes;
    const char *advice;
} kinds[] = {
    {"????ftyphei", 11, HEIF}, {"????ftyphev", 11, HEIF},  {"????ftypmif1", 12, HEIF},  {"????ftypavif", 12, HEIF},
    {"????ftyp", 8, VIDEO},    {"RIFF????WEBP", 12, WEBP}, {"RIFF????AVI ", 12, VIDEO}, {"\x1a\x45\xdf\xa3", 4, VIDEO},
    {"II*\0", 4, TIFF},        {"MM\0*", 4, TIFF},         {"GIF8", 4, OTHER},          {"BM????\0\0\0\0", 10, OTHER},
};

static const struct ending {
    const char *name, *advice;
} endings[] = {
    {".heic", HEIF}, {".heif", HEIF}, {".avif", HEIF}, {".webp", WEBP},  {".tif", TIFF},
    {".tiff", TIFF}, {".bmp", OTHER}, {".gif", OTHER}, {".mp4", VIDEO},  {".mov", VIDEO},
    {".m4v", VIDEO}, {".avi", VIDEO}, {".mkv", VIDEO}, {".webm", VIDEO},
};

static bool begins(const uint8_t *bytes, size_t count, const struct kind *kind)
{
    bool same = count >= kind->bytes;
    for (size_t i = 0; i < kind->bytes && same; i++) {
        same = kind->magic[i] == '?' || bytes[i] == (uint8_t)kind->magic[i];
    }
    return same;
}

const char *foreign_file_of_bytes(const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && !heif_is(bytes, count); i++) {
        if (begins(bytes, count, &kinds[i])) {
            return kinds[i].advice;
        }
    }
    return NULL;
}

const char *foreign_file_of_name(const char *name)
{
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; i < sizeof endings / sizeof *endings && dot != NULL && !heif_is_named(name); i++) {
        if (strcasecmp(dot, endings[i].name) == 0) {
            return endings[i].advice;
        }
    }
    return NULL;
}
