/* SPDX-License-Identifier: Apache-2.0 */
#include "import/poses/pose_list.h"

#include <math.h>
#include <string.h>

#include "geometry/pose_check.h"
#include "geometry/quaternion.h"
#include "host/reason.h"
#include "import/poses/pose_lines.h"
#include "mcap/reader_limits.h"

#define MAX_STAMP_NS (POSE_LIST_MAX_SECONDS * 1000000000)
#define DIGITS "0123456789"

/* Converts seconds with up to nine decimal places to whole nanoseconds, without binary fractions in between; -1: it
 * cannot. */
static int64_t exact_seconds(const char *p)
{
    int64_t seconds = 0, fraction = 0, unit = 100000000;
    size_t digits = 0;
    for (; *p >= '0' && *p <= '9'; p++, digits++) {
        seconds = seconds * 10 + (*p - '0');
        if (seconds > POSE_LIST_MAX_SECONDS) {
            return -1;
        }
    }
    if (*p == '.') {
        for (p++; *p >= '0' && *p <= '9'; p++, digits++) {
            fraction += (*p - '0') * unit;
            unit /= 10;
        }
    }
    return digits > 0 && strchr(" \t,", *p) != NULL ? seconds * 1000000000 + fraction : -1;
}

static int64_t exact_nanoseconds(const char *p)
{
    int64_t value = 0;
    for (; *p >= '0' && *p <= '9'; p++) {
        const int64_t digit = *p - '0';
        if (value > (MAX_STAMP_NS - digit) / 10) {
            return -1;
        }
        value = value * 10 + digit;
    }
    return value;
}

/* Whether whole nanoseconds and a comma begin the line, and only commas separate its numbers: a comma may also be the
 * decimal point of another language. */
static bool is_euroc(const char *line)
{
    const size_t digits = strspn(line, DIGITS);
    bool only = digits > 0 && line[digits] == ',';
    for (const char *p = line; *p != '\0' && only; p++) {
        const bool blank = *p == ' ' || *p == '\t';
        only = !blank || p[-1] == ',' || strchr(" \t\r,", p[1]) != NULL; /* strchr() finds the end, too */
    }
    return only;
}

static const char *pose_error(rigid *pose)
{
    const char *wrong = pose_check_position(pose->position);
    const double norm = quaternion_norm(pose->rotation);
    if (wrong != NULL || pose_check(pose) == NULL) {
        return wrong;
    }
    if (!(norm > 1e-6) || !isfinite(norm)) {
        return "a quaternion without direction";
    }
    quaternion_normalise(pose->rotation);
    return NULL;
}

/* Returns NULL, or what is wrong with the line. */
static const char *parse_line(char *line, bool exact, bool euroc, pose_list_item *out)
{
    out->stamp_ns = euroc ? exact_nanoseconds(line) : exact_seconds(line);
    if (!pose_lines_number(&line, &out->seconds) || !isfinite(out->seconds) || (exact && out->stamp_ns < 0)) {
        return euroc ? "no time in nanoseconds" : "no time in seconds";
    }
    out->seconds = euroc ? out->seconds * 1e-9 : out->seconds;
    if (!pose_lines_pose(&line, euroc, &out->pose)) {
        return euroc ? "not 'nanoseconds,px,py,pz,qw,qx,qy,qz'" : "not 'seconds tx ty tz qx qy qz qw'";
    }
    double more;
    return !euroc && pose_lines_number(&line, &more) ? "more than eight numbers" : pose_error(&out->pose);
}

bool pose_list_next(pose_list *list, pose_list_item *out)
{
    pose_lines lines = {.rest = list->rest, .number = list->line};
    bool found = false;
    for (char *line; !found && list->count <= T3R_LIMIT_POSES && (line = pose_lines_next(&lines)) != NULL;) {
        const bool euroc = is_euroc(line);
        const char *wrong = parse_line(line, list->exact, euroc, out);
        found = wrong == NULL;
        list->euroc = list->euroc || (found && euroc);
        if (!found) {
            pose_losses_add(&list->losses, 1, "line %zu: %s", lines.number, wrong);
        }
    }
    list->rest = lines.rest;
    list->line = lines.number;
    list->count += found;
    return found && list->count <= T3R_LIMIT_POSES;
}

int pose_list_end(const pose_list *list, const char *path, char *error, size_t error_bytes)
{
    if (list->count > T3R_LIMIT_POSES) {
        return t3r_reason(error, error_bytes, "%s: line %zu: " T3R_LIMIT_TEXT("more than ", T3R_LIMIT_POSES, " poses"),
                          path, list->line);
    }
    return list->count > 0 ? 0
                           : t3r_reason(error, error_bytes, "%s: %s", path,
                                        list->losses.count > 0 ? list->losses.first : "holds no pose");
}
