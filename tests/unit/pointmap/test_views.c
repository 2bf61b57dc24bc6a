/* SPDX-License-Identifier: Apache-2.0 */
/* The validity plane: its predicates exclude each other, and its numbers outside the runtime are the SPEC's. */
#include "unit/unit.h"

#include "state/views.h"

/* SPEC.md, "Between views" */
TEST(confidences)
{
    static const struct {
        uint8_t validity, confidence;
    } cases[] = {
        {T3R_NO_DEPTH, 0},
        {T3R_MEASURED, 255},
        {T3R_MEASURED | T3R_MARK_COVERED, 192},
        {T3R_FILLED, 128},
        {T3R_FILLED | T3R_MARK_COVERED, 96},
        {T3R_MEASURED | T3R_MARK_DOUBTFUL, 64},
        {T3R_FILLED | T3R_MARK_DOUBTFUL, 32},
        {T3R_BRIDGED, 24},
        {T3R_BRIDGED | T3R_MARK_COVERED, 16},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(t3r_confidence_of(cases[i].validity), cases[i].confidence);
    }
}

/* For any byte, since a copied arena may hold any: one source, and 0 only without one. */
TEST(sources)
{
    for (int byte = 0; byte <= UINT8_MAX; byte++) {
        const uint8_t validity = (uint8_t)byte;
        const int of = t3r_is_filled(validity) + t3r_is_bridged(validity) + t3r_is_measured(validity);
        assert_int_equal(of, t3r_has_depth(validity));
        assert_int_equal(t3r_confidence_of(validity) != 0, t3r_has_depth(validity));
        assert_int_equal(t3r_unmarked(validity), t3r_depth_source_of(validity));
        const uint8_t found = validity & (T3R_DEPTH_SOURCE_BITS | T3R_MARKS); /* for any bits above */
        assert_int_equal(t3r_is_marked(validity), t3r_unmarked(validity) != found);
        assert_int_equal(t3r_is_reliable(validity), found == T3R_MEASURED);
        assert_int_equal(t3r_is_known(validity), found == T3R_MEASURED || found == T3R_FILLED);
    }
}

TEST(marks)
{
    for (t3r_depth_source source = T3R_FILLED; source <= T3R_MEASURED; source++) {
        for (int mark = T3R_MARK_COVERED; mark <= T3R_MARK_LENT; mark *= 2) {
            const uint8_t validity = t3r_marked((uint8_t)source, (enum t3r_mark)mark);
            assert_int_equal(t3r_depth_source_of(validity), source);
            assert_int_equal(t3r_is_covered(validity), mark == T3R_MARK_COVERED);
            assert_int_equal(t3r_is_doubtful(validity), mark == T3R_MARK_DOUBTFUL);
            assert_int_equal(t3r_is_lent(validity), mark == T3R_MARK_LENT);
            assert_int_equal(t3r_unmarked(validity), source);
        }
    }
}

/* Each label reads back with all marks, and changes neither them nor the neighbours; none is left when marks of either
 * kind are removed. */
TEST(labels)
{
    enum { PIXELS = 3 };
    for (uint32_t found = T3R_FILLED; found < T3R_LABEL_HIGH; found++) {
        for (uint32_t label = 0; label < T3R_MAX_CLUSTERS; label++) {
            uint16_t depth[PIXELS] = {1, 1, 1};
            uint8_t low[PIXELS] = {0}, validity[PIXELS] = {(uint8_t)found, (uint8_t)found, (uint8_t)found};
            const t3r_view view = {.width = PIXELS, .height = 1, .depth = depth, .validity = validity, .label = low};
            t3r_set_label(&view, 1, label);
            assert_int_equal(t3r_label_of(&view, 1), label);
            assert_true(t3r_label_of(&view, 0) == 0 && t3r_label_of(&view, 2) == 0);
            assert_int_equal(validity[1] % T3R_LABEL_HIGH, found);
            t3r_reset_covered(&view);
            assert_int_equal(t3r_label_of(&view, 1), label % 256);
            t3r_set_label(&view, 1, label);
            t3r_reset_comparison(&view, 1);
            assert_int_equal(t3r_label_of(&view, 1), label % 256);
        }
    }
}

/* A reset removes all traces of the comparison, marks and bridges; depth of other pixels stays. */
TEST(reset)
{
    enum { PIXELS = 6 };
    uint16_t depth[PIXELS] = {1, 2, 3, 4, 5, 0};
    uint8_t validity[PIXELS] = {T3R_MEASURED | T3R_MARK_DOUBTFUL, T3R_FILLED | T3R_MARK_COVERED,   T3R_BRIDGED,
                                T3R_BRIDGED | T3R_MARK_LENT,      T3R_MEASURED | T3R_MARK_WITNESS, T3R_NO_DEPTH};
    const uint16_t expected_depth[PIXELS] = {1, 2, 0, 0, 5, 0};
    const uint8_t expected[PIXELS] = {T3R_MEASURED, T3R_FILLED, T3R_NO_DEPTH, T3R_NO_DEPTH, T3R_MEASURED, T3R_NO_DEPTH};
    const t3r_view view = {.width = PIXELS, .height = 1, .depth = depth, .validity = validity};
    t3r_reset_comparison(&view, 1);
    assert_memory_equal(depth, expected_depth, sizeof depth);
    assert_memory_equal(validity, expected, sizeof validity);
}
