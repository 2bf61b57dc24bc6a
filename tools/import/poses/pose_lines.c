/* SPDX-License-Identifier: Apache-2.0 */
#include "import/poses/pose_lines.h"

#include <stdlib.h>
#include <string.h>

#include "host/text.h"

char *pose_lines_next(pose_lines *lines)
{
    while (lines->rest != NULL) {
        char *line = strsep(&lines->rest, "\n");
        line += lines->number == 0 ? t3r_text_mark(t3r_text_of(line)) : 0;
        line += strspn(line, " \t\r");
        lines->number++;
        if (*line != '\0' && *line != '#') {
            return line;
        }
    }
    return NULL;
}

bool pose_lines_number(char **text, double *value)
{
    char *end, *start = *text;
    while (*start == ' ' || *start == '\t' || *start == ',') {
        start++;
    }
    *value = strtod(start, &end);
    if (end == start) {
        return false;
    }
    *text = end;
    return true;
}

bool pose_lines_pose(char **text, bool w_first, rigid *pose)
{
    bool good = true;
    for (int i = 0; i < 3 && good; i++) {
        good = pose_lines_number(text, &pose->position[i]);
    }
    for (int i = 0; i < 4 && good; i++) {
        good = pose_lines_number(text, &pose->rotation[w_first ? i : (i + 1) % 4]);
    }
    return good;
}
