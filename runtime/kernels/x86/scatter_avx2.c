/* Scattering by AVX2. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"

#define T3R_SCATTER_NAME t3r_scatter_avx2
#define T3R_SCATTER T3R_AVX2
#define T3R_SCATTER_ADD(sum, a, b) _mm256_add_epi32(sum, _mm256_madd_epi16(a, b))
#include "scatter_sixteen.h"

#else
typedef int t3r_no_scatter_avx2; /* a file may not be empty */
#endif
