/* SPDX-License-Identifier: Apache-2.0 */
/* score_pictures TARGET.png RENDER.png [MASK.png]: prints the measures of two PNG files as JSON, for the scripts of
 * this folder. */
#include <stdio.h>
#include <stdlib.h>

#include "pictures/metrics.h"
#include "pictures/picture.h"

static int read_picture(const char *path, uint32_t channels, picture *p)
{
    char error[512];
    if (picture_read(path, p, error, sizeof error) != 0) {
        fprintf(stderr, "%s\n", error);
        return -1;
    }
    if (p->channels != channels || p->bits != 8) {
        fprintf(stderr, "%s: %u channels of %u bits\n", path, (unsigned)p->channels, (unsigned)p->bits);
        picture_free(p);
        return -1;
    }
    return 0;
}

int main(int argc, char **argv)
{
    picture target = {0}, render = {0}, mask = {0};
    int failed = argc < 3 || read_picture(argv[1], 3, &target) != 0 || read_picture(argv[2], 3, &render) != 0 ||
                 (argc > 3 && read_picture(argv[3], 1, &mask) != 0) || target.width != render.width ||
                 target.height != render.height;
    if (!failed) {
        const uint8_t *a = target.samples, *b = render.samples, *m = mask.samples;
        uint32_t w = target.width, h = target.height;
        printf("{\"psnr\": %.9g, \"ssim\": %.9g, \"sharp\": %.9g, \"flip\": %.9g}\n", metric_psnr(a, b, m, w, h),
               metric_ssim(a, b, m, w, h), metric_sharp(a, b, m, w, h), metric_flip(a, b, m, w, h));
    }
    picture_free(&target);
    picture_free(&render);
    picture_free(&mask);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
