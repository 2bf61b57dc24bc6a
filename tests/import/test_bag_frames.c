/* SPDX-License-Identifier: Apache-2.0 */
/* Poses over time and the tree of frames, against known results. */
#include <math.h>
#include <string.h>

#include "import/bags/transform_tree.h"
#include "import/poses/lens.h"
#include "test.h"

#define MS INT64_C(1000000)

static rigid turned(double angle, double x, double y, double z)
{
    return (rigid){{x, y, z}, {cos(angle / 2), 0, 0, sin(angle / 2)}};
}

static void near(double a, double b)
{
    if (!(fabs(a - b) < 1e-12)) {
        fail_msg("%.17g and %.17g differ", a, b);
    }
}

static void near_rigid(const rigid *a, const rigid *b)
{
    double sign = a->rotation[0] * b->rotation[0] + a->rotation[3] * b->rotation[3] < 0 ? -1 : 1;
    for (int i = 0; i < 3; i++) {
        near(a->position[i], b->position[i]);
    }
    for (int i = 0; i < 4; i++) {
        near(a->rotation[i], sign * b->rotation[i]);
    }
}

TEST(rotations_lie_on_the_shorter_arc)
{
    const rigid from = turned(0.2, 0, 0, 0);
    rigid to = turned(1.4, 2, 4, 6);
    for (int flipped = 0; flipped < 2; flipped++) {
        rigid half = rigid_between(&from, &to, 0.25), expected = turned(0.5, 0.5, 1, 1.5);
        near_rigid(&half, &expected);
        for (int i = 0; i < 4; i++) {
            to.rotation[i] = -to.rotation[i]; /* the same rotation */
        }
    }
    const rigid same = turned(0.2, 1, 0, 0);
    rigid between = rigid_between(&from, &same, 0.5);
    near(between.position[0], 0.5);
    near(between.rotation[3], from.rotation[3]);
}

TEST(inverses_undo)
{
    const rigid a = {{1, -2, 3}, {0.5, 0.5, -0.5, 0.5}};
    rigid back = rigid_inverse(&a), none = rigid_compose(&back, &a);
    near_rigid(&none, &rigid_identity);
    const double point[3] = {0.5, 0.25, -4};
    double there[3], again[3];
    rigid_apply(&a, point, there);
    rigid_apply(&back, there, again);
    for (int i = 0; i < 3; i++) {
        near(again[i], point[i]);
    }
}

TEST(tracks_hold_a_little_at_their_ends)
{
    pose_track track = {0};
    rigid pose = turned(0, 1, 0, 0), out;
    assert_false(pose_track_at(&track, 0, 20 * MS, &out));
    assert_true(pose_track_add(&track, 200 * MS, &pose));
    pose = turned(0, 3, 0, 0);
    assert_true(pose_track_add(&track, 100 * MS, &pose)); /* out of order */
    pose = turned(0, 9, 0, 0);
    assert_true(pose_track_add(&track, 200 * MS + POSE_TRACK_GAP_NS + 1, &pose));
    pose_track_sort(&track);
    static const struct {
        int64_t stamp;
        double x; /* NAN: no pose */
    } cases[] = {{100 * MS, 3},      {150 * MS, 2}, {200 * MS, 1},      {80 * MS, 3},
                 {80 * MS - 1, NAN}, {220 * MS, 1}, {220 * MS + 1, NAN}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        bool there = pose_track_at(&track, cases[i].stamp, 20 * MS, &out);
        assert_int_equal(there, !isnan(cases[i].x));
        if (there) {
            near(out.position[0], cases[i].x);
        }
    }
    track.standing = true; /* the last one, at any time */
    assert_true(pose_track_at(&track, 0, 0, &out));
    near(out.position[0], 9);
    pose_track_free(&track);
}

static uint32_t frame(const transform_tree *tree, const char *name)
{
    return transform_tree_find(tree, t3r_text_of(name));
}

static const char *add(transform_tree *tree, const char *parent, const char *child, bool standing, int64_t stamp_ns,
                       rigid place)
{
    return transform_tree_add(tree, t3r_text_of(parent), t3r_text_of(child), standing, stamp_ns, &place);
}

