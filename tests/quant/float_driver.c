/* SPDX-License-Identifier: Apache-2.0 */
/* float_driver HEAD.safetensors VIEW WIDTH HEIGHT OUT: runs the float graph of quant/ for comparison by a script. VIEW
 * holds the features, int8 [HEIGHT][WIDTH][9], then the retained pixels, a byte each; OUT gets every layer's output,
 * float32 in the machine's order, one plane after the other. */
#include <stdio.h>
#include <stdlib.h>

#include "float_run.h"
#include "host/file_bytes.h"

static void give_up(const char *why)
{
    fprintf(stderr, "float_driver: %s\n", why);
    exit(1);
}

int main(int argc, char **argv)
{
    char error[512];
    if (argc != 6) {
        give_up("HEAD.safetensors VIEW WIDTH HEIGHT OUT");
    }
    uint32_t width = (uint32_t)strtoul(argv[3], NULL, 10), height = (uint32_t)strtoul(argv[4], NULL, 10);
    size_t pixels = (size_t)width * height, head_bytes, view_bytes;
    uint8_t *head_file = t3r_file_bytes(argv[1], SIZE_MAX, &head_bytes, error, sizeof error);
    uint8_t *view = t3r_file_bytes(argv[2], SIZE_MAX, &view_bytes, error, sizeof error);
    if (head_file == NULL || view == NULL) {
        give_up(error);
    }
    float_head head;
    if (float_head_parse(&head, head_file, head_bytes, error, sizeof error) != 0) {
        give_up(error);
    }
    float_planes planes;
    if (view_bytes != pixels * (T3R_FEATURES + 1) ||
        float_run(&planes, &head, (const int8_t *)view, view + pixels * T3R_FEATURES, width, height) != 0) {
        give_up("the view has another size, or no memory");
    }
    FILE *out = fopen(argv[5], "wb");
    for (uint32_t n = 1; out != NULL && n <= head.graph.count; n++) {
        const float_plane *p = &planes.planes[n];
        fwrite(p->values, sizeof *p->values, (size_t)p->width * p->height * p->channels, out);
    }
    if (out == NULL || fclose(out) != 0) {
        give_up("cannot write");
    }
    float_planes_free(&planes);
    float_head_free(&head);
    free(head_file);
    free(view);
    return 0;
}
