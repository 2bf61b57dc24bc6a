/* Every entry of the table of kernels, in plain C and in each variant that this processor has: random and largest
 * values, odd lengths, buffers that lie anywhere beside forbidden pages. A variant that fails is named with its input's
 * seed; `test_kernels ENTRY SEED` runs that one again. `test_kernels --rounds N FIRST` tries N seeds from FIRST on of
 * each, for as long as one likes. */
#include "checks.h"
#include "cpu.h"
#include "guarded.h"
#include "kernels/variants.h"

/* X(entry, check): in the table's order. */
#define ENTRIES(X)                                                                                                     \
    X(packed_row, check_packed_row)                                                                                    \
    X(nv12_row, check_nv12_row)                                                                                        \
    X(triple_row, check_triple_row)                                                                                    \
    X(box_sums, check_box_sums)                                                                                        \
    X(weigh_row, check_weigh_row)                                                                                      \
    X(divide_row, check_divide_row)                                                                                    \
    X(unproject, check_unproject)                                                                                      \
    X(locate, check_locate)                                                                                            \
    X(ray_row, check_ray_row)                                                                                          \
    X(census_row, check_census_row)                                                                                    \
    X(census_costs, check_census_costs)                                                                                \
    X(path_row, check_path_row)                                                                                        \
    X(winner_row, check_winner_row)                                                                                    \
    X(luma_row, check_luma_row)                                                                                        \
    X(split_row, check_split_row)                                                                                      \
    X(db2_predict, check_db2_predict)                                                                                  \
    X(db2_lift, check_db2_lift)                                                                                        \
    X(db2_split, check_db2_split)                                                                                      \
    X(db2_join, check_db2_join)                                                                                        \
    X(subtract_row, check_subtract_row)                                                                                \
    X(haar_update, check_haar_update)                                                                                  \
    X(cdf53_predict, check_cdf53_predict)                                                                              \
    X(cdf53_update, check_cdf53_update)                                                                                \
    X(texture_finest, check_texture_finest)                                                                            \
    X(texture_coarse, check_texture_coarse)                                                                            \
    X(texture_add, check_texture_add)                                                                                  \
    X(texture_spread, check_texture_spread)                                                                            \
    X(sample_potential, check_sample_potential)                                                                        \
    X(sample_approach, check_sample_approach)                                                                          \
    X(nearest_begin, check_nearest)                                                                                    \
    X(nearest, check_nearest)                                                                                          \
    X(blur_row, check_blur_row)                                                                                        \
    X(blur_column, check_blur_column)                                                                                  \
    X(wanted_row, check_wanted_row)                                                                                    \
    X(key_row, check_key_row)                                                                                          \
    X(convolve, check_convolve)                                                                                        \
    X(depthwise, check_depthwise)                                                                                      \
    X(pack_layer, check_convolve_packed)                                                                               \
    X(convolve_packed, check_convolve_packed)                                                                          \
    X(project, check_project)                                                                                          \
    X(radix_count, check_radix_count)                                                                                  \
    X(radix_pass, check_radix_pass)                                                                                    \
    X(place, check_place)                                                                                              \
    X(blend, check_blend)                                                                                              \
    X(blend_keep, check_blend_keep)                                                                                    \
    X(scatter, check_scatter)                                                                                          \
    X(solve, check_solve)                                                                                              \
    X(hash_bytes, check_hash_bytes)

typedef void any_function(void);

static const struct {
    const char *name;
    size_t offset;
    kernel_check *check;
} entries[] = {
#define ROW(entry, function) {#entry, offsetof(t3r_kernels, entry), function},
    ENTRIES(ROW)};
enum { ENTRIES_COUNT = sizeof entries / sizeof entries[0], ROUNDS = 400 };

_Static_assert(offsetof(t3r_kernels, strip_bytes) == ENTRIES_COUNT * sizeof(any_function *), "no entry is left out");

