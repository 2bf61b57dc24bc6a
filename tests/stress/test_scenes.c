/* SPDX-License-Identifier: Apache-2.0 */
/* The synthetic scenes: the target shows the same as the two context views, except where something is in front of it.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/stress/scene.h"
#include "test.h"

enum { WIDTH = 72, HEIGHT = 60 };

/* Returns the share of view v's pixels whose point falls in the target on a pixel of about its depth; and the mean
 * difference of colour there. Cameras look along z and differ only in x. */
static double agreement(const stress_capture *c, int v, double *difference)
{
    const t3r_recorded_camera *camera = &c->view[v].camera, *target = &c->view[2].camera;
    size_t landed = 0, agreed = 0;
    double sum = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        double z = c->view[v].depth[i] * 0.001;
        double x = ((double)(i % WIDTH) - camera->cx) / camera->fx * z + camera->position[0] - target->position[0];
        double column = floor(x / z * target->fx + target->cx + 0.5);
        if (column < 0 || column >= WIDTH) {
            continue;
        }
        size_t at = i / WIDTH * WIDTH + (size_t)column;
        landed++;
        if (fabs(c->view[2].depth[at] * 0.001 - z) < 0.05 * z) {
            agreed++;
            for (size_t k = 0; k < 3; k++) {
                sum += abs(c->view[2].rgb[at * 3 + k] - c->view[v].rgb[i * 3 + k]) / 3.0;
            }
        }
    }
    *difference = sum / (double)agreed;
    return (double)agreed / (double)landed;
}

TEST(views_agree)
{
    const stress_scene *scene;
    for (uint32_t i = 0; (scene = stress_scene_at(i)) != NULL; i++) {
        bool mirror = strcmp(scene->name, "scene-mirror") == 0;
        for (uint32_t g = 0; g < STRESS_GRADES; g++) {
            stress_capture c;
            assert_true(stress_scene_draw(&c, scene, scene->strength[g], WIDTH, HEIGHT));
            assert_int_equal(stress_capture_valid(&c), 2 * WIDTH * HEIGHT);
            double difference, share = agreement(&c, 0, &difference);
            if (share < 0.5 || (difference > 45 && !mirror)) {
                fail_msg("%s %g: %.2f of the pixels agree, by %.1f levels", scene->name, scene->strength[g], share,
                         difference);
            }
            stress_capture_free(&c);
        }
    }
}

/* Returns the grey levels' mean step from column to column: finer patterns have more, a blank wall almost none. */
static double roughness(const stress_scene *scene, double strength)
{
    stress_capture c;
    assert_true(stress_scene_draw(&c, scene, strength, WIDTH, HEIGHT));
    double sum = 0;
    for (size_t i = 1; i < (size_t)WIDTH * HEIGHT; i++) {
        sum += i % WIDTH == 0 ? 0 : abs(c.view[2].rgb[i * 3] - c.view[2].rgb[i * 3 - 3]);
    }
    stress_capture_free(&c);
    return sum / (WIDTH * HEIGHT);
}

TEST(patterns_are_as_fine_as_said)
{
    for (uint32_t i = 0; i < 4; i++) {
        const stress_scene *scene = stress_scene_at(i);
        if (strcmp(scene->name, "scene-wall") == 0) {
            assert_true(roughness(scene, scene->strength[2]) < 0.2 * roughness(stress_scene_at(0), 16));
        } else {
            assert_true(roughness(scene, scene->strength[1]) > 1.1 * roughness(scene, scene->strength[0]));
        }
    }
}

/* A bar, nearer than its surroundings, has the width stated. */
TEST(bars_have_their_width)
{
    const stress_scene *scene = stress_scene_at(2);
    assert_string_equal(scene->name, "scene-bars");
    stress_capture c;
    assert_true(stress_scene_draw(&c, scene, 4, WIDTH, HEIGHT));
    size_t before = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        before += c.view[2].depth[i] == 1500;
    }
    assert_true(fabs((double)before / (WIDTH * HEIGHT) - 0.25) < 0.05); /* one in four */
    stress_capture_free(&c);
}
