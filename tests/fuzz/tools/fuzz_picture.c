/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes as a PNG or JPEG. */
#define _GNU_SOURCE /* memfd_create() */
#include "picture_bytes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    try_picture(data, size);
    return 0;
}
