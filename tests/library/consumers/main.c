/* SPDX-License-Identifier: Apache-2.0 */
/* consumer: prints the hash of the scene, in plain C and with the processor's features, and the library's version. */
#include <inttypes.h>
#include <stdio.h>

#include "scene.h"
#include "trim3r.h"

static uint32_t features_of_processor(void)
{
    uint32_t features = 0;
#if defined(__x86_64__)
    __builtin_cpu_init();
    features |= __builtin_cpu_supports("avx2") ? T3R_CPU_AVX2 : 0;
#endif
    return features;
}

int main(void)
{
    printf("%016" PRIx64 " %016" PRIx64 " %s\n", build_scene(0), build_scene(features_of_processor()), t3r_version());
    return 0;
}
