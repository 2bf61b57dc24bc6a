/* SPDX-License-Identifier: Apache-2.0 */
/* Each perturbation's guarantee, on frames that show it; at strength 0 none changes anything. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/stress/perturbation.h"
#include "study/stress/random.h"
#include "test.h"

enum { WIDTH = 48, HEIGHT = 40, PIXELS = WIDTH * HEIGHT };

/* Makes two context views and the target: mid-range noise, depths of about two metres, 5 % missing. */
static stress_capture sample(void)
{
    stress_capture c;
    assert_true(stress_capture_open(&c, WIDTH, HEIGHT, 2, 0.001));
    for (uint32_t v = 0; v < 3; v++) {
        for (uint32_t i = 0; i < PIXELS * 3; i++) {
            c.view[v].rgb[i] = (uint8_t)(64 + stress_random(v, i) % 128);
        }
        for (uint32_t i = 0; i < PIXELS; i++) {
            c.view[v].depth[i] = (uint16_t)(stress_random(9, i) % 20 == 0 ? 0 : 1800 + stress_random(v + 3, i) % 400);
        }
        c.view[v].camera = (t3r_recorded_camera){.width = WIDTH,
                                                 .height = HEIGHT,
                                                 .fx = 40,
                                                 .fy = 42,
                                                 .cx = (WIDTH - 1) / 2.0,
                                                 .cy = (HEIGHT - 1) / 2.0,
                                                 .position = {0.1 * v, 0.2, -0.3},
                                                 .rotation = {0.6, 0, 0.8, 0}};
    }
    return c;
}

static bool same_view(const stress_view *a, const stress_view *b)
{
    return memcmp(a->rgb, b->rgb, PIXELS * 3) == 0 && memcmp(a->depth, b->depth, PIXELS * 2) == 0 &&
           memcmp(&a->camera, &b->camera, sizeof a->camera) == 0;
}

/* The sample before and after. */
typedef struct pair {
    stress_capture before, after;
} pair;

static pair perturbed(bool (*apply)(stress_capture *, double, uint32_t), double strength)
{
    pair p = {.before = sample(), .after = sample()};
    assert_true(apply(&p.after, strength, 5));
    return p;
}

static void release(pair *p)
{
    stress_capture_free(&p->before);
    stress_capture_free(&p->after);
}

static size_t depth_count(const stress_view *view)
{
    size_t count = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        count += view->depth[i] != 0;
    }
    return count;
}

/* ---- all of them ------------------------------------------------------------------------------------------------- */

TEST(strength_zero_is_identity)
{
    const perturbation *p;
    for (uint32_t i = 0; (p = stress_perturbation(i)) != NULL; i++) {
        pair it = perturbed(p->apply, 0);
        for (int v = 0; v < 3; v++) {
            if (!same_view(&it.before.view[v], &it.after.view[v])) {
                fail_msg("%s of strength 0 changes view %d", p->name, v);
            }
        }
        release(&it);
    }
}

static double distance(const stress_capture *a, const stress_capture *b)
{
    double sum = 0;
    for (int v = 0; v < 2; v++) {
        for (size_t i = 0; i < PIXELS * 3; i++) {
            sum += abs(a->view[v].rgb[i] - b->view[v].rgb[i]);
        }
        for (size_t i = 0; i < PIXELS; i++) {
            sum += abs(a->view[v].depth[i] - b->view[v].depth[i]);
        }
        for (int i = 0; i < 3; i++) {
            sum += fabs(a->view[v].camera.position[i] - b->view[v].camera.position[i]) * 1e6;
        }
        sum += fabs(a->view[v].camera.fx - b->view[v].camera.fx) * 1e6;
    }
    return sum;
}

