/* SPDX-License-Identifier: Apache-2.0 */
/* The shipped heads: valid, of their class, and small enough for the default arena. */
#include <string.h>

#include "head/weights.h"
#include "test.h"
#include "trim3r_heads.h"
#include "weight_info.h"

static const struct {
    const char *name;
    const uint8_t *weights;
    const uint32_t *bytes;
    uint32_t most_macs, most_bytes;
} heads[] = {
    {"tiny", t3r_head_tiny, &t3r_head_tiny_bytes, 400, 4 << 10},
    {"small", t3r_head_small, &t3r_head_small_bytes, 5000, 48 << 10},
};
enum { HEADS = sizeof heads / sizeof heads[0] };

TEST(of_their_class)
{
    for (int i = 0; i < HEADS; i++) {
        weight_info info;
        char error[256] = "";
        assert_null(t3r_weights_error(heads[i].weights, *heads[i].bytes));
        if (weight_info_read(&info, heads[i].weights, *heads[i].bytes, error, sizeof error) != 0) {
            fail_msg("%s: %s", heads[i].name, error);
        }
        assert_string_equal(info.graph.name, heads[i].name);
        assert_int_equal(info.weight_bits, 8);
        assert_int_equal(info.activation_bits, 8);
        assert_true(info.macs_q8 <= heads[i].most_macs << 8);
        assert_true(*heads[i].bytes <= heads[i].most_bytes);
        assert_true(i == 0 || *heads[i].bytes > *heads[i - 1].bytes);
    }
}

TEST(fit_the_default)
{
    for (int i = 0; i < HEADS; i++) {
        for (uint32_t width = T3R_MIN_SIDE; width <= T3R_MAX_SIDE; width++) {
            uint32_t need = t3r_head_column_bytes(heads[i].weights, *heads[i].bytes, width);
            if (need == 0 || need > T3R_HEAD_COLUMN_BYTES) {
                fail_msg("%s needs %u bytes a column at a width of %u", heads[i].name, need, width);
            }
        }
    }
}
