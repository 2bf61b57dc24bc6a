/* SPDX-License-Identifier: Apache-2.0 */
/* The best settings for some sizes of RAM: tools/study/scripts/ram --write makes this file. */
#ifndef T3R_RAM_ROWS_H
#define T3R_RAM_ROWS_H

#define T3R_RAM_STRIP_ROWS 8u
#define T3R_RAM_STACK_BYTES 12288u
#define T3R_RAM_PROGRAM_BYTES 4096u

/* X(ram bytes, side, views, Gaussians, weights, head column bytes, refine), a row a size; weights NULL:
 * the head `analytic` */
#define T3R_RAM_ROWS(X)                                                                                                \
    X(131072, 48, 2, 364, "tiny", 112, 4)                                                                              \
    X(196608, 64, 2, 434, "tiny", 125, 4)                                                                              \
    X(262144, 80, 2, 744, "tiny", 136, 4)                                                                              \
    X(524288, 128, 2, 1356, "tiny", 148, 4)                                                                            \
    X(1048576, 192, 2, 1865, "small", 412, 4)                                                                          \
    X(4194304, 256, 2, 17616, "small", 414, 4)

#endif
