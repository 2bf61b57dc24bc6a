/* SPDX-License-Identifier: Apache-2.0 */
/* Names of sources in messages and recordings, without credentials and folders. */
#ifndef T3R_PLATFORM_SOURCE_NAME_H
#define T3R_PLATFORM_SOURCE_NAME_H

#include <stddef.h>

#define T3R_SOURCE_NAME_BYTES 256

/* Writes the name of "adapter:what", or of the part that an adapter opens, cut off after bytes - 1. For a URL: scheme,
 * host and path without user, password, query and fragment. For a path: its last part. For a GStreamer pipeline, whose
 * properties may be passwords: "(pipeline)". A URL with an @ after its host may hold a malformed password, so only its
 * scheme is written. */
void t3r_source_name(const char *source, char *name, size_t bytes);

#endif
