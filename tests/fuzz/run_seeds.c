/* SPDX-License-Identifier: Apache-2.0 */
/* run_seeds [FOLDER...]: runs a fuzz target without a fuzzer, for the build with sanitizers, on every file of the
 * folders, each also with some bytes changed, and on random bytes: the same ones each time. */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHANGED_A_FILE = 64, RANDOM_STRINGS = 200, MOST_RANDOM_BYTES = 300, MOST_FILE_BYTES = 1 << 20 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static uint64_t state = 1;

static uint32_t random_below(uint32_t bound)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((state >> 33) % bound);
}

/* Gives the target a copy of exactly its bytes, so that sanitizers notice a read beyond them. */
static void run(const uint8_t *data, size_t size)
{
    uint8_t *copy = malloc(size > 0 ? size : 1);
    if (copy == NULL) {
        abort();
    }
    memcpy(copy, data, size);
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
}

/* Runs the file unchanged, with a few changed bytes, and truncated. */
static void run_file(const char *path)
{
    static uint8_t data[MOST_FILE_BYTES], changed[MOST_FILE_BYTES];
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return;
    }
    size_t size = fread(data, 1, sizeof data, file);
    fclose(file);
    run(data, size);
    for (int i = 0; i < CHANGED_A_FILE && size > 0; i++) {
        memcpy(changed, data, size);
        for (uint32_t j = 0; j <= (uint32_t)i; j++) {
            changed[random_below((uint32_t)size)] = (uint8_t)random_below(256);
        }
        run(changed, i % 2 == 0 ? size : random_below((uint32_t)size));
    }
}

static int run_folder(const char *path)
{
    struct dirent **entries;
    int count = scandir(path, &entries, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        char name[4096];
        snprintf(name, sizeof name, "%s/%s", path, entries[i]->d_name);
        if (entries[i]->d_name[0] != '.') {
            run_file(name);
        }
        free(entries[i]);
    }
    if (count < 0) {
        perror(path);
        return 1;
    }
    free(entries);
    return 0;
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (run_folder(argv[i]) != 0) {
            return 1;
        }
    }
    for (int i = 0; i < RANDOM_STRINGS; i++) {
        uint8_t data[MOST_RANDOM_BYTES];
        size_t size = random_below(MOST_RANDOM_BYTES + 1);
        for (size_t j = 0; j < size; j++) {
            data[j] = (uint8_t)random_below(256);
        }
        run(data, size);
    }
    return 0;
}
