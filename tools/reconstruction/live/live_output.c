/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/live/live_output.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/options/file_guard.h"
#include "cli/tables/json_output.h"
#include "reconstruction/reconstruction_error.h"
#include "scene/scene_file.h"

#define ERROR_BYTES 512

/* Opens the file of lines, cut to the length that it had with the state. */
static int open_lines(live_output *out, const char *path, uint64_t length)
{
    char error[ERROR_BYTES] = "";
    struct stat there;
    if (file_guard_write(path, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (length > 0 && (stat(path, &there) != 0 || (S_ISREG(there.st_mode) && (uint64_t)there.st_size < length))) {
        return cli_error(CLI_BAD_INPUT, "%s: lacks lines that were written before the state", path);
    }
    out->lines = fopen(path, length > 0 ? "r+" : "w");
    if (out->lines == NULL ||
        (length > 0 && S_ISREG(there.st_mode) &&
         (ftruncate(fileno(out->lines), (off_t)length) != 0 || fseeko(out->lines, 0, SEEK_END) != 0))) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", path, strerror(errno));
    }
    out->written = length;
    return CLI_OK;
}

int live_output_open(live_output *out, live_map *map, bool prints_table, live_state *state, bool *resumed)
{
    const live_options *o = &map->options;
    const bool lines_printed = live_options_print_lines(o);
    *out = (live_output){.prints_table = prints_table && !lines_printed, .lines = lines_printed ? stdout : NULL};
    *state = (live_state){0};
    *resumed = o->resume && access(o->state, F_OK) == 0;
    int code = *resumed ? live_state_read(o->state, map, state) : CLI_OK;
    if (code == CLI_OK && o->lines == NULL && state->lines_bytes > 0) {
        code = cli_error(CLI_BAD_INPUT, "%s: written with --lines: name its file", o->state);
    }
    if (code == CLI_OK && o->lines != NULL && !lines_printed) {
        code = open_lines(out, o->lines, state->lines_bytes);
    }
    if (code == CLI_OK && out->prints_table) {
        live_row_headings();
    }
    return code;
}

void live_output_close(live_output *out)
{
    if (out->lines != NULL && out->lines != stdout) {
        fclose(out->lines);
    }
    out->lines = NULL;
}

int live_output_row(live_output *out, const live_map *map, const live_row *row)
{
    if (out->prints_table) {
        live_row_print(row);
    }
    if (out->lines == NULL) {
        return CLI_OK;
    }
    char *text = json_text(live_row_json(row));
    if (text == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    out->written += out->lines != stdout ? strlen(text) + 1 : 0;
    const bool written = fprintf(out->lines, "%s\n", text) > 0 && fflush(out->lines) == 0;
    free(text);
    return written ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s: %s", map->options.lines, strerror(errno));
}

static int write_scene(live_map *map)
{
    char error[ERROR_BYTES] = "";
    const t3r_status status = t3r_get_scene(map->r.runtime, &map->r.scene);
    if (status != T3R_OK) {
        return reconstruction_error(status, "map", &map->r.config, map->r.arena_bytes);
    }
    return map->options.scene == NULL ||
                   scene_file_write(map->options.scene, &map->r.scene, 0, NULL, error, sizeof error) == 0
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "%s", error);
}

int live_output_snapshot(live_output *out, live_map *map, const live_row *row, const void *more, size_t more_bytes)
{
    const live_options *o = &map->options;
    if (row != NULL && (o->snapshot == 0 || !live_row_is_taken(row) || row->report.keyframes % o->snapshot != 0)) {
        return CLI_OK;
    }
    const live_state state = {.lines_bytes = out->written, .more = (void *)(uintptr_t)more, .more_bytes = more_bytes};
    const int code = write_scene(map);
    return code == CLI_OK && o->state != NULL ? live_state_write(o->state, map, &state) : code;
}
