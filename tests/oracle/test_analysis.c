/* SPDX-License-Identifier: Apache-2.0 */
/* The analysis stages against their float64 counterparts: back-projection and tangents, K-means, wavelet energy. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/float64/drawing.h"
#include "oracle/float64/oracle_analysis.h"
#include "pointmap/pointmap.h"
#include "superclusters/superclusters.h"
#include "test.h"
#include "wavelet_planes.h"

/* ---- pointmap ------------------------------------------------------------------------------------ */

enum { W = 40, H = 30 };

static void pointmap_case(const t3r_camera *camera, const t3r_scene_frame *frame, uint64_t unit_q40, int base, int du,
                          int dv)
{
    static uint16_t depth[W * H];
    static uint8_t validity[W * H];
    for (int i = 0; i < W * H; i++) {
        depth[i] = (uint16_t)(base + du * (i % W) + dv * (i / W));
        validity[i] = T3R_MEASURED;
    }
    t3r_view view = {
        .width = W,
        .height = H,
        .depth = depth,
        .validity = validity,
        .fx_q16 = camera->fx_q16,
        .fy_q16 = camera->fy_q16,
        .cx_q16 = camera->cx_q16,
        .cy_q16 = camera->cy_q16,
        .depth_unit_q40 = unit_q40,
    };
    assert_int_equal(t3r_pose_in_scene(camera, frame, &view.pose), T3R_OK);
    t3r_pointmap map = t3r_pointmap_of(&view, frame->exponent);
    oracle_camera exact = oracle_camera_from_t3r(camera, frame, W, H);
    double unit = ldexp((double)unit_q40, -40 - frame->exponent);
    for (uint32_t v = 0; v < H; v++) {
        for (uint32_t u = 0; u < W; u++) {
            double z = depth[v * W + u] * unit, want[3];
            oracle_unproject(&exact, u, v, z, want);
            int32_t point[3], tangent[2][3];
            assert_true(t3r_point(&map, u, v, point));
            assert_true(t3r_tangents(&map, u, v, tangent[0], tangent[1]));
            for (int i = 0; i < 3; i++) {
                /* one step each for depth, position and sum; rays and rotation are accurate to 2^-23 */
                double error = fabs(ldexp(point[i], -20) - want[i]);
                if (error > ldexp(3, -20) + ldexp(z, -22)) {
                    fail_msg("pixel %u %u axis %d: off by %g of 2^-20", u, v, i, ldexp(error, 20));
                }
            }
            /* the surface is a plane in (u, v, z): the derivative is exact from both sides */
            const double slope[2] = {du * unit, dv * unit};
            for (int t = 0; t < 2; t++) {
                double ahead[3];
                oracle_unproject(&exact, u + (t == 0), v + (t == 1), z, ahead);
                double along[3];
                oracle_unproject(&exact, u, v, z + slope[t], along);
                for (int i = 0; i < 3; i++) {
                    double tangent_want = ahead[i] - want[i] + along[i] - want[i];
                    double error = fabs(ldexp(tangent[t][i], -24) - tangent_want);
                    if (error > ldexp(2, -20) + 1e-5 * z) {
                        fail_msg("pixel %u %u tangent %d axis %d: %g, wanted %g", u, v, t, i, ldexp(tangent[t][i], -24),
                                 tangent_want);
                    }
                }
            }
        }
    }
    depth[5 * W + 7] = 0;
    validity[5 * W + 7] = T3R_NO_DEPTH;
    int32_t point[3], tangent[2][3];
    assert_false(t3r_point(&map, 7, 5, point));
    assert_false(t3r_tangents(&map, 7, 5, tangent[0], tangent[1]));
}

TEST(pointmap)
{
    const uint64_t millimetre = 1099511628;
    t3r_scene_frame frame = {{0}, 0};
    t3r_camera camera = plain_camera(35, W, H);
    pointmap_case(&camera, &frame, millimetre, 1500, 0, 0);
    pointmap_case(&camera, &frame, millimetre, 1500, 4, -3);
    const double position[3] = {0.7, -0.3, 0.4}, at[3] = {-1, 0.2, 2};
    camera = camera_towards(35, W, H, position, at);
    camera.cx_q16 += 3333333 / 8;
    pointmap_case(&camera, &frame, millimetre, 1200, -5, 2);
    /* far from the world's origin, in units of 2^4 */
    frame = (t3r_scene_frame){{(int64_t)700000 << 32, -((int64_t)20 << 32), 5}, 4};
    for (int i = 0; i < 3; i++) {
        camera.position_q32[i] = camera.position_q32[i] * 16 + frame.origin_q32[i];
    }
    pointmap_case(&camera, &frame, millimetre, 20000, 40, 35);
    /* a scene with a depth of a twentieth of a unit */
    frame = (t3r_scene_frame){{0}, -5};
    camera = camera_towards(35, W, H, position, at);
    for (int i = 0; i < 3; i++) {
        camera.position_q32[i] /= 32;
    }
    pointmap_case(&camera, &frame, millimetre / 1000, 50000, 100, -80);
}

