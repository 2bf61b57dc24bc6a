/* SPDX-License-Identifier: Apache-2.0 */
#include "viewer/follow.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define LINES_AT_ONCE ((size_t)1 << 22)
#define HEAD_BYTES 96

static server_answer map_of(const viewer_follow *f)
{
    char error[512];
    scene_file scene = {0};
    server_answer answer = {.type = NULL};
    if (scene_file_read(f->map, f->scene_flags | SCENE_FILE_QUIET, &scene, error, sizeof error) != 0) {
        return answer; /* it is not there yet */
    }
    bundle data = *f->data;
    data.scene = &scene;
    data.config.max_gaussians = scene.count > 0 ? scene.count : 1;
    answer.body = (char *)bundle_bytes(&data, &answer.bytes);
    answer.type = answer.body != NULL ? "application/octet-stream" : NULL;
    answer.owned = true;
    scene_file_free(&scene);
    return answer;
}

/* Cuts off a line that is still being written. */
static size_t whole_lines(const char *text, size_t bytes)
{
    while (bytes > 0 && text[bytes - 1] != '\n') {
        bytes--;
    }
    return bytes;
}

static server_answer lines_from(const viewer_follow *f, uint64_t from)
{
    struct stat map = {0}, lines = {0};
    char *body = malloc(HEAD_BYTES + LINES_AT_ONCE);
    FILE *file = fopen(f->lines, "rb");
    size_t got = 0;
    if (body == NULL) {
        return (server_answer){.type = NULL};
    }
    (void)stat(f->map, &map);
    const bool there = file != NULL && fstat(fileno(file), &lines) == 0;
    from = there && from <= (uint64_t)lines.st_size ? from : 0;
    const size_t head = (size_t)snprintf(body, HEAD_BYTES, "%" PRIu64 " %jd.%09ld-%jd\n", from,
                                         (intmax_t)map.st_mtim.tv_sec, map.st_mtim.tv_nsec, (intmax_t)map.st_size);
    if (there && fseeko(file, (off_t)from, SEEK_SET) == 0) {
        got = whole_lines(body + head, fread(body + head, 1, LINES_AT_ONCE, file));
    }
    if (file != NULL) {
        fclose(file);
    }
    return (server_answer){.type = "text/plain; charset=utf-8", .body = body, .bytes = head + got, .owned = true};
}

server_answer viewer_follow_find(void *user, const char *path)
{
    const viewer_follow *f = user;
    if (strcmp(path, "/") == 0) {
        return (server_answer){.type = "text/html; charset=utf-8", .body = f->page, .bytes = f->page_bytes};
    }
    if (f->map != NULL && strcmp(path, "/map") == 0) {
        return map_of(f);
    }
    if (f->map != NULL && strncmp(path, "/lines?", 7) == 0) {
        return lines_from(f, strtoull(path + 7, NULL, 10));
    }
    return (server_answer){.type = NULL};
}
