/* Memory for what is large, lives long and is read seldom: pages of a file without a name in TMPDIR or /var/tmp, which
 * the system may write out. Addresses stay; the file goes with the process. */
#ifndef T3R_PLATFORM_SPILL_H
#define T3R_PLATFORM_SPILL_H

#include <stddef.h>
#include <stdint.h>

typedef struct t3r_spill_part {
    uint8_t *bytes;
    size_t count, used;
} t3r_spill_part;

/* Starts with zeros. */
typedef struct t3r_spill {
    int file; /* a descriptor and 1; 0: none yet */
    uint64_t file_bytes;
    t3r_spill_part *parts;
    size_t part_count, part_capacity;
} t3r_spill;

/* So many bytes, zeros or anything; NULL: there is no room on the disk. */
uint8_t *t3r_spill_take(t3r_spill *spill, size_t count);
/* Takes back what was taken last. */
void t3r_spill_return(t3r_spill *spill, size_t count);
/* The pages need not stay in memory until they are looked at again. */
void t3r_spill_rest(const t3r_spill *spill);
void t3r_spill_free(t3r_spill *spill);

#endif
