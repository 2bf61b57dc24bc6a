/* SPDX-License-Identifier: Apache-2.0 */
/* The quality of a scene: poor when more than a quarter of the chosen pictures is poor, good when none is and the
 * medians are good. */
#include "test.h"

#include "trim3r/scene/scene_quality.h"

static scene_quality of(const double *chosen, uint32_t chosen_count, const double *others, uint32_t other_count)
{
    drawn_picture pictures[DRAWN_MOST] = {0};
    for (uint32_t i = 0; i < chosen_count + other_count; i++) {
        const bool used = i < chosen_count;
        pictures[i] = (drawn_picture){.frame = i, .used = used, .psnr = used ? chosen[i] : others[i - chosen_count]};
    }
    return scene_quality_of(pictures, chosen_count + other_count);
}

TEST(poor_pictures_make_a_poor_scene)
{
    const double psnr[] = {17.9, 30, 30, 30, 17.9};
    assert_int_equal(of(psnr, 1, NULL, 0), SCENE_POOR);
    assert_int_equal(of(psnr, 3, NULL, 0), SCENE_POOR);
    assert_int_equal(of(psnr, 4, NULL, 0), SCENE_FAIR); /* a quarter */
    assert_int_equal(of(psnr, 5, NULL, 0), SCENE_POOR);
    assert_string_equal(scene_quality_name(SCENE_POOR), "poor");
}

TEST(half_of_the_pictures_are_good)
{
    const double psnr[] = {24.9, 25, 26};
    assert_int_equal(of(psnr, 3, NULL, 0), SCENE_GOOD);
    assert_int_equal(of(psnr, 2, NULL, 0), SCENE_FAIR); /* the lower one of two counts */
    assert_int_equal(of(psnr + 1, 1, NULL, 0), SCENE_GOOD);
    assert_string_equal(scene_quality_name(SCENE_GOOD), "good");
    assert_string_equal(scene_quality_name(SCENE_FAIR), "fair");
}

/* Pictures that were not chosen show what a new view would be like. */
TEST(others_count_too)
{
    const double chosen[] = {30, 30}, others[] = {17, 17, 24};
    assert_int_equal(of(chosen, 2, others, 3), SCENE_FAIR);
    assert_int_equal(of(chosen, 2, others + 1, 2), SCENE_FAIR);
    assert_int_equal(of(chosen, 2, others + 2, 1), SCENE_GOOD);
}

ALL_TESTS_WITH(NULL, NULL)
