/* What every consumer of the library builds, with nothing but the public headers. */
#ifndef T3R_TESTS_CONSUMER_SCENE_H
#define T3R_TESTS_CONSUMER_SCENE_H

#include <stdint.h>

/* A scene of two made-up views by the shipped head `small`, and a view of it: all stages' hashes folded into one. `cpu`
 * are T3R_CPU_... features, which must not matter. On an error the status, as a number of 64 bits. */
uint64_t build_scene(uint32_t cpu);

#endif
