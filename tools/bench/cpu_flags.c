#include "bench/cpu_flags.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "host/text.h"

/* Reads the value of the first line of /proc/cpuinfo that begins with one of these words. */
static bool read_line(const char *const words[], char *value, size_t bytes)
{
    char line[8192];
    bool found = false;
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file != NULL && !found && fgets(line, sizeof line, file) != NULL) {
        for (int i = 0; words[i] != NULL && !found; i++) {
            const char *colon = strchr(line, ':');
            found = colon != NULL && strncmp(line, words[i], strlen(words[i])) == 0;
            if (found) {
                t3r_text text = t3r_text_of(colon + 1 + strspn(colon + 1, " \t"));
                text.count -= text.count > 0 && text.chars[text.count - 1] == '\n';
                t3r_text_copy(value, bytes, text);
            }
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    return found;
}

void cpu_flags(char flags[CPU_FLAGS_BYTES])
{
    static const char *const lines[] = {"flags", "Features", NULL};
    static const char *const families[] = {"sse", "ssse", "avx", "fma", "asimd", "neon", "sve", "mve"};
    char all[8192], *rest = NULL;
    size_t length = 0;
    flags[0] = '\0';
    if (!read_line(lines, all, sizeof all)) {
        return;
    }
    for (char *word = strtok_r(all, " ", &rest); word != NULL; word = strtok_r(NULL, " ", &rest)) {
        for (size_t i = 0; i < sizeof families / sizeof families[0]; i++) {
            if (strncmp(word, families[i], strlen(families[i])) == 0 && length + strlen(word) + 2 < CPU_FLAGS_BYTES) {
                length +=
                    (size_t)snprintf(flags + length, CPU_FLAGS_BYTES - length, "%s%s", length == 0 ? "" : " ", word);
                break;
            }
        }
    }
}

void cpu_name(char name[CPU_FLAGS_BYTES])
{
    static const char *const lines[] = {"model name", "Model", NULL};
    if (!read_line(lines, name, CPU_FLAGS_BYTES)) {
        name[0] = '\0';
    }
}
