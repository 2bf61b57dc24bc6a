/* What a source is called in messages and in recordings: its credentials and its folders are nobody else's business. */
#ifndef T3R_PLATFORM_SOURCE_NAME_H
#define T3R_PLATFORM_SOURCE_NAME_H

#include <stddef.h>

#define T3R_SOURCE_NAME_BYTES 256

/* The name of "adapter:what", or of what an adapter opens alone, cut off after bytes - 1: of a URL scheme, host and
 * path without user, password, query and fragment; of a path its last part; of a GStreamer pipeline, whose properties
 * may be passwords, "(pipeline)". A URL with an @ behind its host may have a malformed password: of it the scheme
 * alone. */
void t3r_source_name(const char *source, char *name, size_t bytes);

#endif
