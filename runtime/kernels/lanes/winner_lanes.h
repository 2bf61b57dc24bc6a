/* SPDX-License-Identifier: Apache-2.0 */
/* winner_row in vectors of WORDS disparities. The candidates of a left pixel among the right ones are kept in a window
 * that moves by one lane per pixel; the lane that leaves it is complete. */
#ifndef T3R_WINNER_LANES_H
#define T3R_WINNER_LANES_H

typedef int16_t words __attribute__((vector_size(BYTES)));

#define WORDS (BYTES / 2)

static inline TARGET words load_words(const int16_t *from, uint32_t count); /* INT16_MAX from `count` on */
static inline TARGET void store_words(int16_t *to, words x, uint32_t count);
/* Returns each lane's neighbour below; the lowest takes that of `next`. */
static inline TARGET words word_below(words x, words next);
static inline TARGET int16_t least_word(words x);
/* Returns the first lane that equals `value`; WORDS or more: none. */
static inline TARGET uint32_t first_equal(words x, int16_t value);

static inline TARGET words lesser(words a, words b)
{
    return (words)OF(min_epi16)((vector)a, (vector)b);
}

/* Returns a where x < y, else b. */
static inline TARGET words where_less(words x, words y, words a, words b)
{
    return (words)OF(blendv_epi8)((vector)b, (vector)a, OF(cmpgt_epi16)((vector)y, (vector)x));
}

static inline TARGET words all_words(int16_t x)
{
    return (words){0} + x;
}

/* Finds the least k with the least sum, and the least sum except beside it. */
static inline __attribute__((always_inline)) TARGET void left(const int16_t *sums, uint32_t count, int16_t least,
                                                              uint16_t *first, uint16_t *second)
{
    uint32_t k = 0, n = 0;
    for (; n < count; n += WORDS) {
        k = first_equal(load_words(sums + n, count - n), least);
        if (k < WORDS) {
            break;
        }
    }
    k += n;
    words other = all_words(INT16_MAX);
    for (n = 0; n < count; n += WORDS) {
        const words beside = load_words(t3r_winner_beside + T3R_PATH_MOST - k + n, count - n);
        other = lesser(other, load_words(sums + n, count - n) | beside);
    }
    *first = (uint16_t)k;
    *second = (uint16_t)least_word(other);
}

/* count: the number of disparities, as a constant */
static inline __attribute__((always_inline)) TARGET void winners(const t3r_winner_row *given, const uint32_t count)
{
    enum { VECTORS = T3R_PATH_MOST / WORDS };
    const t3r_winner_row all = *given, *row = &all; /* a copy, which vector writes cannot change */
    const uint32_t width = row->width, vectors = (count + WORDS - 1) / WORDS;
    const uint32_t last = (vectors - 1) * WORDS;
    const words none = all_words(INT16_MAX), nowhere = all_words(0);
    words best[VECTORS], at[VECTORS], places = all_words(0);
    for (int16_t i = 0; i < WORDS; i++) {
        places[i] = i;
    }
    for (uint32_t i = 0; i < vectors; i++) {
        best[i] = none;
        at[i] = nowhere;
    }
    for (uint32_t x = 0; x < width; x++) {
        const int16_t *sums = row->sums + (size_t)x * count;
        int16_t *best_to = row->best + (width - 1 - x) + last, *at_to = row->at + (width - 1 - x) + last;
        words least = none, next_best = none, next_at = nowhere;
        row->first[x] = row->second[x] = 0;
        const bool shown = row->luma[x] != 0;
        for (uint32_t i = 0; i < vectors; i++) {
            words better = best[i], place = at[i];
            if (shown) {
                const words sum = load_words(sums + i * WORDS, count - i * WORDS);
                least = lesser(least, sum);
                place = where_less(sum, better, places + (int16_t)(i * WORDS), place);
                better = lesser(better, sum);
            }
            best[i] = word_below(better, next_best);
            at[i] = word_below(place, next_at);
            next_best = better;
            next_at = place;
        }
        if (shown) {
            left(sums, count, least_word(least), &row->first[x], &row->second[x]);
        }
        /* the uppermost lane is complete; the lanes below it are written again */
        store_words(best_to, next_best, count - last);
        store_words(at_to, next_at, count - last);
    }
    /* the rest of the window, which has moved once more */
    _Pragma("GCC unroll 1") for (uint32_t n = 0; n + 1 < count; n++)
    {
        row->best[n] = best[(n + 1) / WORDS][(n + 1) % WORDS];
        row->at[n] = at[(n + 1) / WORDS][(n + 1) % WORDS];
    }
}

#endif
