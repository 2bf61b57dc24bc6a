/* SPDX-License-Identifier: Apache-2.0 */
#include "trim3r/scene/scene_report.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/json_output.h"
#include "cli/text/wrapped.h"
#include "import/estimation/poses_output.h"
#include "trim3r/scene/scene_quality.h"

#define EMPTY_MOST 0.1     /* of a picture, that goes without saying */
#define UNSURE_DEGREES 3.0 /* standard deviation of the direction from one camera to the next */
#define UNSURE_MATCHES 40u /* fewer features that agree with a pose */
#define NAMED_MOST 3u      /* pictures in a line on poses */

int scene_report_keep(scene_report *r, const posed_folder *folder, const pose_account *accounts)
{
    const uint32_t count = folder->frame_count;
    memcpy(r->focal, folder->focal, sizeof r->focal);
    r->left_out = folder->left_out.frames.count;
    r->names = calloc(count + 1, sizeof *r->names);
    r->accounts = accounts != NULL ? malloc(count * sizeof *accounts) : NULL;
    if (r->names == NULL || (accounts != NULL && r->accounts == NULL)) {
        return -1;
    }
    for (uint32_t i = 0; i < count; i++) {
        r->names[r->name_count++] = strdup(folder->frames[i].image);
    }
    if (accounts != NULL) {
        memcpy(r->accounts, accounts, count * sizeof *accounts);
    }
    return 0;
}

void scene_report_free(scene_report *r)
{
    for (uint32_t i = 0; i < r->name_count; i++) {
        free(r->names[i]);
    }
    free(r->names);
    free(r->accounts);
    *r = (scene_report){0};
}

/* ---- parts ------------------------------------------------------------------------------------------------------ */

typedef char picture_name[128];

/* Writes the picture's own name, or "frame N". */
static const char *name_of(const scene_report *r, uint32_t frame, picture_name text)
{
    const char *path = frame < r->name_count ? r->names[frame] : NULL,
               *slash = path != NULL ? strrchr(path, '/') : NULL;
    if (path != NULL) {
        snprintf(text, sizeof(picture_name), "%s", slash != NULL ? slash + 1 : path);
    } else {
        snprintf(text, sizeof(picture_name), "frame %" PRIu32, frame);
    }
    return text;
}

static bool is_unsure(const pose_account *a)
{
    return a->why[0] == '\0' && a->matches > 0 &&
           (a->direction_degrees > UNSURE_DEGREES || a->matches < UNSURE_MATCHES);
}

/* Writes what is wrong with a drawn picture: " (blurred, 20 % empty)"; "" if nothing is. */
static const char *trouble_of(const drawn_picture *p, char text[256])
{
    int length = 0;
    if (p->blurred) {
        length += snprintf(text + length, 256 - (size_t)length, ", blurred");
    }
    if (p->no_depth != NULL) {
        length += snprintf(text + length, 256 - (size_t)length, ", no depth: %s", p->no_depth);
    }
    if (p->empty > EMPTY_MOST) {
        length += snprintf(text + length, 256 - (size_t)length, ", %.0f %% empty", 100 * p->empty);
    }
    text[length] = '\0';
    return text;
}

/* ---- lines ------------------------------------------------------------------------------------------------------ */

typedef void line_text(FILE *out, const scene_report *r);

/* Prints a label and a text in lines that fit. */
static void print_line(const scene_report *r, const char *label, line_text *write)
{
    char *text = NULL;
    size_t bytes;
    FILE *out = open_memstream(&text, &bytes);
    if (out != NULL) {
        write(out, r);
        fclose(out);
    }
    wrapped_print(stdout, 2, label, text != NULL ? text : "out of memory");
    free(text);
}

static void write_input(FILE *out, const scene_report *r)
{
    fprintf(out, "%s, %" PRIu32 " frames of %" PRIu32 "x%" PRIu32, r->source.kind, r->source.frames, r->source.width,
            r->source.height);
    if (r->left_out > 0) {
        fprintf(out, ", of which %" PRIu32 " cannot be used", r->left_out);
    }
    fprintf(out, "; worked on at %" PRIu32 "x%" PRIu32, r->width, r->height);
    fprintf(out, "%s%s", r->focal[0] != '\0' ? "; focal length " : "", r->focal);
}

static void write_poses(FILE *out, const scene_report *r)
{
    picture_name name, other;
    fprintf(out, "%s, of %" PRIu32 " of %" PRIu32 " frames", r->estimated ? "estimated" : "given", r->posed, r->frames);
    uint32_t named = 0;
    for (uint32_t i = 0; i < r->name_count && r->accounts != NULL; i++) {
        const pose_account *a = &r->accounts[i];
        if (a->why[0] != '\0' && named++ < NAMED_MOST) {
            fprintf(out, "; not %s: %s", name_of(r, i, name), a->why);
        } else if (is_unsure(a) && named++ < NAMED_MOST) {
            fprintf(out, "; %s is weakly joined to %s (%" PRIu32 " features agree, direction +-%.0f degrees)",
                    name_of(r, i, name), name_of(r, a->from, other), a->matches, a->direction_degrees);
        }
    }
    if (named > NAMED_MOST) {
        fprintf(out, "; and %" PRIu32 " more such frames", named - NAMED_MOST);
    }
}

