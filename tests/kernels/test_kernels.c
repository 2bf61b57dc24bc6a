/* Every entry of the table of kernels, in plain C and in each variant that this processor has: random and largest
 * values, odd lengths, buffers that lie anywhere beside forbidden pages. A variant that fails is named with its input's
 * seed; `test_kernels ENTRY SEED` runs that one again. `test_kernels --rounds N FIRST` tries N seeds from FIRST on of
 * each, for as long as one likes. */
#include "checks.h"
#include "cpu.h"
#include "guarded.h"
#include "kernels/variants.h"

enum { ROUNDS = 400 };

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
static const char *judge(const t3r_kernels *kernels, const checked_entry *entry, uint64_t *seed)
{
    for (*seed = first_seed; *seed - first_seed < rounds; ++*seed) {
        trial t = {kernels, entry->check, *seed};
        const char *found = guarded_run(run_trial, &t);
        if (found != NULL) {
            return found;
        }
    }
    return NULL;
}

static bool is_fine(const t3r_kernels *kernels, const checked_entry *entry, const char *what)
{
    uint64_t seed;
    const char *found = judge(kernels, entry, &seed);
    if (found != NULL) {
        print_error("%s, %s: %s (seed %llu)\n", entry->name, what, found, (unsigned long long)seed);
    }
    return found == NULL;
}

static void plain_c(void **state)
{
    (void)state;
    bool fine = true;
    for (size_t i = 0; i < checked_entries_count; i++) {
        fine &= is_fine(&t3r_kernels_c, &checked_entries[i], "plain C");
    }
    assert_true(fine);
}

/* Every variant whose features the processor has, by just these features. */
static void variants(void **state)
{
    (void)state;
    const uint32_t has = t3r_cpu_features();
    bool fine = true;
    uint32_t tested = 0;
    for (const checked_variant *v = checked_variants; v->entry != NULL; v++) {
        if ((v->features & ~has) == 0) {
            char name[64];
            t3r_kernels kernels;
            t3r_cpu_describe(v->features, name, sizeof name);
            t3r_kernels_choose(&kernels, v->features);
            fine &= is_fine(&kernels, checked_entry_named(v->entry), name);
            tested++;
        }
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
    static const char *const entry[6] = {"blur_column", "subtract_row", "texture_spread",
                                         "blend",       "nearest",      "convolve"};
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
        uint64_t seed;
        const char *found = judge(&wrong[i], checked_entry_named(entry[i]), &seed);
        assert_non_null(found);
        print_message("%s: %s (seed %llu)\n", entry[i], found, (unsigned long long)seed);
    }
}

/* One entry with one seed, by all that the processor has, where a debugger can look on. */
static int run_one(const char *name, const char *seed)
{
    t3r_kernels kernels;
    t3r_kernels_choose(&kernels, t3r_cpu_features());
    const checked_entry *entry = checked_entry_named(name);
    if (entry == NULL) {
        fprintf(stderr, "no entry %s\n", name);
        return 2;
    }
    trial t = {&kernels, entry->check, strtoull(seed, NULL, 10)};
    const char *found = run_trial(&t);
    printf("%s, seed %s: %s\n", name, seed, found == NULL ? "fine" : found);
    return found != NULL;
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
