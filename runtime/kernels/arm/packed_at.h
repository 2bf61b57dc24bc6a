/* Where a variant keeps centres of its own in the place of the neighbours, which are aligned to 2 bytes alone. */
#ifndef T3R_KERNELS_ARM_PACKED_AT_H
#define T3R_KERNELS_ARM_PACKED_AT_H

#include "kernels/nearest.h"

#define T3R_PACKED_ROOM (sizeof(t3r_neighbours) - 2)

/* Aligned to 4 bytes. */
static inline void *t3r_aligned_centres(const t3r_neighbours *neighbours)
{
    return (void *)(((uintptr_t)neighbours + 3) & ~(uintptr_t)3);
}

#endif
