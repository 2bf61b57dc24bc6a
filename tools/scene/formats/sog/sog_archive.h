/* The members of a SOG's archive. */
#ifndef TRIM3R_TOOLS_SOG_ARCHIVE_H
#define TRIM3R_TOOLS_SOG_ARCHIVE_H

#include <stddef.h>
#include <stdint.h>

typedef struct sog_archive sog_archive;

/* Of bytes that outlive it. NULL with the reason in error[]. */
sog_archive *sog_archive_open(const uint8_t *bytes, size_t count, char *error, size_t error_bytes);
/* A member with a 0 behind it, which `count` leaves out; free() it. It is no larger than the archive and a MiB. NULL
 * with "name: why" in error[]. */
uint8_t *sog_archive_read(sog_archive *archive, const char *name, size_t *count, char *error, size_t error_bytes);
void sog_archive_close(sog_archive *archive);

#endif
