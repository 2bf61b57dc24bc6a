/* SPDX-License-Identifier: Apache-2.0 */
#include "viewer/page.h"

#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "cli/tables/json_output.h"
#include "cli/text/markup.h"
#include "viewer/first_picture.h"

/* Embedded by the build: page/view.html with marks for the others, such as <!--style-->. The modules are empty if
 * there was no compiler for them. */
extern const char viewer_html[], viewer_css[], viewer_js[], viewer_follow_js[], viewer_worker_js[], viewer_files_js[],
    viewer_wasm[], viewer_threads_wasm[], viewer_files_wasm[];
extern const unsigned viewer_wasm_bytes, viewer_threads_wasm_bytes, viewer_files_wasm_bytes;

bool viewer_page_is_built(void)
{
    return viewer_wasm_bytes > 0;
}

static void add_numbers(cJSON *object, const char *key, const double *values, int count)
{
    cJSON_AddItemToObject(object, key, cJSON_CreateDoubleArray(values, count));
}

/* Stores the position and the rotation w x y z. */
static void pose_of(const t3r_camera *camera, double pose[7])
{
    for (int i = 0; i < 3; i++) {
        pose[i] = (double)camera->position_q32[i] / 4294967296.0;
    }
    for (int i = 0; i < 4; i++) {
        pose[3 + i] = camera->rotation_q30[i] / 1073741824.0;
    }
}

static cJSON *frame_json(const viewer_page *page, uint32_t index)
{
    const t3r_camera *c = &page->viewpoints[index].camera;
    const double focal[] = {c->fx_q16 / 65536.0, c->fy_q16 / 65536.0};
    const double centre[] = {c->cx_q16 / 65536.0, c->cy_q16 / 65536.0};
    double pose[7];
    pose_of(c, pose);
    cJSON *frame = cJSON_CreateObject();
    cJSON_AddStringToObject(frame, "name", page->names[index]);
    cJSON_AddBoolToObject(frame, "recorded", page->viewpoints[index].rgb != NULL);
    add_numbers(frame, "focal", focal, 2);
    add_numbers(frame, "centre", centre, 2);
    add_numbers(frame, "position", pose, 3);
    add_numbers(frame, "rotation", pose + 3, 4);
    return frame;
}

/* Returns the text of the JSON, on the heap, or NULL. */
static char *json_of(const viewer_page *page)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "title", page->title);
    json_add_integer(root, "width", page->data.config.width);
    json_add_integer(root, "height", page->data.config.height);
    json_add_integer(root, "views", page->data.config.views);
    json_add_integer(root, "valid", page->valid_points);
    json_add_integer(root, "gaussians", page->gaussians);
    cJSON_AddBoolToObject(root, "file", page->is_file);
    cJSON_AddBoolToObject(root, "served", page->is_served);
    if (page->hashed) {
        json_add_hash(root, "hash", page->hash);
    } else {
        cJSON_AddNullToObject(root, "hash");
    }
    cJSON *stages = cJSON_AddArrayToObject(root, "stages");
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        cJSON_AddItemToArray(stages, cJSON_CreateString(t3r_stage_name((t3r_stage)stage)));
    }
    cJSON *frames = cJSON_AddArrayToObject(root, "frames");
    for (uint32_t i = 0; i < page->viewpoint_count; i++) {
        cJSON_AddItemToArray(frames, frame_json(page, i));
    }
    cJSON *path = cJSON_AddArrayToObject(root, "path");
    for (uint32_t i = 0; i < page->path_count; i++) {
        double pose[7];
        pose_of(&page->path[i], pose);
        cJSON_AddItemToArray(path, cJSON_CreateDoubleArray(pose, 7));
    }
    char *text = cJSON_PrintUnformatted(root);
    cJSON_Delete(root);
    return text;
}

/* Writes JSON with '<' escaped, so that it cannot end the script element. */
static void write_json(FILE *out, const char *text)
{
    for (; *text != '\0'; text++) {
        if (*text == '<') {
            fputs("\\u003c", out);
        } else {
            fputc(*text, out);
        }
    }
}

typedef struct parts {
    bool follows, is_served;
    const char *json;
    const uint8_t *bundle, *picture;
    size_t bundle_bytes, picture_bytes;
    double ratio; /* width / height */
} parts;

static void write_part(FILE *out, const char *mark, const parts *p)
{
    if (strncmp(mark, "<!--style-->", 12) == 0) {
        fputs(viewer_css, out);
    } else if (strncmp(mark, "<!--data-->", 11) == 0) {
        write_json(out, p->json);
    } else if (strncmp(mark, "<!--wasm-->", 11) == 0 && p->is_served) {
        markup_base64(out, (const uint8_t *)viewer_threads_wasm, viewer_threads_wasm_bytes);
    } else if (strncmp(mark, "<!--wasm-->", 11) == 0) {
        markup_base64(out, (const uint8_t *)viewer_wasm, viewer_wasm_bytes);
    } else if (strncmp(mark, "<!--bundle-->", 13) == 0) {
        markup_base64(out, p->bundle, p->bundle_bytes);
    } else if (strncmp(mark, "<!--ratio-->", 12) == 0) {
        fprintf(out, "%.6f", p->ratio);
    } else if (strncmp(mark, "<!--picture-->", 14) == 0) {
        markup_base64(out, p->picture, p->picture_bytes);
    } else if (strncmp(mark, "<!--worker-->", 13) == 0) {
        fputs(viewer_worker_js, out);
    } else if (strncmp(mark, "<!--files-->", 12) == 0) {
        fputs(viewer_files_js, out);
    } else if (strncmp(mark, "<!--files-wasm-->", 17) == 0) {
        markup_base64(out, (const uint8_t *)viewer_files_wasm, viewer_files_wasm_bytes);
    } else if (strncmp(mark, "<!--script-->", 13) == 0) {
        fputs(viewer_js, out);
    } else if (strncmp(mark, "<!--follow-->", 13) == 0 && p->follows) {
        fputs(viewer_follow_js, out);
    } else if (strncmp(mark, "<!--connect-->", 14) == 0 && p->follows) {
        fputs("; connect-src 'self'", out);
    }
}

int viewer_page_write(const viewer_page *page, FILE *out)
{
    parts p = {.follows = page->follows, .is_served = page->is_served};
    char *json = json_of(page);
    uint8_t *bytes = bundle_bytes(&page->data, &p.bundle_bytes);
    uint8_t *picture = first_picture_png(&page->data, &page->viewpoints[0].camera, &p.picture_bytes);
    p.json = json;
    p.bundle = bytes;
    p.picture = picture;
    p.ratio = (double)page->data.config.width / page->data.config.height;
    const int code = json != NULL && bytes != NULL ? 0 : -1;
    const char *rest = viewer_html;
    while (code == 0 && *rest != '\0') {
        const char *mark = strstr(rest, "<!--");
        const char *end = mark != NULL ? strstr(mark, "-->") : NULL;
        if (end == NULL) {
            fputs(rest, out);
            break;
        }
        fwrite(rest, 1, (size_t)(mark - rest), out);
        write_part(out, mark, &p);
        rest = end + 3;
    }
    free(bytes);
    free(picture);
    cJSON_free(json);
    return code;
}
