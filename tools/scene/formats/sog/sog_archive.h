/* The members of a SOG's archive. */
#ifndef TRIM3R_TOOLS_SOG_ARCHIVE_H
#define TRIM3R_TOOLS_SOG_ARCHIVE_H

#include <stddef.h>
#include <stdint.h>

typedef struct sog_archive sog_archive;

/* Opens an archive in memory, which must outlive it. Returns NULL with the reason in error[] on failure. */
sog_archive *sog_archive_open(const uint8_t *bytes, size_t count, char *error, size_t error_bytes);
/* Returns a member, followed by a 0 that `count` excludes; free() it. Members larger than the archive plus 1 MiB are
 * refused. Returns NULL with "name: why" in error[] on failure. */
uint8_t *sog_archive_read(sog_archive *archive, const char *name, size_t *count, char *error, size_t error_bytes);
void sog_archive_close(sog_archive *archive);

#endif
