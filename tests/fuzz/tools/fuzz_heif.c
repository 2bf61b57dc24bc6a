/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes that begin as HEIC or AVIF: an upright picture, or an error. */
#define _GNU_SOURCE /* memfd_create() */
#include "picture_bytes.h"
#include "pictures/heif.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
const char *__lsan_default_suppressions(void);

/* Returns the codecs that leave memory unfreed after damaged pictures, in which no sanitizer was built. */
const char *__lsan_default_suppressions(void)
{
    return "leak:libdav1d\nleak:libde265\n";
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (heif_is(data, size)) {
        try_picture(data, size);
    }
    return 0;
}
