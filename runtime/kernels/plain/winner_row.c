#include "kernels/winner_row.h"

const int16_t t3r_winner_beside[2 * T3R_PATH_MOST] = {
    [T3R_PATH_MOST - 1] = INT16_MAX, [T3R_PATH_MOST] = INT16_MAX, [T3R_PATH_MOST + 1] = INT16_MAX};

/* 0, 1, 2...: k as 16-bit values for the loops below. */
typedef struct counting {
    int16_t k[T3R_PATH_MOST];
} counting;

static int16_t least_of(const int16_t *sums, size_t count)
{
    int16_t least = INT16_MAX;
    for (size_t i = 0; i < count; i++) {
        least = sums[i] < least ? sums[i] : least;
    }
    return least;
}

/* Returns the first k whose sum is `least`. */
static int16_t first_of(const int16_t *sums, const int16_t *restrict k, size_t count, int16_t least)
{
    int16_t first = INT16_MAX;
    for (size_t i = 0; i < count; i++) {
        int16_t other = (int16_t) - (sums[i] != least); /* all bits, or none */
        int16_t at = (int16_t)((k[i] | other) & INT16_MAX);
        first = at < first ? at : first;
    }
    return first;
}

/* Returns the least of the sums where `beside` is 0. */
static int16_t second_of(const int16_t *sums, const int16_t *beside, size_t count)
{
    int16_t second = INT16_MAX;
    for (size_t i = 0; i < count; i++) {
        int16_t sum = (int16_t)(sums[i] | beside[i]);
        second = sum < second ? sum : second;
    }
    return second;
}

/* Offers all candidates of a left pixel to the right pixels, each of which keeps its least sum, the first among equals.
 * best, at: start at the right pixel of k = 0. */
static void offer(const int16_t *sums, const int16_t *k, size_t count, int16_t *restrict best, int16_t *restrict at)
{
    for (size_t i = 0; i < count; i++) {
        int16_t old = best[i], older = at[i], sum = sums[i], here = k[i];
        at[i] = sum < old ? here : older;
        best[i] = sum < old ? sum : old;
    }
}

void t3r_winner_row_c(const t3r_winner_row *row)
{
    const size_t width = row->width, count = row->disparities & ~(T3R_PATH_LANES - 1);
    const size_t right = T3R_MATCH_RIGHT(width, count);
    counting order;
    for (size_t k = 0; k < count; k++) {
        order.k[k] = (int16_t)k;
    }
    for (size_t n = 0; n < right; n++) {
        row->best[n] = INT16_MAX;
        row->at[n] = 0;
    }
    for (size_t x = 0; x < width; x++) {
        const int16_t *sums = row->sums + x * count;
        int16_t first = 0, second = 0;
        if (row->luma[x] != 0) {
            offer(sums, order.k, count, row->best + (width - 1 - x), row->at + (width - 1 - x));
            first = first_of(sums, order.k, count, least_of(sums, count));
            second = second_of(sums, t3r_winner_beside + T3R_PATH_MOST - first, count);
        }
        row->first[x] = (uint16_t)first;
        row->second[x] = (uint16_t)second;
    }
}