/* Context views change, more with each grade (except kinds); the target does not, except that "huge" moves it too. */
TEST(grades_rise_and_targets_stay)
{
    const perturbation *p;
    for (uint32_t i = 0; (p = stress_perturbation(i)) != NULL; i++) {
        double last = 0;
        for (uint32_t g = 0; g < STRESS_GRADES; g++) {
            pair it = perturbed(p->apply, p->strength[g]), again = perturbed(p->apply, p->strength[g]);
            double change = distance(&it.before, &it.after);
            if (change <= (strcmp(p->unit, "kind") == 0 ? 0 : last)) {
                fail_msg("%s: grade %u changes no more than the one before", p->name, g + 1);
            }
            last = change;
            assert_true(distance(&it.after, &again.after) <= 0); /* the same seed, the same change */
            if (strcmp(p->name, "huge") == 0) {
                for (int k = 0; k < 3; k++) {
                    assert_true(fabs(it.after.view[2].camera.position[k] - it.before.view[2].camera.position[k] -
                                     pow(10, p->strength[g])) < 1e-6);
                }
                it.after.view[2].camera = it.before.view[2].camera;
            }
            assert_true(same_view(&it.before.view[2], &it.after.view[2]));
            release(&it);
            release(&again);
        }
    }
}

/* ---- colour ------------------------------------------------------------------------------------------------------ */

TEST(noise_has_its_deviation)
{
    pair it = perturbed(perturb_noise, 12);
    double sum = 0, squares = 0;
    for (size_t i = 0; i < PIXELS * 3; i++) {
        double d = it.after.view[1].rgb[i] - it.before.view[1].rgb[i];
        sum += d;
        squares += d * d;
    }
    assert_true(fabs(sum / (PIXELS * 3)) < 0.5);
    assert_true(fabs(sqrt(squares / (PIXELS * 3)) - 12) < 0.5);
    assert_memory_equal(it.before.view[0].depth, it.after.view[0].depth, PIXELS * 2);
    release(&it);
}

/* A point's light is spread like a Gaussian, and none is lost. */
TEST(blur_spreads_a_point)
{
    stress_capture c;
    assert_true(stress_capture_open(&c, WIDTH, HEIGHT, 1, 0.001));
    uint32_t x = 20, y = 18;
    for (uint32_t k = 0; k < 3; k++) {
        c.view[0].rgb[(y * WIDTH + x) * 3 + k] = 255;
    }
    assert_true(perturb_blur(&c, 1, 0));
    double total = 0;
    for (uint32_t row = 0; row < HEIGHT; row++) {
        for (uint32_t column = 0; column < WIDTH; column++) {
            uint8_t got = c.view[0].rgb[(row * WIDTH + column) * 3 + 1];
            double dx = (double)column - x, dy = (double)row - y;
            double expected = 255 / (2 * 3.14159265) * exp(-(dx * dx + dy * dy) / 2);
            assert_true(fabs(got - expected) < 1.5);
            total += got;
        }
    }
    assert_true(fabs(total - 255) < 10);
    stress_capture_free(&c);
}

TEST(gains_part_the_views)
{
    pair it = perturbed(perturb_exposure, 1);
    pair white = perturbed(perturb_white, 1);
    double up = exp2(0.5 / 2.2);
    for (size_t i = 0; i < PIXELS * 3; i++) {
        double even = it.before.view[0].rgb[i] * up, odd = it.before.view[1].rgb[i] / up;
        assert_true(fabs(it.after.view[0].rgb[i] - fmin(even, 255)) <= 0.5);
        assert_true(fabs(it.after.view[1].rgb[i] - odd) <= 0.5);
        double gain = i % 3 == 0 ? up : i % 3 == 1 ? 1 : 1 / up;
        assert_true(fabs(white.after.view[0].rgb[i] - fmin(white.before.view[0].rgb[i] * gain, 255)) <= 0.5);
    }
    release(&it);
    release(&white);
}

/* ---- depth ------------------------------------------------------------------------------------------------------- */

TEST(depth_noise_is_relative)
{
    pair it = perturbed(perturb_depth_noise, 2);
    double squares = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double was = it.before.view[0].depth[i], is = it.after.view[0].depth[i];
        assert_true((was > 0) == (is > 0));
        squares += was > 0 ? (is / was - 1) * (is / was - 1) : 0;
    }
    assert_true(fabs(sqrt(squares / (double)depth_count(&it.before.view[0])) - 0.02) < 0.001);
    assert_memory_equal(it.before.view[0].rgb, it.after.view[0].rgb, PIXELS * 3);
    release(&it);
    /* measured pixels stay measured */
    stress_capture c = sample();
    for (size_t i = 0; i < PIXELS; i++) {
        c.view[0].depth[i] = 1;
        c.view[1].depth[i] = 65535;
    }
    assert_true(perturb_depth_noise(&c, 50, 1));
    assert_true(depth_count(&c.view[0]) == PIXELS && depth_count(&c.view[1]) == PIXELS);
    stress_capture_free(&c);
}

