/* Reads the fields of an MCAP record in order. The first read past the end sets `failed`; later ones give zeros. */
#ifndef T3R_PLATFORM_MCAP_FIELDS_H
#define T3R_PLATFORM_MCAP_FIELDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host/bytes.h"
#include "host/text.h"

typedef struct t3r_mcap_fields {
    const uint8_t *bytes;
    size_t count, at;
    bool failed;
} t3r_mcap_fields;

static inline const uint8_t *t3r_mcap_take(t3r_mcap_fields *in, uint64_t count)
{
    if (in->failed || in->count - in->at < count) {
        in->failed = true;
        return NULL;
    }
    const uint8_t *bytes = in->bytes + in->at;
    in->at += (size_t)count;
    return bytes;
}

static inline uint16_t t3r_mcap_take_u16(t3r_mcap_fields *in)
{
    const uint8_t *bytes = t3r_mcap_take(in, 2);
    return bytes == NULL ? 0 : t3r_load_le16(bytes);
}

static inline uint32_t t3r_mcap_take_u32(t3r_mcap_fields *in)
{
    const uint8_t *bytes = t3r_mcap_take(in, 4);
    return bytes == NULL ? 0 : t3r_load_le32(bytes);
}

static inline uint64_t t3r_mcap_take_u64(t3r_mcap_fields *in)
{
    const uint8_t *bytes = t3r_mcap_take(in, 8);
    return bytes == NULL ? 0 : t3r_load_le64(bytes);
}

static inline t3r_text t3r_mcap_take_text(t3r_mcap_fields *in)
{
    const uint32_t count = t3r_mcap_take_u32(in);
    const uint8_t *bytes = t3r_mcap_take(in, count);
    return bytes == NULL ? (t3r_text){"", 0} : (t3r_text){(const char *)bytes, count};
}

#endif
