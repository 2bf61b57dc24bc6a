/* Stubs for builds without lens distortion: a camera with distortion is refused. */
#include "undistort.h"

#if !T3R_FEATURE_EXTRAS

t3r_status t3r_undistort_grid(const t3r_camera *camera, uint32_t width, uint32_t height, int32_t *grid)
{
    (void)camera, (void)width, (void)height, (void)grid;
    return T3R_ERR_UNSUPPORTED;
}

void t3r_undistort_colour(const int32_t *grid, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                          const uint8_t *const source[3], uint8_t *const out[3])
{
    (void)grid, (void)width, (void)height, (void)begin, (void)end, (void)source, (void)out;
}

void t3r_undistort_depth(const int32_t *grid, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                         const uint16_t *source, uint16_t *out)
{
    (void)grid, (void)width, (void)height, (void)begin, (void)end, (void)source, (void)out;
}

#endif
