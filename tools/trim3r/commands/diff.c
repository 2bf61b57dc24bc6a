/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r diff: compares two scenes or two views. Exit status 0 = equal, 1 = different. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "pictures/picture.h"
#include "scene/scene_file.h"
#include "scene/scene_options.h"
#include "scene/summary/scene_difference.h"

#define ERROR_BYTES 512

typedef struct diff_options {
    const char *path[2];
    int flags; /* for scene_difference_of() */
    bool json;
} diff_options;

static const struct argp_option options[] = {
    OPTION_ARGUMENTS("A", OPTION_READS),
    {"json", OPTION_TO(diff_options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    diff_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->flags;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, (const char **[]){&o->path[0], &o->path[1]}, 2);
        return 0;
    case ARGP_KEY_END:
        if (o->path[1] == NULL) {
            argp_error(state, "two files are needed");
        } else if (scene_file_is_one(o->path[0]) != scene_file_is_one(o->path[1])) {
            argp_error(state, "a scene and a picture cannot be compared");
        }
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child children[] = {{.argp = &scene_input_argp}, {0}};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "A B",
    .doc = "Compare two scenes or two views (PNG)."
           "\vExamples:\n"
           "  trim3r diff scene.ply other.ply\n"
           "  trim3r diff view.png other.png --json\n\n"
           "Exit status: 0 equal, 1 different or unreadable, 2 bad usage.",
    .children = children,
};

static void print_scene_difference_json(const scene_difference *d)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddBoolToObject(root, "equal", scene_difference_none(d));
    cJSON *counts = cJSON_AddArrayToObject(root, "gaussians"), *degrees = cJSON_AddArrayToObject(root, "degree"),
          *marks = cJSON_AddArrayToObject(root, "mip");
    for (int i = 0; i < 2; i++) {
        cJSON_AddItemToArray(counts, cJSON_CreateNumber(d->count[i]));
        cJSON_AddItemToArray(degrees, cJSON_CreateNumber(d->degree[i]));
        cJSON_AddItemToArray(marks, cJSON_CreateBool(d->mip[i]));
    }
    json_add_integer(root, "different", d->different);
    if (d->different > 0) {
        json_add_integer(root, "first", d->first);
    }
    cJSON_AddNumberToObject(root, "position", d->position);
    cJSON_AddNumberToObject(root, "covariance", d->covariance);
    cJSON_AddNumberToObject(root, "colour", d->colour);
    cJSON_AddNumberToObject(root, "opacity", d->opacity);
    cJSON_AddNumberToObject(root, "harmonics", d->harmonics);
    json_print(root);
}

static void print_scene_difference(const scene_difference *d)
{
    if (scene_difference_none(d)) {
        printf("equal: %" PRIu32 " Gaussians\n", d->count[0]);
        return;
    }
    printf("%" PRIu32 " and %" PRIu32 " Gaussians", d->count[0], d->count[1]);
    if (d->mip[0] != d->mip[1]) {
        printf("; the %s scene alone is marked for mip-splatting", d->mip[0] ? "first" : "second");
    }
    if (d->different > 0) {
        printf("; %" PRIu32 " differ, the first is %" PRIu32 "\nlargest differences: position %g world units, "
               "covariance %g of its size, colour %g of 255, opacity %g, harmonics %g",
               d->different, d->first, d->position, d->covariance, d->colour, d->opacity, d->harmonics);
    }
    putchar('\n');
}