TEST(trees_compose_up_down_and_across)
{
    transform_tree tree = {0};
    assert_null(add(&tree, "map", "/base", false, 0, turned(0, 0, 0, 0)));
    assert_null(add(&tree, "map", "base", false, 100 * MS, turned(0, 10, 0, 0)));
    assert_null(add(&tree, "base", "left", true, 0, turned(0, 0, 1, 0)));
    assert_null(add(&tree, "base", "right", true, 0, turned(M_PI / 2, 0, -1, 0)));
    assert_null(add(&tree, "lonely", "left", true, 0, turned(0, 5, 5, 5))); /* another parent: refused */
    assert_null(transform_tree_finish(&tree));
    assert_int_equal(tree.refused, 1);
    rigid out, expected = turned(0, 5, 1, 0);
    assert_true(transform_tree_lookup(&tree, frame(&tree, "map"), frame(&tree, "left"), 50 * MS, 0, &out));
    near_rigid(&out, &expected);
    expected = turned(0, -5, -1, 0);
    assert_true(transform_tree_lookup(&tree, frame(&tree, "left"), frame(&tree, "map"), 50 * MS, 0, &out));
    near_rigid(&out, &expected);
    /* across: motion above both does not matter, so any time will do */
    expected = turned(M_PI / 2, 0, -2, 0);
    assert_true(transform_tree_lookup(&tree, frame(&tree, "left"), frame(&tree, "right"), INT64_C(1) << 60, 0, &out));
    near_rigid(&out, &expected);
    assert_false(transform_tree_lookup(&tree, frame(&tree, "map"), frame(&tree, "left"), 101 * MS, 0, &out));
    assert_false(transform_tree_lookup(&tree, frame(&tree, "map"), frame(&tree, "lonely"), 50 * MS, 0, &out));
    assert_int_equal(frame(&tree, "nowhere"), TRANSFORM_NO_FRAME);
    assert_int_equal(transform_tree_root(&tree, frame(&tree, "left")), frame(&tree, "map"));
    assert_true(transform_tree_moves(&tree, frame(&tree, "left")));
    assert_false(transform_tree_moves(&tree, frame(&tree, "lonely")));
    transform_tree_free(&tree);
}

TEST(loops_are_refused)
{
    transform_tree tree = {0};
    assert_null(add(&tree, "a", "b", true, 0, rigid_identity));
    assert_null(add(&tree, "b", "a", true, 0, rigid_identity));
    assert_non_null(strstr(transform_tree_finish(&tree), "above itself"));
    assert_non_null(strstr(add(&tree, "/", "c", true, 0, rigid_identity), "no name"));
    transform_tree_free(&tree);
}

/* A lens projects its ray through a pixel back to that pixel. */
TEST(lenses_go_both_ways)
{
    static const t3r_ros_camera_info none = {.width = 64, .height = 48};
    static const struct {
        const char *model;
        double d[8];
    } lenses[] = {{"plumb_bob", {0}},
                  {"plumb_bob", {-0.3, 0.1, 0.001, -0.002, -0.01}},
                  {"rational_polynomial", {0.4, -0.1, 0.001, 0.001, 0.02, 0.5, -0.05, 0.01}},
                  {"equidistant", {0.05, -0.02, 0.01, -0.002}}};
    for (size_t i = 0; i < sizeof lenses / sizeof lenses[0]; i++) {
        const double k[9] = {40, 0, 31, 0, 42, 24, 0, 0, 1};
        t3r_ros_camera_info info = none;
        lens l;
        info.distortion_model = t3r_text_of(lenses[i].model);
        info.d_count = 8;
        memcpy(info.k_f64, k, sizeof k);
        memcpy(info.d_f64, lenses[i].d, sizeof lenses[i].d);
        assert_null(lens_of_info(&info, &l));
        for (double v = -0.5; v < 48; v += 6) {
            for (double u = -0.5; u < 64; u += 8) {
                double ray[2], pixel[2];
                lens_ray(&l, u, v, ray);
                assert_true(lens_project(&l, (double[]){ray[0] * 3, ray[1] * 3, 3}, pixel));
                assert_true(fabs(pixel[0] - u) < 1e-3 && fabs(pixel[1] - v) < 1e-3);
            }
        }
        double pixel[2];
        assert_false(lens_project(&l, (double[]){0, 0, -1}, pixel));
        assert_false(lens_project(&l, (double[]){9, 0, 1}, pixel)); /* far outside the picture */
    }
}
