/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/importance_pictures.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "budget/blue_noise.h"
#include "cli/cli.h"
#include "cli/text/word_list.h"
#include "pictures/picture.h"

#define PATH_BYTES 4096

/* Returns the grey level with blue noise in 8 lower bits, so that pixels of equal level are retained evenly; each
 * view's noise is shifted as in the runtime. */
static uint16_t level(uint8_t grey, uint32_t view, uint32_t x, uint32_t y)
{
    uint32_t row = (y + 23 * view) % T3R_BLUE_NOISE_SIDE, column = (x + 46 * view) % T3R_BLUE_NOISE_SIDE;
    return (uint16_t)((uint32_t)grey << 8 | (255 - (t3r_blue_noise(row, column) >> 4)));
}

static int read_plane(uint16_t **plane, const char *path, uint32_t view, uint32_t width, uint32_t height)
{
    picture p;
    char error[512] = "";
    if (picture_read(path, &p, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "--importance: %s", error);
    }
    int code = CLI_OK;
    if (p.channels != 1) {
        code = cli_error(CLI_BAD_INPUT, "--importance: %s is not a grey picture", path);
    } else if (p.width != width || p.height != height) {
        code = cli_error(CLI_BAD_INPUT,
                         "--importance: %s has %" PRIu32 "x%" PRIu32
                         " pixels, the context views are worked on at %" PRIu32 "x%" PRIu32,
                         path, p.width, p.height, width, height);
    } else if ((*plane = malloc((size_t)width * height * sizeof **plane)) == NULL) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (size_t i = 0; i < (size_t)width * height && code == CLI_OK; i++) {
        (*plane)[i] = p.bits == 16
                          ? ((const uint16_t *)p.samples)[i]
                          : level(((const uint8_t *)p.samples)[i], view, (uint32_t)(i % width), (uint32_t)(i / width));
    }
    picture_free(&p);
    return code;
}

static bool is_folder(const char *text)
{
    struct stat about;
    return stat(text, &about) == 0 && S_ISDIR(about.st_mode);
}

static int name_too_long(void)
{
    return cli_error(CLI_BAD_USAGE, "--importance names a path that is too long");
}

static int read_folder(importance_pictures *pictures, const char *folder, const uint32_t *context, uint32_t count,
                       uint32_t width, uint32_t height)
{
    int code = CLI_OK;
    for (uint32_t v = 0; v < count && code == CLI_OK; v++) {
        char path[PATH_BYTES];
        int length = snprintf(path, sizeof path, "%s/%" PRIu32 ".png", folder, context[v]);
        code = length < 0 || (size_t)length >= sizeof path ? name_too_long()
                                                           : read_plane(&pictures->planes[v], path, v, width, height);
    }
    return code;
}

static int read_list(importance_pictures *pictures, const char *text, uint32_t count, uint32_t width, uint32_t height)
{
    uint32_t named = 0;
    for (list_word w = word_first(text); w.text != NULL; w = word_next(w)) {
        named++;
    }
    if (named != count) {
        return cli_error(CLI_BAD_USAGE,
                         "--importance names %" PRIu32 " picture%s, there are %" PRIu32 " context view%s", named,
                         named == 1 ? "" : "s", count, count == 1 ? "" : "s");
    }
    int code = CLI_OK;
    list_word w = word_first(text);
    for (uint32_t v = 0; v < count && code == CLI_OK; v++, w = word_next(w)) {
        char path[PATH_BYTES];
        if (w.length >= sizeof path) {
            return name_too_long();
        }
        memcpy(path, w.text, w.length);
        path[w.length] = '\0';
        code = read_plane(&pictures->planes[v], path, v, width, height);
    }
    return code;
}

int importance_pictures_read(importance_pictures *pictures, const char *text, const uint32_t *context, uint32_t count,
                             uint32_t width, uint32_t height)
{
    *pictures = (importance_pictures){0};
    return is_folder(text) ? read_folder(pictures, text, context, count, width, height)
                           : read_list(pictures, text, count, width, height);
}

void importance_pictures_free(importance_pictures *pictures)
{
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        free(pictures->planes[v]);
    }
    *pictures = (importance_pictures){0};
}
