/* Depth for what stereo could not match: that of the surroundings (SPEC.md, "Stereo: filling"). */
#ifndef T3R_STEREO_FILL_H
#define T3R_STEREO_FILL_H

#include <stddef.h>

#include "views.h"

/* Bytes of work, aligned to 2: a plane of costs and one of luma. */
#define T3R_STEREO_FILL_BYTES(width, height) (T3R_PIXELS_(width, height) * 3)

/* Every pixel of something that has no depth takes that of the pixel to which the way is the shortest, steps of luma
 * counting as length; confidence T3R_STEREO_FILLED. In a view without any depth nothing is filled. */
void t3r_stereo_fill(const t3r_view *view, void *work);

#endif