/* ---- K-means ------------------------------------------------------------------------------------- */

typedef struct cloud {
    uint32_t count;
    int16_t (*feature_q11)[ORACLE_DIMENSIONS];
    double *points;      /* the oracle's copy of the points */
    uint32_t hole_every; /* every hole_every-th point is invalid; 0: none */
    uint32_t *labels;    /* NO_LABEL until clustering sets them */
} cloud;

#define NO_LABEL UINT32_MAX

static uint32_t cloud_features(const void *context, const uint32_t *index, uint32_t count,
                               int16_t feature_q11[][T3R_DIMENSIONS], uint8_t *which)
{
    const cloud *c = context;
    uint32_t valid = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (c->hole_every == 0 || index[i] % c->hole_every != 0) {
            memcpy(feature_q11[valid], c->feature_q11[index[i]], sizeof feature_q11[valid]);
            which[valid++] = (uint8_t)i;
        }
    }
    return valid;
}

static void cloud_label(const void *context, uint32_t first, const uint8_t *which, uint32_t count,
                        const uint16_t *label)
{
    const cloud *c = context;
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(c->labels[first + which[i]], NO_LABEL);
        c->labels[first + which[i]] = label[i];
    }
}

static t3r_point_source source_of(const cloud *c)
{
    memset(c->labels, 0xff, c->count * sizeof *c->labels);
    return (t3r_point_source){c, c->count, cloud_features, cloud_label};
}

static void free_cloud(cloud *c)
{
    free(c->feature_q11);
    free(c->points);
    free(c->labels);
}

