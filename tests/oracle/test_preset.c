/* SPDX-License-Identifier: Apache-2.0 */
/* Presets for an amount of work. */
#include <string.h>

#include "oracle/float64/drawing.h"
#include "test.h"

TEST(a_preset_chooses_head_and_refinement_alone)
{
    uint32_t before = 0;
    for (t3r_preset preset = 0; preset < T3R_PRESET_COUNT; preset++) {
        const t3r_config given = t3r_default_config(48, 40, 3, 77);
        t3r_config config = given;
        const char *weights = NULL;
        assert_int_equal(t3r_set_preset(preset, &config, &weights), T3R_OK);
        assert_null(t3r_config_error(&config));
        assert_non_null(weights);
        assert_int_equal(config.head, T3R_HEAD_LEARNED);
        assert_true(config.refine > before); /* more work is more passes */
        before = config.refine;
        t3r_config rest = config;
        rest.head = given.head;
        rest.refine = given.refine;
        rest.fit_passes = given.fit_passes;
        rest.structural = given.structural;
        assert_memory_equal(&rest, &given, sizeof given);
        t3r_config again = given;
        assert_int_equal(t3r_set_preset(preset, &again, NULL), T3R_OK);
        assert_memory_equal(&again, &config, sizeof config);
    }
}

TEST(an_unknown_preset_is_refused)
{
    const t3r_config given = t3r_default_config(48, 40, 3, 77);
    t3r_config config = given;
    const char *const unset = "unset", *weights = unset;
    assert_int_equal(t3r_set_preset(T3R_PRESET_COUNT, &config, &weights), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_set_preset(T3R_PRESET_FAST, NULL, &weights), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_set_preset_as(t3r_interface() + 1, T3R_PRESET_FAST, &config, &weights), T3R_ERR_INTERFACE);
    assert_memory_equal(&config, &given, sizeof given);
    assert_ptr_equal(weights, unset);
}
