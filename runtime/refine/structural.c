#include "structural.h"

#include "core/fixed.h"

enum { SIDE = T3R_TILE_SIDE };

#define NOISE_Q8 (64u << 8)     /* levels^2 */
#define WEIGHT_Q17 (256u << 17) /* over a contrast in Q8: a weight in Q9, at most 4 */
#define MIX_Q4 5
#define MOST_Q4 (255 << 4)

typedef uint32_t plane[SIDE][SIDE];

/* Replaces each value by the sum of the 3 x 3 around it, modulo 2^32. Values beyond the tile are 0. */
static void sum_windows(plane p)
{
    uint32_t above[SIDE] = {0};
    for (uint32_t j = 0; j < SIDE; j++) {
        uint32_t down[SIDE + 2] = {0};
        for (uint32_t i = 0; i < SIDE; i++) {
            down[i + 1] = above[i] + p[j][i] + (j + 1 < SIDE ? p[j + 1][i] : 0);
            above[i] = p[j][i];
        }
        for (uint32_t i = 0; i < SIDE; i++) {
            p[j][i] = down[i] + down[i + 1] + down[i + 2];
        }
    }
}

/* Sums over the window around each pixel. */
typedef struct windows {
    union {
        plane drawn;  /* sum, levels Q4 */
        plane weight; /* then the weight, Q9 */
    };
    union {
        plane target;
        plane shift; /* weight times mean residual, Q13 */
    };
    plane squares; /* of drawn and target, Q8: below 9 x 2^25 */
    uint8_t count[SIDE][SIDE];
} windows;

/* Returns x / n, n at most 9. */
static int32_t over(int32_t x, uint32_t n)
{
    static const uint16_t inverse_q15[] = {0, 32768, 16384, 10923, 8192, 6554, 5461, 4681, 4096, 3641};
    return (int32_t)t3r_round_shift64((int64_t)x * inverse_q15[n], 15);
}

static void count_windows(const t3r_wanted *tile, windows *w)
{
    for (uint32_t j = 0; j < SIDE; j++) {
        for (uint32_t i = 0; i < SIDE; i++) {
            w->drawn[j][i] = tile->counts[j][i] & 1;
        }
    }
    sum_windows(w->drawn);
    for (uint32_t j = 0; j < SIDE; j++) {
        for (uint32_t i = 0; i < SIDE; i++) {
            w->count[j][i] = (uint8_t)w->drawn[j][i];
        }
    }
}

static void take_pixels(const t3r_wanted *tile, int c, windows *w)
{
    for (uint32_t j = 0; j < SIDE; j++) {
        for (uint32_t i = 0; i < SIDE; i++) {
            const int32_t counts = tile->counts[j][i] & 1;
            const int32_t drawn_q7 = T3R_MIN((int32_t)tile->pixels.colour_q7[c][j][i], MOST_Q4 << 3);
            const int32_t drawn = t3r_round_shift32(drawn_q7, 3) * counts;
            const int32_t target = t3r_clamp32(drawn + tile->residual_q4[c][j][i], 0, MOST_Q4) * counts;
            w->drawn[j][i] = (uint32_t)drawn;
            w->target[j][i] = (uint32_t)target;
            w->squares[j][i] = (uint32_t)(drawn * drawn + target * target);
        }
    }
    sum_windows(w->drawn);
    sum_windows(w->target);
    sum_windows(w->squares);
}

static void weigh_windows(windows *w)
{
    for (uint32_t j = 0; j < SIDE; j++) {
        for (uint32_t i = 0; i < SIDE; i++) {
            const uint32_t n = w->count[j][i], drawn = w->drawn[j][i], target = w->target[j][i];
            /* n^2 times both variances: exact, at least 0 */
            const uint32_t contrast = n * w->squares[j][i] - drawn * drawn - target * target;
            const uint32_t weight = WEIGHT_Q17 * n * n / T3R_MAX(contrast + NOISE_Q8 * n * n, 1u);
            w->weight[j][i] = weight;
            w->shift[j][i] = (uint32_t)over((int32_t)weight * ((int32_t)target - (int32_t)drawn), n); /* below 2^27 */
        }
    }
    sum_windows(w->weight);
    sum_windows(w->shift);
}

void t3r_structural_residuals(t3r_wanted *tile)
{
    windows w;
    count_windows(tile, &w);
    for (int c = 0; c < 3; c++) {
        take_pixels(tile, c, &w);
        weigh_windows(&w);
        for (uint32_t j = 0; j < SIDE; j++) {
            for (uint32_t i = 0; i < SIDE; i++) {
                const int32_t r = tile->residual_q4[c][j][i];
                const int32_t asked_q13 =
                    over(r * (int32_t)w.weight[j][i] - (int32_t)w.shift[j][i], w.count[j][i]); /* below 2^28 */
                const int32_t mixed = r + t3r_round_shift32(MIX_Q4 * (asked_q13 - r * (1 << 9)), 13);
                tile->residual_q4[c][j][i] = (int16_t)t3r_clamp32(mixed, -MOST_Q4, MOST_Q4);
            }
        }
    }
}

void t3r_structural_loss(t3r_wanted *tile, const t3r_structure *structure)
{
    t3r_level_residuals(tile, &structure->levels);
    if (structure->contrast) {
        t3r_structural_residuals(tile);
    }
}