/* `blobs` normal clusters of the given spread, over the cube of +-reach; 0 blobs = uniform */
static cloud cloud_of(uint32_t count, uint32_t blobs, double reach, double spread, uint64_t seed)
{
    cloud c = {count, calloc(count, sizeof *c.feature_q11), calloc(count, ORACLE_DIMENSIONS * sizeof(double)), 0,
               calloc(count, sizeof *c.labels)};
    assert_non_null(c.feature_q11);
    assert_non_null(c.points);
    assert_non_null(c.labels);
    dice d = {seed};
    double centre[64][ORACLE_DIMENSIONS];
    for (uint32_t b = 0; b < blobs; b++) {
        for (int k = 0; k < ORACLE_DIMENSIONS; k++) {
            centre[b][k] = dice_between(&d, -reach, reach);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t b = blobs == 0 ? 0 : dice_below(&d, blobs);
        for (int k = 0; k < ORACLE_DIMENSIONS; k++) {
            double normal = -6;
            for (int n = 0; n < 12; n++) {
                normal += dice_between(&d, 0, 1);
            }
            double x = blobs == 0 ? dice_between(&d, -reach, reach) : centre[b][k] + spread * normal;
            c.feature_q11[i][k] = (int16_t)fmax(-8000, fmin(8000, nearbyint(x * 2048)));
            c.points[i * ORACLE_DIMENSIONS + (uint32_t)k] = c.feature_q11[i][k] / 2048.0;
        }
    }
    return c;
}

static void kmeans_case(const char *name, cloud *c, uint32_t k, double allowed)
{
    const t3r_point_source source = source_of(c);
    const t3r_cluster_settings settings = {&t3r_kernels_c, k, 24, 1, false};
    t3r_cluster *clusters = calloc(k, sizeof *clusters);
    void *work = aligned_alloc(T3R_ARENA_ALIGN, T3R_CLUSTER_WORK_BYTES(k));
    assert_true(clusters != NULL && work != NULL);
    const t3r_cluster_host alone = {.workers = {NULL, 1}};
    uint32_t valid = t3r_superclusters(&source, &settings, clusters, work, &alone);
    const uint32_t *labels = c->labels;
    double *centres = calloc(k, ORACLE_DIMENSIONS * sizeof *centres);
    uint32_t *sizes = calloc(k, sizeof *sizes), *kept_labels = calloc(c->count, sizeof *kept_labels), kept = 0;
    double *kept_points = calloc(c->count, ORACLE_DIMENSIONS * sizeof *kept_points);
    assert_true(centres != NULL && sizes != NULL && kept_labels != NULL && kept_points != NULL);
    for (uint32_t i = 0; i < c->count; i++) {
        if (c->hole_every != 0 && i % c->hole_every == 0) {
            assert_int_equal(labels[i], NO_LABEL);
            continue;
        }
        assert_true(labels[i] < k);
        sizes[labels[i]]++;
        kept_labels[kept] = labels[i];
        memcpy(&kept_points[kept * ORACLE_DIMENSIONS], &c->points[i * ORACLE_DIMENSIONS],
               ORACLE_DIMENSIONS * sizeof(double));
        kept++;
    }
    assert_int_equal(valid, kept);
    for (uint32_t i = 0; i < k; i++) {
        assert_int_equal(clusters[i].points, sizes[i]);
        for (uint32_t j = 0; j < ORACLE_DIMENSIONS; j++) {
            centres[i * ORACLE_DIMENSIONS + j] = ldexp(clusters[i].centre_q19[j], -19);
        }
    }
    double ours = oracle_kmeans_msd(kept_points, kept, centres, kept_labels);
    double nearest = oracle_kmeans_assign(kept_points, kept, centres, k, NULL);
    double converged = oracle_kmeans_lloyd(kept_points, kept, centres, k, 100);
    print_message("%-28s %6u points, K %3u: msd %.6f, nearest %.6f, Lloyd to the end %.6f\n", name, kept, k, ours,
                  nearest, converged);
    /* labels name the nearest centre up to its last bits; one step of Q11 in each dimension is the minimum error */
    assert_true(ours <= nearest * 1.01 + ORACLE_DIMENSIONS * ldexp(1, -22));
    assert_true(ours <= converged * allowed + ORACLE_DIMENSIONS * ldexp(1, -22));
    free(clusters);
    free(work);
    free(centres);
    free(sizes);
    free(kept_labels);
    free(kept_points);
    free_cloud(c);
}

TEST(kmeans)
{
    assert_true(T3R_CLUSTER_WORK_BYTES(T3R_MAX_CLUSTERS) < 65536 && T3R_CLUSTER_WORK_BYTES(32) < 9216);
    cloud c = cloud_of(20000, 40, 0.9, 0.02, 1);
    kmeans_case("well apart", &c, 40, 3); /* a missed blob of 40 costs more than its share */
    c = cloud_of(10000, 0, 1, 0, 2);
    kmeans_case("uniform", &c, 100, 1.1);
    c = cloud_of(15000, 60, 0.9, 0.15, 3);
    c.hole_every = 3;
    kmeans_case("overlapping, a third invalid", &c, 300, 1.1);
    c = cloud_of(5000, 1, 0.1, 0, 4);
    kmeans_case("all points the same", &c, 20, 1);
    c = cloud_of(10, 0, 1, 0, 5);
    kmeans_case("fewer points than clusters", &c, 64, 1);
    c = cloud_of(1, 0, 1, 0, 6);
    kmeans_case("one point", &c, 2, 1);
    c = cloud_of(4000, 0, 3.9, 0, 7);
    kmeans_case("to the ends of the range", &c, 512, 1.15);
}

/* Returns the mean squared distance after clustering, started from the previous centres or from scratch. */
static double kmeans_of(const cloud *c, uint32_t k, bool follows, t3r_cluster *clusters)
{
    const t3r_point_source source = source_of(c);
    const t3r_cluster_settings settings = {&t3r_kernels_c, k, 24, 1, follows};
    const t3r_cluster_host alone = {.workers = {NULL, 1}};
    void *work = aligned_alloc(T3R_ARENA_ALIGN, T3R_CLUSTER_WORK_BYTES(k));
    double *centres = calloc(k, ORACLE_DIMENSIONS * sizeof *centres);
    assert_true(work != NULL && centres != NULL);
    assert_int_equal(t3r_superclusters(&source, &settings, clusters, work, &alone), c->count);
    for (uint32_t i = 0; i < k * ORACLE_DIMENSIONS; i++) {
        centres[i] = ldexp(clusters[i / ORACLE_DIMENSIONS].centre_q19[i % ORACLE_DIMENSIONS], -19);
    }
    const double msd = oracle_kmeans_msd(c->points, c->count, centres, c->labels);
    free(work);
    free(centres);
    return msd;
}

/* The points move by a third of the room: centres without points are placed again, and quality is not lost. */
TEST(kmeans_that_follows)
{
    enum { K = 200, COUNT = 24000 };
    cloud before = cloud_of(COUNT, 60, 0.9, 0.15, 3), after = cloud_of(COUNT, 60, 0.9, 0.15, 3);
    for (uint32_t i = 0; i < COUNT; i++) { /* points that leave at one end enter at the other */
        after.feature_q11[i][0] = (int16_t)(after.feature_q11[i][0] + 2048);
        after.points[i * ORACLE_DIMENSIONS] += 1;
        if (i % 3 == 0) {
            after.feature_q11[i][1] = (int16_t)(after.feature_q11[i][1] - 3000);
            after.points[i * ORACLE_DIMENSIONS + 1] -= 3000 / 2048.0;
        }
    }
    t3r_cluster *anew = calloc(K, sizeof *anew), *following = calloc(K, sizeof *following);
    assert_true(anew != NULL && following != NULL);
    const double best = kmeans_of(&after, K, false, anew);
    (void)kmeans_of(&before, K, false, following);
    const double far_off = kmeans_of(&after, K, true, following), settled = kmeans_of(&after, K, true, following);
    print_message("anew: msd %.6f; following points that moved %.6f, and that stayed %.6f\n", best, far_off, settled);
    assert_true(far_off <= 1.1 * best && settled <= 1.02 * best);
    free(anew);
    free(following);
    free_cloud(&before);
    free_cloud(&after);
}

typedef struct stepper {
    uint32_t calls, stop_at; /* 0: never */
} stepper;

static bool take_step(void *context, uint32_t done, uint32_t total)
{
    stepper *s = context;
    assert_true(done <= total);
    return ++s->calls != s->stop_at;
}

/* Centres stay if all of them still have points; a cancelled step stops at once. */
TEST(kmeans_that_stays)
{
    enum { K = 8, COUNT = 6000, BATCHES = 24 };
    static const int32_t away = 3 << 19;
    cloud c = cloud_of(COUNT, K, 0.9, 0.02, 1);
    t3r_cluster anew[K], following[K];
    (void)kmeans_of(&c, K, false, anew);
    memcpy(following, anew, sizeof anew);
    const double before = kmeans_of(&c, K, true, following);
    for (uint32_t k = 0; k < K; k++) { /* each near its previous place */
        assert_true(anew[k].points < COUNT / (4 * K) ||
                    abs((int)following[k].points - (int)anew[k].points) < COUNT / K);
    }
    assert_true(before < 0.1);
    void *work = aligned_alloc(T3R_ARENA_ALIGN, T3R_CLUSTER_WORK_BYTES(K));
    assert_non_null(work);
    const t3r_cluster_settings settings = {&t3r_kernels_c, K, BATCHES, 1, true};
    uint32_t all = 0;
    for (uint32_t stop_at = 0; stop_at <= all; stop_at++) {
        stepper s = {.stop_at = stop_at};
        const t3r_cluster_host host = {.workers = {NULL, 1}, .context = &s, .step = take_step};
        const t3r_point_source source = source_of(&c);
        memcpy(following, anew, sizeof anew);
        following[1].centre_q19[0] = following[2].centre_q19[0] = away; /* two are placed again */
        const uint32_t valid = t3r_superclusters(&source, &settings, following, work, &host);
        assert_int_equal(valid, stop_at == 0 ? COUNT : T3R_CLUSTERS_CANCELLED);
        all = stop_at == 0 ? s.calls : all;
    }
    assert_true(all > BATCHES / 6);
    free(work);
    free_cloud(&c);
}

/* ---- wavelet ------------------------------------------------------------------------------------- */

typedef enum texture_kind { NOISE, OCTAVES, RAMP, EDGES, FLAT, TEXTURE_KINDS } texture_kind;

static double grid_noise(uint32_t x, uint32_t y, uint32_t seed)
{
    dice d = {((uint64_t)seed << 40) + ((uint64_t)y << 20) + x + 1};
    (void)dice_below(&d, 2);
    (void)dice_below(&d, 2);
    return dice_between(&d, -1, 1);
}

static uint8_t texture_sample(texture_kind kind, uint32_t x, uint32_t y, uint32_t channel)
{
    double value = 128;
    switch (kind) {
    case NOISE:
        value += 127 * grid_noise(x, y, channel);
        break;
    case OCTAVES:
        for (uint32_t octave = 0; octave < 6; octave++) {
            uint32_t side = 1u << octave;
            double u = (double)x / side, v = (double)y / side, fu = u - floor(u), fv = v - floor(v);
            uint32_t i = x / side, j = y / side, seed = 10 + octave;
            value += side * ((1 - fv) * ((1 - fu) * grid_noise(i, j, seed) + fu * grid_noise(i + 1, j, seed)) +
                             fv * ((1 - fu) * grid_noise(i, j + 1, seed) + fu * grid_noise(i + 1, j + 1, seed)));
        }
        break;
    case RAMP:
        value = x + 0.5 * y;
        break;
    case EDGES:
        value = (x / 13 + y / 9) % 2 ? 230 : 20;
        break;
    default:
        break;
    }
    return (uint8_t)fmax(0, fmin(255, value));
}

static void wavelet_case(texture_kind kind, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet wavelet)
{
    size_t pixels = (size_t)width * height;
    uint8_t *planes = malloc(pixels * 3);
    uint16_t *texture = malloc(pixels * 2);
    double *exact = malloc(pixels * sizeof *exact);
    assert_true(planes != NULL && texture != NULL && exact != NULL);
    for (size_t i = 0; i < pixels; i++) {
        for (uint32_t c = 0; c < 3; c++) {
            planes[c * pixels + i] = texture_sample(kind, (uint32_t)(i % width), (uint32_t)(i / width), c);
        }
        exact[i] = (77 * planes[i] + 150 * planes[pixels + i] + 29 * planes[2 * pixels + i]) / 256.0;
    }
    const uint8_t *const colour[3] = {planes, planes + pixels, planes + 2 * pixels};
    wavelet_texture_wrapped(colour, width, height, levels, wavelet, texture);
    oracle_wavelet(exact, width, height, levels, wavelet);
    double want = oracle_wavelet_energy(exact, width, height, levels), got = 0;
    for (size_t i = 0; i < pixels; i++) {
        got += texture[i] / 16.0;
    }
    /* 1 %, or 2 % where a few hundred coefficients can't average their roundings. Where there is little texture, the
     * roundings of the lifting steps count, in levels of luma per pixel and level. */
    double floor_level = kind == NOISE || kind == OCTAVES ? 0 : kind == RAMP ? 0.75 : 0.25;
    double share = pixels >= 4096 ? 0.01 : 0.02;
    if (fabs(got - want) > share * want + floor_level * levels * (double)pixels) {
        fail_msg("texture %d, %ux%u, %u levels, %s: energy %.1f, wanted %.1f", (int)kind, width, height, levels,
                 t3r_wavelet_name(wavelet), got, want);
    }
    free(planes);
    free(texture);
    free(exact);
}

TEST(wavelet_energy)
{
    static const uint32_t sizes[][2] = {{256, 256}, {128, 96}, {64, 4}, {4, 64}, {8, 8}, {320, 240}};
    for (int wavelet = 0; wavelet < T3R_WAVELET_COUNT; wavelet++) {
        for (int kind = 0; kind < TEXTURE_KINDS; kind++) {
            for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
                for (uint32_t levels = 1; levels <= 2; levels++) {
                    wavelet_case((texture_kind)kind, sizes[s][0], sizes[s][1], levels, (t3r_wavelet)wavelet);
                }
            }
        }
    }
}