static any_function *entry_of(const t3r_kernels *kernels, size_t offset)
{
    any_function *function;
    memcpy(&function, (const uint8_t *)kernels + offset, sizeof function);
    return function;
}

static uint64_t first_seed = 1, rounds = ROUNDS;

typedef struct trial {
    const t3r_kernels *kernels;
    kernel_check *check;
    uint64_t seed;
} trial;

static const char *run_trial(void *context)
{
    const trial *t = context;
    uint64_t seed = t->seed;
    guarded_begin(seed);
    const char *found = t->check(t->kernels, &seed);
    return found != NULL ? found : guarded_broken();
}

/* What is wrong with the entry, and the seed; NULL: nothing in all rounds. */
static const char *judge(const t3r_kernels *kernels, size_t entry, uint64_t *seed)
{
    for (*seed = first_seed; *seed - first_seed < rounds; ++*seed) {
        trial t = {kernels, entries[entry].check, *seed};
        const char *found = guarded_run(run_trial, &t);
        if (found != NULL) {
            return found;
        }
    }
    return NULL;
}

static bool is_fine(const t3r_kernels *kernels, size_t entry, const char *what)
{
    uint64_t seed;
    const char *found = judge(kernels, entry, &seed);
    if (found != NULL) {
        print_error("%s, %s: %s (seed %llu)\n", entries[entry].name, what, found, (unsigned long long)seed);
    }
    return found == NULL;
}

static void plain_c(void **state)
{
    (void)state;
    bool fine = true;
    for (size_t i = 0; i < ENTRIES_COUNT; i++) {
        fine &= is_fine(&t3r_kernels_c, i, "plain C");
    }
    assert_true(fine);
}

/* The table with each feature more: what that changed. */
static void variants(void **state)
{
    (void)state;
    t3r_kernels before = t3r_kernels_c, now;
    const uint32_t all = t3r_cpu_features();
    bool fine = true;
    uint32_t tested = 0, allowed = 0;
    for (uint32_t bit = 0; bit < 32; bit++) {
        if ((all >> bit & 1) == 0) {
            continue;
        }
        char name[32];
        allowed |= 1u << bit;
        t3r_cpu_describe(1u << bit, name, sizeof name);
        t3r_kernels_choose(&now, allowed);
        for (size_t i = 0; i < ENTRIES_COUNT; i++) {
            if (entry_of(&now, entries[i].offset) != entry_of(&before, entries[i].offset)) {
                fine &= is_fine(&now, i, name);
                tested++;
            }
        }
        before = now;
    }
    print_message("%u variants\n", tested);
    assert_true(fine);
}

/* Every row of the variants' lists is what its feature chooses, and nothing is chosen without features. */
static void masks_choose(void **state)
{
    (void)state;
    t3r_kernels none, one;
    t3r_kernels_choose(&none, 0);
    assert_memory_equal(&none, &t3r_kernels_c, sizeof none);
#define CHOSEN(entry, features, function)                                                                              \
    t3r_kernels_choose(&one, features);                                                                                \
    assert_true(one.entry == (function));                                                                              \
    assert_true(t3r_kernels_c.entry != (function));                                                                    \
    assert_true((one.pack_layer == NULL) == (one.convolve_packed == NULL));                                            \
    assert_true((one.nearest == t3r_nearest_c) == (one.nearest_begin == t3r_nearest_begin_c));
    T3R_VARIANTS(CHOSEN)
    (void)one;
}

/* --- variants that are wrong -------------------------------------------------------------------------------------- */

static void rounds_down(const uint16_t *const rows[T3R_BLUR_TAPS], uint32_t width, uint16_t *restrict out)
{
    t3r_blur_column_c(rows, width, out);
    if (width % 16 == 15 && out[width - 1] > 0) {
        out[width - 1]--;
    }
}

static void writes_whole_vectors(int16_t *restrict high, const int16_t *restrict low, size_t count)
{
    t3r_subtract_row_c(high, low, count);
    if (count % 8 == 7) {
        high[count] = 0;
    }
}

