/* SPDX-License-Identifier: Apache-2.0 */
/* Presets for a size of RAM fit into it, and too little is refused; presets for an amount of work. */
#include <string.h>

#include "oracle/float64/drawing.h"
#include "test.h"

static const uint64_t sizes[] = {128 << 10, 192 << 10, 256 << 10, 512 << 10, 1 << 20, 4 << 20};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

static void settings_fit(uint64_t bytes, uint64_t row)
{
    t3r_config config;
    t3r_ram_info info;
    size_t least, most;
    assert_int_equal(t3r_ram_config(bytes, &config, &info), T3R_OK);
    assert_true(info.ram_bytes == row);
    assert_int_equal(t3r_plan_bytes(&config, &least, &most), T3R_OK);
    assert_true(least <= info.arena_bytes && info.arena_bytes <= most);
    assert_true(info.arena_bytes + info.strip_bytes + info.target_bytes + info.stack_bytes + info.program_bytes <=
                bytes);
    assert_int_equal(info.strip_bytes, (size_t)5 * info.strip_rows * config.width);
    assert_int_equal(info.target_bytes, (size_t)3 * config.render_width * config.render_height);
    assert_int_equal(info.weights != NULL, config.head == T3R_HEAD_LEARNED);
    arena memory = arena_of_bytes(info.arena_bytes);
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, memory.bytes, info.arena_bytes, &config), T3R_OK);
    arena_free(&memory);
    t3r_config again;
    assert_int_equal(t3r_ram_config(bytes, &again, NULL), T3R_OK);
    assert_memory_equal(&config, &again, sizeof config);
}

TEST(every_size_has_settings_that_fit)
{
    for (int i = 0; i < SIZES; i++) {
        settings_fit(sizes[i], sizes[i]);
        settings_fit(sizes[i] + 1, sizes[i]);
        settings_fit(sizes[i] * 5 / 4, sizes[i]);
        if (i + 1 < SIZES) {
            settings_fit(sizes[i + 1] - 1, sizes[i]);
        }
    }
    settings_fit(UINT64_MAX, sizes[SIZES - 1]);
}

TEST(too_little_is_refused)
{
    t3r_config config, before;
    t3r_ram_info info, info_before;
    memset(&config, 0x5a, sizeof config);
    memset(&info, 0x5a, sizeof info);
    memcpy(&before, &config, sizeof config);
    memcpy(&info_before, &info, sizeof info);
    assert_int_equal(t3r_ram_config(0, &config, &info), T3R_ERR_ARENA);
    assert_int_equal(t3r_ram_config(sizes[0] - 1, &config, &info), T3R_ERR_ARENA);
    assert_int_equal(t3r_ram_config(sizes[0], NULL, &info), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_ram_config_as(t3r_interface() + 1, sizes[0], &config, &info), T3R_ERR_INTERFACE);
    assert_memory_equal(&config, &before, sizeof config);
    assert_memory_equal(&info, &info_before, sizeof info);
}

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
