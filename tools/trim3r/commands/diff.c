/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r diff: compares two scenes or two views. Exit status 0 = equal, 1 = different. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "pictures/picture.h"
#include "scene/gaussian_shape.h"
#include "scene/scene_file.h"
#include "scene/scene_options.h"

#define ERROR_BYTES 512

typedef struct diff_options {
    const char *path[2];
    int flags; /* for scene_file_read() */
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

typedef struct scene_difference {
    uint32_t different; /* Gaussians that are not the same */
    uint32_t first;     /* the first of them */
    double position;    /* largest distance, world units */
    double covariance;  /* largest entry of the difference against the largest of either */
    double colour;      /* of 255 */
    double opacity;     /* of 1 */
} scene_difference;

static double covariance_difference(const t3r_gaussian *a, int a_exponent, const t3r_gaussian *b, int b_exponent)
{
    double p[9], q[9], most = 0, difference = 0;
    gaussian_covariance(a, p);
    gaussian_covariance(b, q);
    for (int i = 0; i < 9; i++) {
        double x = ldexp(p[i], 2 * a_exponent), y = ldexp(q[i], 2 * b_exponent);
        most = fmax(most, fmax(fabs(x), fabs(y)));
        difference = fmax(difference, fabs(x - y));
    }
    return most > 0 ? difference / most : 0;
}

static scene_difference compare_scenes(const scene_file *a, const scene_file *b)
{
    scene_difference d = {0};
    uint32_t count = a->count < b->count ? a->count : b->count;
    bool same_frame = memcmp(a->frame.origin_q32, b->frame.origin_q32, sizeof a->frame.origin_q32) == 0 &&
                      a->frame.exponent == b->frame.exponent;
    for (uint32_t i = 0; i < count; i++) {
        const t3r_gaussian *g = &a->gaussians[i], *h = &b->gaussians[i];
        if (same_frame && memcmp(g, h, sizeof *g) == 0) { /* the record has no padding */
            continue;
        }
        d.first = d.different == 0 ? i : d.first;
        d.different++;
        double square = 0;
        for (int axis = 0; axis < 3; axis++) {
            double origin = ldexp((double)(a->frame.origin_q32[axis] - b->frame.origin_q32[axis]), -32);
            double distance = origin + ldexp(g->position_q20[axis], a->frame.exponent - 20) -
                              ldexp(h->position_q20[axis], b->frame.exponent - 20);
            square += distance * distance;
            d.colour = fmax(d.colour, fabs((double)g->colour_q7[axis] - h->colour_q7[axis]) / 128);
        }
        d.position = fmax(d.position, sqrt(square));
        d.opacity = fmax(d.opacity, fabs((double)g->opacity_q15 - h->opacity_q15) / 32768);
        d.covariance = fmax(d.covariance, covariance_difference(g, a->frame.exponent, h, b->frame.exponent));
    }
    return d;
}

static int diff_scenes(const diff_options *o)
{
    scene_file scene[2] = {0};
    char error[ERROR_BYTES] = "";
    for (int i = 0; i < 2; i++) {
        if (scene_file_read(o->path[i], o->flags, &scene[i], error, sizeof error) != 0) {
            scene_file_free(&scene[0]);
            return cli_error(CLI_BAD_INPUT, "%s", error);
        }
    }
    scene_difference d = compare_scenes(&scene[0], &scene[1]);
    bool equal = d.different == 0 && scene[0].count == scene[1].count;
    if (o->json) {
        cJSON *root = cJSON_CreateObject();
        cJSON_AddBoolToObject(root, "equal", equal);
        cJSON *counts = cJSON_AddArrayToObject(root, "gaussians");
        cJSON_AddItemToArray(counts, cJSON_CreateNumber(scene[0].count));
        cJSON_AddItemToArray(counts, cJSON_CreateNumber(scene[1].count));
        json_add_integer(root, "different", d.different);
        if (d.different > 0) {
            json_add_integer(root, "first", d.first);
        }
        cJSON_AddNumberToObject(root, "position", d.position);
        cJSON_AddNumberToObject(root, "covariance", d.covariance);
        cJSON_AddNumberToObject(root, "colour", d.colour);
        cJSON_AddNumberToObject(root, "opacity", d.opacity);
        json_print(root);
    } else if (equal) {
        printf("equal: %" PRIu32 " Gaussians\n", scene[0].count);
    } else {
        printf("%" PRIu32 " and %" PRIu32 " Gaussians", scene[0].count, scene[1].count);
        if (d.different > 0) {
            printf("; %" PRIu32 " differ, the first is %" PRIu32 "\nlargest differences: position %g world units, "
                   "covariance %g of its size, colour %g of 255, opacity %g",
                   d.different, d.first, d.position, d.covariance, d.colour, d.opacity);
        }
        putchar('\n');
    }
    scene_file_free(&scene[0]);
    scene_file_free(&scene[1]);
    return equal ? CLI_OK : CLI_BAD_INPUT;
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