static void reads_whole_vectors(uint16_t *restrict fine, const uint16_t *restrict coarse, size_t count)
{
    volatile uint16_t unused = coarse[(count + 1) / 2];
    (void)unused;
    t3r_texture_spread_c(fine, coarse, count);
}

static void bends_the_opacity(t3r_tile *tile, const t3r_tile_splat *splat)
{
    t3r_tile_splat bent = *splat;
    bent.opacity_q16 = splat->opacity_q16 == 65534 ? 65535 : splat->opacity_q16;
    t3r_blend_c(tile, &bent);
}

static void takes_the_last(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                           const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest)
{
    t3r_nearest_c(centres, neighbours, points, feature_q11, guess, nearest);
    for (uint32_t i = 0; i < points; i++) { /* of equally near ones */
        for (uint32_t k = nearest[i] + 1u; k < centres->count; k++) {
            bool same = centres->half_norm[k] == centres->half_norm[nearest[i]];
            for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
                same = same && centres->feature_q11[d][k] == centres->feature_q11[d][nearest[i]];
            }
            nearest[i] = same ? (uint16_t)k : nearest[i];
        }
    }
}

static void saturates(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch)
{
    t3r_convolve_c(layer, block, out, out_pitch);
    if (layer->output_bits == 8 && *(int8_t *)out == INT8_MIN) {
        *(int8_t *)out = -127;
    }
}

static void wrong_ones_are_found(void **state)
{
    (void)state;
    t3r_kernels wrong[6];
    static const char *const entry[6] = {"blur_column", "subtract_row", "texture_spread", "blend", "nearest", "convolve"};
    for (int i = 0; i < 6; i++) {
        wrong[i] = t3r_kernels_c;
    }
    wrong[0].blur_column = rounds_down;
    wrong[1].subtract_row = writes_whole_vectors;
    wrong[2].texture_spread = reads_whole_vectors;
    wrong[3].blend = bends_the_opacity;
    wrong[4].nearest = takes_the_last;
    wrong[5].convolve = saturates;
    for (int i = 0; i < 6; i++) {
        for (size_t k = 0; k < ENTRIES_COUNT; k++) {
            uint64_t seed;
            if (strcmp(entries[k].name, entry[i]) == 0) {
                const char *found = judge(&wrong[i], k, &seed);
                assert_non_null(found);
                print_message("%s: %s (seed %llu)\n", entry[i], found, (unsigned long long)seed);
            }
        }
    }
}

/* One entry with one seed, by all that the processor has, where a debugger can look on. */
static int run_one(const char *name, const char *seed)
{
    t3r_kernels kernels;
    t3r_kernels_choose(&kernels, t3r_cpu_features());
    for (size_t i = 0; i < ENTRIES_COUNT; i++) {
        if (strcmp(entries[i].name, name) == 0) {
            trial t = {&kernels, entries[i].check, strtoull(seed, NULL, 10)};
            const char *found = run_trial(&t);
            printf("%s, seed %s: %s\n", name, seed, found == NULL ? "fine" : found);
            return found != NULL;
        }
    }
    fprintf(stderr, "no entry %s\n", name);
    return 2;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest long_tests[] = {cmocka_unit_test(plain_c), cmocka_unit_test(variants)};
    if (argc == 4 && strcmp(argv[1], "--rounds") == 0) {
        rounds = strtoull(argv[2], NULL, 10);
        first_seed = strtoull(argv[3], NULL, 10);
        return cmocka_run_group_tests_name("kernels, many rounds", long_tests, NULL, NULL);
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(plain_c), cmocka_unit_test(variants),
                                       cmocka_unit_test(masks_choose), cmocka_unit_test(wrong_ones_are_found)};
    return argc == 3 ? run_one(argv[1], argv[2]) : cmocka_run_group_tests_name("kernels", tests, NULL, NULL);
}