static int diff_scenes(const diff_options *o)
{
    scene_difference d;
    char error[ERROR_BYTES] = "";
    if (scene_difference_of(o->path, o->flags, &d, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    (o->json ? print_scene_difference_json : print_scene_difference)(&d);
    return scene_difference_none(&d) ? CLI_OK : CLI_BAD_INPUT;
}

typedef struct picture_difference {
    uint64_t different; /* samples */
    uint32_t largest;
    double psnr;             /* against the largest sample; infinite when equal */
    uint32_t tile_x, tile_y; /* top left pixel of the first 16x16 tile that differs, tiles row-major */
} picture_difference;

static uint32_t sample(const picture *p, size_t index)
{
    return p->bits == 16 ? ((const uint16_t *)p->samples)[index] : ((const uint8_t *)p->samples)[index];
}

static picture_difference compare_pictures(const picture *a, const picture *b)
{
    picture_difference d = {0};
    double squares = 0;
    uint32_t columns = (a->width + 15) / 16;
    uint64_t first_tile = UINT64_MAX;
    for (uint32_t y = 0; y < a->height; y++) {
        for (size_t i = 0; i < (size_t)a->width * a->channels; i++) {
            size_t index = (size_t)y * a->width * a->channels + i;
            uint32_t p = sample(a, index), q = sample(b, index);
            if (p == q) {
                continue;
            }
            uint32_t difference = p > q ? p - q : q - p;
            uint64_t tile = (uint64_t)(y / 16) * columns + i / a->channels / 16;
            first_tile = tile < first_tile ? tile : first_tile;
            d.different++;
            d.largest = difference > d.largest ? difference : d.largest;
            squares += (double)difference * difference;
        }
    }
    double peak = a->bits == 16 ? 65535 : 255;
    double count = (double)a->width * a->height * a->channels;
    d.psnr = d.different == 0 ? INFINITY : 10 * log10(peak * peak * count / squares);
    if (d.different != 0) {
        d.tile_x = (uint32_t)(first_tile % columns) * 16;
        d.tile_y = (uint32_t)(first_tile / columns) * 16;
    }
    return d;
}

static int print_picture_difference(const diff_options *o, const picture_difference *d)
{
    if (o->json) {
        cJSON *root = cJSON_CreateObject();
        cJSON_AddBoolToObject(root, "equal", d->different == 0);
        json_add_integer(root, "different", (int64_t)d->different);
        json_add_integer(root, "largest", d->largest);
        if (d->different == 0) {
            cJSON_AddNullToObject(root, "psnr");
        } else {
            cJSON_AddNumberToObject(root, "psnr", d->psnr);
            cJSON *tile = cJSON_AddArrayToObject(root, "first_tile");
            cJSON_AddItemToArray(tile, cJSON_CreateNumber(d->tile_x));
            cJSON_AddItemToArray(tile, cJSON_CreateNumber(d->tile_y));
        }
        json_print(root);
    } else if (d->different == 0) {
        puts("equal");
    } else {
        printf("%" PRIu64 " samples differ, by %" PRIu32
               " at most; PSNR %.2f dB; the first 16x16 tile is at pixel (%" PRIu32 ", %" PRIu32 ")\n",
               d->different, d->largest, d->psnr, d->tile_x, d->tile_y);
    }
    return d->different == 0 ? CLI_OK : CLI_BAD_INPUT;
}

static int diff_pictures(const diff_options *o)
{
    picture p[2];
    char error[ERROR_BYTES] = "";
    if (picture_read(o->path[0], &p[0], error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (picture_read(o->path[1], &p[1], error, sizeof error) != 0) {
        picture_free(&p[0]);
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    int code;
    if (p[0].width != p[1].width || p[0].height != p[1].height || p[0].channels != p[1].channels ||
        p[0].bits != p[1].bits) {
        code = cli_error(CLI_BAD_INPUT,
                         "%s: %" PRIu32 "x%" PRIu32 " with %" PRIu32 " channels of %" PRIu32 " bits; %s: %" PRIu32
                         "x%" PRIu32 " with %" PRIu32 " of %" PRIu32 ": they cannot be compared",
                         o->path[0], p[0].width, p[0].height, p[0].channels, p[0].bits, o->path[1], p[1].width,
                         p[1].height, p[1].channels, p[1].bits);
    } else {
        picture_difference d = compare_pictures(&p[0], &p[1]);
        code = print_picture_difference(o, &d);
    }
    picture_free(&p[0]);
    picture_free(&p[1]);
    return code;
}

int command_diff(int argc, char **argv)
{
    diff_options o = {0};
    file_options_parse(&argp, argc, argv, &o);
    return scene_file_is_one(o.path[0]) ? diff_scenes(&o) : diff_pictures(&o);
}
