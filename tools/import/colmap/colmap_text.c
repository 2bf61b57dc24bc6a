/* SPDX-License-Identifier: Apache-2.0 */
/* cameras.txt: CAMERA_ID MODEL WIDTH HEIGHT PARAMETERS...
 * images.txt, two lines per image: IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then its points. */
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "host/reason.h"
#include "import/colmap/colmap_camera.h"
#include "import/colmap/colmap_model.h"
#include "import/frames/line_reader.h"
#include "mcap/reader_limits.h"

#define BLANKS " \t\r"

/* The take_ functions move *text past the value. */
static bool take_number(char **text, double *value)
{
    char *end;
    *value = strtod(*text, &end);
    bool taken = end != *text;
    *text = end;
    return taken;
}

static bool take_whole(char **text, uint64_t most, uint64_t *value)
{
    char *end, *start = *text + strspn(*text, BLANKS);
    errno = 0;
    *value = strtoull(start, &end, 10);
    *text = end;
    return start[0] >= '0' && start[0] <= '9' && errno == 0 && *value <= most;
}

/* Takes a word that ends at a blank; NULL if there is none. */
static char *take_word(char **text)
{
    char *start = *text + strspn(*text, BLANKS);
    size_t length = strcspn(start, BLANKS);
    *text = start + length + (start[length] != '\0');
    start[length] = '\0';
    return length > 0 ? start : NULL;
}

/* Reads the next line that is not a comment. Empty lines are returned, as an image's list of points may be one. */
static bool next_line(line_reader *lines)
{
    bool there;
    do {
        there = line_reader_next(lines);
    } while (there && lines->line[0] == '#');
    return there;
}

static const char *parse_camera(char *line, colmap_model *model)
{
    uint64_t id, width, height;
    double parameters[COLMAP_PARAMETERS_MOST];
    if (!take_whole(&line, UINT32_MAX, &id)) {
        return "no CAMERA_ID";
    }
    const char *name = take_word(&line);
    const colmap_camera_model *lens = name != NULL ? colmap_model_of_name(name) : NULL;
    if (lens == NULL) {
        const colmap_camera unknown = {.id = (uint32_t)id, .wrong = "an unknown camera model"};
        return name == NULL ? "no MODEL" : colmap_model_add_camera(model, &unknown);
    }
    if (!take_whole(&line, UINT64_MAX, &width) || !take_whole(&line, UINT64_MAX, &height)) {
        return "no WIDTH and HEIGHT";
    }
    for (uint32_t i = 0; i < colmap_model_parameters(lens); i++) {
        if (!take_number(&line, &parameters[i])) {
            return "fewer parameters than its model has";
        }
    }
    if (line[strspn(line, BLANKS)] != '\0') {
        return "more parameters than its model has";
    }
    colmap_camera camera = {.id = (uint32_t)id};
    camera.wrong = colmap_intrinsics(lens, parameters, width, height, &camera.intrinsics);
    return colmap_model_add_camera(model, &camera);
}

static const char *parse_image(char *line, colmap_model *model)
{
    uint64_t id, camera;
    rigid pose;
    if (!take_whole(&line, UINT32_MAX, &id)) {
        return "no IMAGE_ID";
    }
    for (int i = 0; i < 7; i++) {
        if (!take_number(&line, i < 4 ? &pose.rotation[i] : &pose.position[i - 4])) {
            return "not 'IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME'";
        }
    }
    if (!take_whole(&line, UINT32_MAX, &camera)) {
        return "no CAMERA_ID";
    }
    line += strspn(line, BLANKS); /* a name may have blanks inside */
    size_t length = strlen(line);
    while (length > 0 && strchr(BLANKS, line[length - 1]) != NULL) {
        line[--length] = '\0';
    }
    if (length >= COLMAP_NAME_BYTES) {
        return "a name of more than 4096 bytes";
    }
    return colmap_model_add_image(model, line, (uint32_t)camera, pose);
}

/* Passes lines to `parse`; skips `skipped` lines after each. */
static int read_lines(FILE *file, colmap_model *model, const char *(*parse)(char *line, colmap_model *model),
                      uint32_t skipped, char *error, size_t error_bytes)
{
    line_reader *lines = calloc(1, sizeof *lines);
    if (lines == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    lines->file = file;
    int status = 0;
    while (status == 0 && next_line(lines)) {
        if (lines->line[strspn(lines->line, BLANKS)] == '\0' && !lines->longer) {
            continue;
        }
        const char *wrong = lines->longer ? "it is too long, or has a zero byte" : parse(lines->line, model);
        if (wrong != NULL) {
            status = t3r_reason(error, error_bytes, "line %" PRIu64 ": %s", lines->number, wrong);
        }
        for (uint32_t i = 0; i < skipped && status == 0; i++) {
            (void)line_reader_next(lines);
        }
    }
    if (status == 0 && line_reader_at_limit(lines)) {
        status = t3r_reason(error, error_bytes, "more than %d bytes; colmap model_converter makes a binary file of it",
                            T3R_LIMIT_MODEL_BYTES);
    }
    free(lines);
    return status;
}

int colmap_read_cameras_text(FILE *file, colmap_model *model, char *error, size_t error_bytes)
{
    return read_lines(file, model, parse_camera, 0, error, error_bytes);
}

int colmap_read_images_text(FILE *file, colmap_model *model, char *error, size_t error_bytes)
{
    return read_lines(file, model, parse_image, 1, error, error_bytes);
}