/* Checks the oracle: orthonormal pairs preserve energy; constants vanish, and so do ramps away from the wrap. */
TEST(wavelet_oracle)
{
    enum { N = 32 };
    double plane[N * N];
    for (int wavelet = 0; wavelet < T3R_WAVELET_COUNT; wavelet++) {
        double before = 0, after = 0;
        for (uint32_t i = 0; i < N * N; i++) {
            plane[i] = grid_noise(i % N, i / N, 99);
            before += plane[i] * plane[i];
        }
        oracle_wavelet(plane, N, N, 3, (t3r_wavelet)wavelet);
        for (int i = 0; i < N * N; i++) {
            after += plane[i] * plane[i];
        }
        assert_true(wavelet == T3R_WAVELET_CDF53 || fabs(after / before - 1) < 1e-12);
        for (int i = 0; i < N * N; i++) {
            plane[i] = 5;
        }
        oracle_wavelet(plane, N, N, 2, (t3r_wavelet)wavelet);
        assert_true(fabs(plane[0] - 20) < 1e-12); /* gain 2 a level */
        assert_true(oracle_wavelet_energy(plane, N, N, 2) < 1e-9);
        for (int i = 0; i < N * N; i++) {
            plane[i] = i % N;
        }
        oracle_wavelet(plane, N, N, 1, (t3r_wavelet)wavelet);
        for (int x = N / 2 + 2; x < N - 2; x++) {
            assert_true(wavelet == T3R_WAVELET_HAAR ? fabs(fabs(plane[x]) - 1) < 1e-12 : fabs(plane[x]) < 1e-12);
        }
    }
}
