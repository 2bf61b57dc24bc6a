/* SPDX-License-Identifier: Apache-2.0 */
/* libheif, loaded when a picture first needs it: with its codecs of video it would double the time in which the program
 * starts. */
#ifndef TRIM3R_TOOLS_HEIF_FUNCTIONS_H
#define TRIM3R_TOOLS_HEIF_FUNCTIONS_H

#include <stddef.h>

#include <libheif/heif.h>

#define HEIF_FUNCTIONS(FUNCTION)                                                                                       \
    FUNCTION(context_alloc)                                                                                            \
    FUNCTION(context_free)                                                                                             \
    FUNCTION(context_get_primary_image_handle)                                                                         \
    FUNCTION(context_read_from_memory_without_copy)                                                                    \
    FUNCTION(context_set_maximum_image_size_limit)                                                                     \
    FUNCTION(decode_image)                                                                                             \
    FUNCTION(get_version)                                                                                              \
    FUNCTION(image_get_height)                                                                                         \
    FUNCTION(image_get_plane_readonly)                                                                                 \
    FUNCTION(image_get_width)                                                                                          \
    FUNCTION(image_handle_get_height)                                                                                  \
    FUNCTION(image_handle_get_ispe_height)                                                                             \
    FUNCTION(image_handle_get_ispe_width)                                                                              \
    FUNCTION(image_handle_get_list_of_metadata_block_IDs)                                                              \
    FUNCTION(image_handle_get_metadata)                                                                                \
    FUNCTION(image_handle_get_metadata_size)                                                                           \
    FUNCTION(image_handle_get_width)                                                                                   \
    FUNCTION(image_handle_has_alpha_channel)                                                                           \
    FUNCTION(image_handle_release)                                                                                     \
    FUNCTION(image_release)

/* The library's functions without their prefix heif_. */
typedef struct heif_functions {
#define HEIF_MEMBER(name) __typeof__(heif_##name) *name;
    HEIF_FUNCTIONS(HEIF_MEMBER)
#undef HEIF_MEMBER
} heif_functions;

/* Returns the functions; any thread may call it. Returns NULL, with what is missing and the remedy in error[], where
 * the library does not load. */
const heif_functions *heif_functions_load(char *error, size_t error_bytes);

#endif