TEST(lattice_keeps_its_points)
{
    pair it = perturbed(perturb_lattice, 3);
    for (size_t i = 0; i < PIXELS; i++) {
        bool stays = i % WIDTH % 3 == 0 && i / WIDTH % 3 == 0;
        assert_int_equal(it.after.view[1].depth[i], stays ? it.before.view[1].depth[i] : 0);
    }
    release(&it);
}

/* At least the requested share, and at most one disc more; all else is unchanged. */
TEST(blobs_take_their_share)
{
    pair it = perturbed(perturb_blobs, 30);
    for (int v = 0; v < 2; v++) {
        double before = (double)depth_count(&it.before.view[v]), after = (double)depth_count(&it.after.view[v]);
        double disc = 3.15 * (HEIGHT / 8.0 + 1) * (HEIGHT / 8.0 + 1);
        assert_true(after <= before * 0.7 && after >= before * 0.7 - disc);
        for (size_t i = 0; i < PIXELS; i++) {
            assert_true(it.after.view[v].depth[i] == 0 || it.after.view[v].depth[i] == it.before.view[v].depth[i]);
        }
    }
    release(&it);
    it = perturbed(perturb_blobs, 100);
    assert_int_equal(stress_capture_valid(&it.after), 0);
    release(&it);
}

TEST(shares_of_pixels)
{
    pair it = perturbed(perturb_dropouts, 60);
    double left = (double)stress_capture_valid(&it.after) / stress_capture_valid(&it.before);
    assert_true(fabs(left - 0.4) < 0.04);
    release(&it);
    it = perturbed(perturb_dropouts, 100);
    assert_int_equal(stress_capture_valid(&it.after), 0);
    release(&it);
    pair near = perturbed(perturb_near, 100), far = perturbed(perturb_far, 10);
    size_t count = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        assert_int_equal(near.after.view[1].depth[i], 1);
        count += far.after.view[1].depth[i] == 65535;
    }
    assert_true(count > PIXELS * 8 / 100 && count < PIXELS * 12 / 100);
    release(&near);
    release(&far);
}

TEST(depth_scale_multiplies)
{
    pair it = perturbed(perturb_depth_scale, 5);
    for (size_t i = 0; i < PIXELS; i++) {
        assert_true(fabs(it.after.view[0].depth[i] - it.before.view[0].depth[i] * 1.05) <= 0.5);
    }
    release(&it);
}

/* ---- cameras ----------------------------------------------------------------------------------------------------- */

TEST(pose_turns_and_moves)
{
    pair it = perturbed(perturb_pose, 3);
    for (int v = 0; v < 2; v++) {
        const t3r_recorded_camera *a = &it.before.view[v].camera, *b = &it.after.view[v].camera;
        double way = 0, dot = 0, norm = 0;
        for (int i = 0; i < 3; i++) {
            way += (a->position[i] - b->position[i]) * (a->position[i] - b->position[i]);
        }
        for (int i = 0; i < 4; i++) {
            dot += a->rotation[i] * b->rotation[i];
            norm += b->rotation[i] * b->rotation[i];
        }
        assert_true(fabs(sqrt(way) - 0.03 * 2) < 0.002); /* the median depth is near two metres */
        assert_true(fabs(2 * acos(fabs(dot)) * 57.29578 - 3) < 1e-6);
        assert_true(fabs(norm - 1) < 1e-9);
    }
    assert_true(distance(&it.before, &it.after) > 0 &&
                memcmp(it.before.view[0].rgb, it.after.view[0].rgb, PIXELS * 3) == 0);
    release(&it);
}

TEST(intrinsics_lie)
{
    pair it = perturbed(perturb_intrinsics, 5);
    assert_true(fabs(it.after.view[1].camera.fx - 42) < 1e-9 && fabs(it.after.view[1].camera.fy - 44.1) < 1e-9);
    release(&it);
}

/* Ramps of levels: a yaw moves the contents near the axis by f tan(angle), in opposite directions in the first and
 * last rows; a plane's depth at the axis changes only by the cosine. */
