/* NumPy's .npz: a zip archive of NAME.npy, stored or deflated, through libzip. */
#ifndef TRIM3R_TOOLS_NPZ_H
#define TRIM3R_TOOLS_NPZ_H

#include <stddef.h>
#include <stdint.h>

typedef struct npz npz;

/* An archive in memory, which must outlive it. NULL with what is wrong in error[]. */
npz *npz_open(const uint8_t *bytes, size_t count, char *error, size_t error_bytes);
void npz_close(npz *archive);

/* The bytes of the array NAME, at most `most` of them, checked against the archive's CRC; free() them. 1; 0 when there
 * is none of that name; -1 with what is wrong in error[]. */
int npz_read(npz *archive, const char *name, size_t most, uint8_t **bytes, size_t *count, char *error,
             size_t error_bytes);

#endif
