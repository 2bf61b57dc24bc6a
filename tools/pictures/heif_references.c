/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/heif_references.h"

#include <stdbool.h>
#include <string.h>

#define FULL_BOX_BYTES 4u /* version and flags before the contents */

typedef struct span {
    const uint8_t *at;
    size_t count;
} span;

typedef struct box {
    const uint8_t *type; /* four letters */
    span content;
} box;

typedef struct reference {
    uint32_t from, to;
    bool ends; /* `to` refers to no other picture */
} reference;

typedef struct references {
    reference list[HEIF_REFERENCES_MOST];
    uint32_t count;
    bool too_many;
} references;

/* Takes a big-endian number from the front; 0 at the end. */
static uint64_t take_number(span *s, uint32_t bytes)
{
    uint64_t value = 0;
    for (uint32_t i = 0; i < bytes && s->count > 0; i++) {
        value = value << 8 | *s->at++;
        s->count--;
    }
    return value;
}

static bool take_box(span *s, box *out)
{
    if (s->count < 8) {
        return false;
    }
    uint64_t header = 8, size = take_number(s, 4);
    out->type = s->at;
    (void)take_number(s, 4);
    if (size == 1 && s->count >= 8) {
        header = 16;
        size = take_number(s, 8);
    }
    const uint64_t bytes = size == 0 ? s->count : size < header ? 0 : size - header;
    out->content = (span){s->at, bytes < s->count ? (size_t)bytes : s->count};
    s->at += out->content.count;
    s->count -= out->content.count;
    return true;
}

static bool is(const box *b, const char *type)
{
    return memcmp(b->type, type, 4) == 0;
}

/* Adds the references of one picture. A picture consists of those that `dimg` names, and has those as its alpha that
 * name it by `auxl`. */
static void add_references(references *all, const box *b, uint32_t id_bytes)
{
    span s = b->content;
    const bool is_part = is(b, "dimg");
    const uint32_t id = (uint32_t)take_number(&s, id_bytes), count = (uint32_t)take_number(&s, 2);
    for (uint32_t i = 0; i < count && s.count > 0 && (is_part || is(b, "auxl")); i++) {
        const uint32_t other = (uint32_t)take_number(&s, id_bytes);
        if (all->count == HEIF_REFERENCES_MOST) {
            all->too_many = true;
            return;
        }
        all->list[all->count++] = (reference){.from = is_part ? id : other, .to = is_part ? other : id};
    }
}

static void find_references(references *all, span file)
{
    box meta, list, one;
    while (take_box(&file, &meta)) {
        (void)take_number(&meta.content, FULL_BOX_BYTES);
        while (is(&meta, "meta") && take_box(&meta.content, &list)) {
            const uint32_t id_bytes = take_number(&list.content, FULL_BOX_BYTES) >> 24 == 0 ? 2 : 4;
            while (is(&list, "iref") && take_box(&list.content, &one)) {
                add_references(all, &one, id_bytes);
            }
        }
    }
}

/* Removes the references to pictures that refer to no other. */
static void remove_ends(references *all)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < all->count; i++) {
        all->list[i].ends = true;
        for (uint32_t j = 0; j < all->count && all->list[i].ends; j++) {
            all->list[i].ends = all->list[j].from != all->list[i].to;
        }
    }
    for (uint32_t i = 0; i < all->count; i++) {
        if (!all->list[i].ends) {
            all->list[kept++] = all->list[i];
        }
    }
    all->count = kept;
}

const char *heif_references_check(const uint8_t *bytes, size_t count)
{
    references all;
    all.count = 0;
    all.too_many = false;
    find_references(&all, (span){bytes, count});
    if (all.too_many) {
        return "over 4096 references between its pictures";
    }
    for (uint32_t i = 0; i < HEIF_DEPTH_MOST && all.count > 0; i++) {
        remove_ends(&all);
    }
    return all.count > 0 ? "a picture consists of itself, or of others in over 8 steps" : NULL;
}
