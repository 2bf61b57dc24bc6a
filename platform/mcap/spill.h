/* Memory for large, long-lived data that is rarely read: pages of a nameless file in TMPDIR or /var/tmp, which the
 * system may write out. Addresses stay valid; the file disappears with the process. */
#ifndef T3R_PLATFORM_SPILL_H
#define T3R_PLATFORM_SPILL_H

#include <stddef.h>
#include <stdint.h>

typedef struct t3r_spill_part {
    uint8_t *bytes;
    size_t count, used;
} t3r_spill_part;

/* Initialise with zeros. */
typedef struct t3r_spill {
    int file; /* a descriptor plus 1; 0: none yet */
    uint64_t file_bytes;
    t3r_spill_part *parts;
    size_t part_count, part_capacity;
} t3r_spill;

/* Takes `count` bytes of undefined content. Returns NULL when the disk is full. */
uint8_t *t3r_spill_take(t3r_spill *spill, size_t count);
/* Gives back the bytes that were taken last. */
void t3r_spill_return(t3r_spill *spill, size_t count);
/* Lets the system drop the pages from memory until they are read again. */
void t3r_spill_rest(const t3r_spill *spill);
void t3r_spill_free(t3r_spill *spill);

#endif