TEST(rolling_shutter_shears)
{
    stress_capture c = sample();
    for (size_t i = 0; i < PIXELS; i++) {
        memset(&c.view[0].rgb[i * 3], (int)(i % WIDTH * 5), 3);
        c.view[0].depth[i] = 2000;
    }
    assert_true(perturb_rolling(&c, 4, 0));
    size_t middle = WIDTH / 2; /* half a pixel from the axis */
    for (size_t y = 0; y < HEIGHT; y++) {
        double angle = 4 / 57.29578 * ((double)y / (HEIGHT - 1) - 0.5);
        double shift = 40 * tan(angle + atan(0.5 / 40)) - 0.5;
        assert_true(fabs(c.view[0].rgb[(y * WIDTH + middle) * 3] - 5 * ((double)middle + shift)) < 0.6);
        assert_true(abs(c.view[0].depth[y * WIDTH + middle] - 2000) <= 2);
    }
    assert_int_equal(c.view[0].depth[0], 0); /* looks out of the recorded picture */
    stress_capture_free(&c);
}

/* ---- frames ------------------------------------------------------------------------------------------------------ */

TEST(rows_of_one_colour)
{
    pair it = perturbed(perturb_white_frame, 25);
    for (size_t i = 0; i < PIXELS * 3; i++) {
        assert_int_equal(it.after.view[1].rgb[i], i < PIXELS * 3 / 4 ? 255 : it.before.view[1].rgb[i]);
    }
    release(&it);
    it = perturbed(perturb_black, 100);
    for (size_t i = 0; i < PIXELS * 3; i++) {
        assert_int_equal(it.after.view[0].rgb[i], 0);
    }
    release(&it);
}

TEST(identical_views)
{
    pair it = perturbed(perturb_identical, 1);
    assert_true(same_view(&it.after.view[1], &it.before.view[0]));
    release(&it);
    it = perturbed(perturb_identical, 2);
    assert_memory_equal(it.after.view[1].depth, it.before.view[0].depth, PIXELS * 2);
    assert_memory_equal(&it.after.view[1].camera, &it.before.view[1].camera, sizeof it.after.view[1].camera);
    release(&it);
    it = perturbed(perturb_identical, 3);
    assert_memory_equal(it.after.view[1].rgb, it.before.view[0].rgb, PIXELS * 3);
    assert_memory_equal(it.after.view[1].depth, it.before.view[1].depth, PIXELS * 2);
    release(&it);
}

TEST(mirrored_twice_is_itself)
{
    for (double kind = 1; kind <= 3; kind++) {
        pair it = perturbed(perturb_mirrored, kind);
        assert_int_equal(it.after.view[1].rgb[3], it.before.view[1].rgb[(WIDTH - 2) * 3]);
        assert_int_equal(it.after.view[1].depth[1], it.before.view[1].depth[kind >= 2 ? WIDTH - 2 : 1]);
        assert_true(same_view(&it.after.view[0], &it.before.view[0]) == (kind < 3));
        assert_true(perturb_mirrored(&it.after, kind, 0));
        assert_true(same_view(&it.after.view[0], &it.before.view[0]) &&
                    same_view(&it.after.view[1], &it.before.view[1]));
        release(&it);
    }
}

/* ---- recorded again ---------------------------------------------------------------------------------------------- */

TEST(a_recording_of_it_is_the_same)
{
    stress_capture c = sample(), back;
    uint8_t *bytes;
    t3r_recording *recording = stress_capture_recording(&c, &bytes);
    assert_non_null(recording);
    evaluation_case what = {.recording = recording, .path = "x", .context = {0, 1}, .context_count = 2, .target = 2};
    reconstruction_options settings;
    reconstruction_defaults(&settings);
    assert_int_equal(stress_capture_read(&back, &what, &settings), 0);
    assert_int_equal(back.views, 2);
    for (int v = 0; v < 3; v++) {
        assert_memory_equal(back.view[v].rgb, c.view[v].rgb, PIXELS * 3);
        assert_memory_equal(back.view[v].depth, c.view[v].depth, PIXELS * 2);
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(back.view[v].camera.position[i] - c.view[v].camera.position[i]) <= 0x1p-32);
        }
    }
    assert_true(fabs(back.depth_unit - 0.001) < 1e-12);
    t3r_recording_close(recording);
    free(bytes);
    stress_capture_free(&back);
    stress_capture_free(&c);
}
