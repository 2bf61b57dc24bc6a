/* SPDX-License-Identifier: Apache-2.0 */
/* The best settings for some sizes of RAM: tools/study/scripts/ram --write makes this file. */
#ifndef TRIM3R_TOOLS_RAM_ROWS_H
#define TRIM3R_TOOLS_RAM_ROWS_H

#define RAM_STRIP_ROWS 8u
#define RAM_STACK_BYTES 12288u
#define RAM_PROGRAM_BYTES 4096u

/* X(RAM in bytes, side, views, Gaussians, head, refine), a row a size from the smallest up */
#define RAM_ROWS(X)                                                                                                    \
    X(131072, 48, 2, 281, "tiny", 4)                                                                                   \
    X(196608, 64, 2, 434, "tiny", 4)                                                                                   \
    X(262144, 80, 2, 744, "tiny", 4)                                                                                   \
    X(524288, 128, 2, 1356, "tiny", 4)                                                                                 \
    X(1048576, 192, 2, 1865, "small", 4)                                                                               \
    X(4194304, 256, 2, 17616, "small", 4)

#endif
