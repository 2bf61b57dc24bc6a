#include "scene/formats/sog/sog_archive.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>
#include <zip.h>

#include "host/reason.h"

struct sog_archive {
    zip_t *zip;
    uint64_t most; /* largest size of a member in bytes */
};

sog_archive *sog_archive_open(const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    zip_error_t why;
    zip_error_init(&why);
    sog_archive *archive = malloc(sizeof *archive);
    zip_source_t *source = archive == NULL ? NULL : zip_source_buffer_create(bytes, count, 0, &why);
    zip_t *zip = source == NULL ? NULL : zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &why);
    if (zip != NULL) {
        *archive = (sog_archive){zip, (uint64_t)count + (UINT64_C(1) << 20)};
    } else {
        (void)t3r_reason(error, error_bytes, "no zip archive that can be read: %s", zip_error_strerror(&why));
        if (source != NULL) {
            zip_source_free(source);
        }
        free(archive);
        archive = NULL;
    }
    zip_error_fini(&why);
    return archive;
}

uint8_t *sog_archive_read(sog_archive *archive, const char *name, size_t *count, char *error, size_t error_bytes)
{
    zip_stat_t about;
    const zip_int64_t index = zip_name_locate(archive->zip, name, 0);
    if (index < 0 || zip_stat_index(archive->zip, (zip_uint64_t)index, 0, &about) != 0 ||
        (about.valid & ZIP_STAT_SIZE) == 0) {
        (void)t3r_reason(error, error_bytes, "%s: the archive does not hold it", name);
        return NULL;
    }
    if (about.size > archive->most) {
        (void)t3r_reason(error, error_bytes, "%s: %" PRIu64 " bytes; at most %" PRIu64 " are read", name,
                         (uint64_t)about.size, archive->most);
        return NULL;
    }
    uint8_t *bytes = malloc((size_t)about.size + 1);
    zip_file_t *member = bytes == NULL ? NULL : zip_fopen_index(archive->zip, (zip_uint64_t)index, 0);
    const zip_int64_t got = member == NULL ? -1 : zip_fread(member, bytes, about.size);
    /* reading to the end checks the CRC */
    uint8_t more;
    const bool whole = got >= 0 && (uint64_t)got == about.size && zip_fread(member, &more, 1) == 0;
    if (member != NULL) {
        zip_fclose(member);
    }
    if (!whole) {
        (void)t3r_reason(error, error_bytes, "%s: it cannot be read", name);
        free(bytes);
        return NULL;
    }
    bytes[about.size] = 0;
    *count = (size_t)about.size;
    return bytes;
}

void sog_archive_close(sog_archive *archive)
{
    zip_discard(archive->zip);
    free(archive);
}
