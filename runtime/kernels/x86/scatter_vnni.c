/* Scattering by AVX-512's sums of products. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"

#define T3R_SCATTER_NAME t3r_scatter_vnni
#define T3R_SCATTER T3R_VNNI
#define T3R_SCATTER_ADD(sum, a, b) _mm256_dpwssd_epi32(sum, a, b)
#include "scatter_sixteen.h"

#else
typedef int t3r_no_scatter_vnni; /* a file may not be empty */
#endif