static uint32_t used_count(const scene_report *r)
{
    uint32_t used = 0;
    for (uint32_t i = 0; i < r->drawn_count; i++) {
        used += r->drawn[i].used;
    }
    return used;
}

static void write_frames(FILE *out, const scene_report *r)
{
    const uint32_t used = used_count(r);
    fprintf(out, "%" PRIu32 " of %" PRIu32 " chosen%s; depth by %s", used, r->frames,
            used < r->frames ? ", sharp ones that together show most" : "", r->depth);
}

/* Writes "a.jpg 27.1, b.jpg 20.4 (blurred)" for the used pictures, or for the others. */
static void write_some(FILE *out, const scene_report *r, bool used)
{
    const char *between = "";
    for (uint32_t i = 0; i < r->drawn_count; i++) {
        const drawn_picture *p = &r->drawn[i];
        if (p->used == used) {
            char trouble[256];
            picture_name name;
            trouble_of(p, trouble);
            fprintf(out, "%s%s %.1f%s%s%s", between, name_of(r, p->frame, name), p->psnr,
                    trouble[0] != '\0' ? " (" : "", trouble[0] != '\0' ? trouble + 2 : "",
                    trouble[0] != '\0' ? ")" : "");
            between = ", ";
        }
    }
}

static void write_drawn(FILE *out, const scene_report *r)
{
    write_some(out, r, true);
    if (used_count(r) < r->drawn_count) {
        fputs("; not chosen: ", out);
        write_some(out, r, false);
    }
}

/* Writes "fair; below 18 dB: a.jpg, b.jpg". */
static void write_quality(FILE *out, const scene_report *r)
{
    const scene_quality quality = scene_quality_of(r->drawn, r->drawn_count);
    fputs(scene_quality_name(quality), out);
    uint32_t named = 0;
    for (uint32_t i = 0; i < r->drawn_count; i++) {
        const drawn_picture *p = &r->drawn[i];
        picture_name name;
        if (p->used && p->psnr < SCENE_POOR_DB) {
            if (named++ == 0) {
                fprintf(out, "; below %.0f dB: ", SCENE_POOR_DB);
            }
            fprintf(out, "%s%s", named > 1 ? ", " : "", name_of(r, p->frame, name));
        }
    }
    if (quality == SCENE_POOR) {
        fputs("; take sharp pictures of one exposure, a hand's breadth from one to the next", out);
    }
}

void scene_report_print(const scene_report *r)
{
    char input[256];
    snprintf(input, sizeof input, "%s: ", r->input);
    print_line(r, input, write_input);
    print_line(r, "poses: ", write_poses);
    print_line(r, "frames: ", write_frames);
    print_line(r, "drawn, dB: ", write_drawn);
    print_line(r, "quality: ", write_quality);
    printf("%s: %" PRIu32 " Gaussians of %" PRIu32 " valid points; %.1f s\n", r->output, r->gaussians, r->valid_points,
           r->seconds);
}

/* ---- JSON ------------------------------------------------------------------------------------------------------- */

static void add_drawn(const scene_report *r, cJSON *root)
{
    cJSON *list = cJSON_AddArrayToObject(root, "pictures");
    for (uint32_t i = 0; i < r->drawn_count; i++) {
        const drawn_picture *p = &r->drawn[i];
        picture_name name;
        cJSON *one = cJSON_CreateObject();
        cJSON_AddNumberToObject(one, "frame", p->frame);
        cJSON_AddStringToObject(one, "name", name_of(r, p->frame, name));
        cJSON_AddBoolToObject(one, "chosen", p->used);
        cJSON_AddNumberToObject(one, "psnr", p->psnr);
        cJSON_AddNumberToObject(one, "empty", p->empty);
        cJSON_AddBoolToObject(one, "blurred", p->blurred);
        if (p->no_depth != NULL) {
            cJSON_AddStringToObject(one, "no_depth", p->no_depth);
        }
        cJSON_AddItemToArray(list, one);
    }
}

void scene_report_print_json(const scene_report *r)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "output", r->output);
    cJSON_AddStringToObject(root, "kind", r->source.kind);
    json_add_integer(root, "frames", r->frames);
    json_add_integer(root, "posed_frames", r->posed);
    json_add_integer(root, "left_out", r->left_out);
    cJSON_AddNumberToObject(root, "width", r->width);
    cJSON_AddNumberToObject(root, "height", r->height);
    if (r->focal[0] != '\0') {
        cJSON_AddStringToObject(root, "focal_length", r->focal);
    }
    cJSON_AddBoolToObject(root, "estimated", r->estimated);
    cJSON *poses = r->accounts != NULL ? cJSON_AddArrayToObject(root, "poses") : NULL;
    for (uint32_t i = 0; poses != NULL && i < r->name_count; i++) {
        cJSON_AddItemToArray(poses, pose_account_json(NULL, i, r->accounts));
    }
    cJSON_AddStringToObject(root, "depth", r->depth);
    json_add_integer(root, "gaussians", r->gaussians);
    json_add_integer(root, "valid_points", r->valid_points);
    add_drawn(r, root);
    cJSON_AddStringToObject(root, "quality", scene_quality_name(scene_quality_of(r->drawn, r->drawn_count)));
    cJSON_AddNumberToObject(root, "seconds", r->seconds);
    json_print(root);
}
