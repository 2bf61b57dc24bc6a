/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/picture_border.h"

#include <stdlib.h>

#include "cli/text/wrapped.h"

enum {
    LEAST_PART = 16, /* a border takes at most this part of a side */
    SAME = 16,       /* levels by which compression moves one colour */
    STEP = 4         /* lines between the border's colour and the picture's */
};

void border_search_begin(border_search *search)
{
    *search = (border_search){.possible = true};
}

static bool is_upright(uint32_t side)
{
    return side % 2 == 0;
}

/* Returns the number of lines that a search looks at along a side. */
static uint32_t line_count(const border_search *search, uint32_t side)
{
    return (is_upright(side) ? search->width : search->height) / LEAST_PART + STEP + 1;
}

/* Returns the number of pixels of a line. */
static uint32_t line_length(const border_search *search, uint32_t side)
{
    return is_upright(side) ? search->height : search->width;
}

/* Returns a pixel of the n-th line from outside. */
static const uint8_t *pixel_at(const picture *p, uint32_t side, uint32_t line, uint32_t i)
{
    const uint32_t x = is_upright(side) ? (side == 0 ? line : p->width - 1 - line) : i;
    const uint32_t y = is_upright(side) ? i : (side == 1 ? line : p->height - 1 - line);
    return (const uint8_t *)p->samples + ((size_t)y * p->width + x) * p->channels;
}

/* Takes the border's colour from the top line of the first picture. */
static void take_colour(border_search *search, const picture *p)
{
    for (uint32_t c = 0; c < p->channels; c++) {
        uint64_t sum = 0;
        for (uint32_t x = 0; x < p->width; x++) {
            sum += pixel_at(p, 1, 0, x)[c];
        }
        search->colour[c] = (int32_t)((sum + p->width / 2) / p->width);
    }
}

static int begin_lines(border_search *search, const picture *p)
{
    search->width = p->width;
    search->height = p->height;
    search->channels = p->channels;
    search->possible = p->width >= 2 * LEAST_PART && p->height >= 2 * LEAST_PART;
    take_colour(search, p);
    for (uint32_t side = 0; side < BORDER_SIDES && search->possible; side++) {
        const uint32_t lines = line_count(search, side);
        search->lines[side] = calloc(lines, sizeof *search->lines[side]);
        if (search->lines[side] == NULL) {
            return -1;
        }
        for (uint32_t line = 0; line < lines; line++) {
            search->lines[side][line].uniform = true;
        }
    }
    return 0;
}

static void add_line(border_search *search, const picture *p, uint32_t side, uint32_t line)
{
    border_line *sums = &search->lines[side][line];
    const uint32_t length = line_length(search, side);
    for (uint32_t i = 0; i < length; i++) {
        const uint8_t *pixel = pixel_at(p, side, line, i);
        int32_t most = 0;
        for (uint32_t c = 0; c < p->channels; c++) {
            const int32_t off = abs(pixel[c] - search->colour[c]);
            most = off > most ? off : most;
            sums->contrast += (uint64_t)off;
        }
        sums->uniform = sums->uniform && most <= SAME;
        sums->off += most > SAME;
    }
}

int border_search_add(border_search *search, const picture *p)
{
    if (search->pictures++ == 0 && begin_lines(search, p) != 0) {
        return -1;
    }
    search->possible =
        search->possible && p->width == search->width && p->height == search->height && p->channels == search->channels;
    for (uint32_t side = 0; side < BORDER_SIDES && search->possible; side++) {
        add_line(search, p, side, 0);
        search->possible = search->lines[side][0].uniform;
        for (uint32_t line = 1; line < line_count(search, side) && search->possible; line++) {
            add_line(search, p, side, line);
        }
    }
    return 0;
}

/* Returns the number of lines up to the picture; 0: no border ends there. */
static uint32_t border_of(const border_search *search, uint32_t side)
{
    const border_line *lines = search->lines[side];
    const uint32_t count = line_count(search, side);
    const uint64_t pixels = (uint64_t)line_length(search, side) * search->pictures;
    uint32_t line = 0;
    while (line < count && lines[line].uniform) {
        line++;
    }
    if (line + STEP >= count) {
        return 0;
    }
    for (uint32_t i = 0; i < STEP; i++, line++) {
        if (2 * lines[line].off >= pixels && 4 * lines[line].contrast >= 3 * lines[line + 1].contrast) {
            return line;
        }
    }
    return 0;
}

picture_inner border_search_end(border_search *search)
{
    uint32_t lines[BORDER_SIDES] = {0};
    bool found = search->possible && search->pictures > 0;
    for (uint32_t side = 0; side < BORDER_SIDES && found; side++) {
        lines[side] = border_of(search, side);
        found = lines[side] > 0;
    }
    for (uint32_t side = 0; side < BORDER_SIDES; side++) {
        free(search->lines[side]);
    }
    return found ? (picture_inner){search->width,
                                   search->height,
                                   {lines[0], lines[1], search->width - lines[0] - lines[2],
                                    search->height - lines[1] - lines[3]}}
                 : (picture_inner){0};
}

/* Computes the pixels of a border on each side. */
static void widths_of(const picture_inner *inner, int widths[BORDER_SIDES])
{
    const t3r_crop *part = &inner->part;
    widths[0] = (int)part->x;
    widths[1] = (int)part->y;
    widths[2] = (int)(inner->width - part->x - part->width);
    widths[3] = (int)(inner->height - part->y - part->height);
}

void picture_border_print(const picture_inner *inner)
{
    int widths[BORDER_SIDES];
    widths_of(inner, widths);
    if (inner->width != 0) {
        wrapped_printf(2, "left out: ",
                       "a border of one colour around all pictures: %d, %d, %d and %d pixels on the left, top, right "
                       "and bottom; --keep-border keeps it",
                       widths[0], widths[1], widths[2], widths[3]);
    }
}

void picture_border_add_json(const picture_inner *inner, cJSON *object)
{
    int widths[BORDER_SIDES];
    widths_of(inner, widths);
    cJSON_AddItemToObject(object, "border", cJSON_CreateIntArray(widths, BORDER_SIDES));
}
