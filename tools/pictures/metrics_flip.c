/* LDR-FLIP after Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: "FLIP: A Difference Evaluator for
 * Alternating Images" (2020). Written from the paper's definition: contrast sensitivity filters and the HyAB distance
 * of Hunt-adjusted L*a*b* for colour, edge and point detectors for features, colour difference to the power of one
 * minus the feature difference. */
#include "pictures/metrics.h"

#include <math.h>
#include <stdlib.h>

#include "pictures/metrics_filter.h"

#define PIXELS_A_DEGREE 67.0
#define PI 3.14159265358979323846
#define MOST_TAPS 32u

static const double exponent_colour = 0.7;   /* q_c */
static const double share_colour = 0.4;      /* p_c: below this share of the largest difference ... */
static const double reach_colour = 0.95;     /* p_t: ... errors fill this much of the range */
static const double exponent_feature = 0.5;  /* q_f */
static const double feature_degrees = 0.082; /* w: width of the feature detectors */

/* Linear RGB (BT.709 primaries) to XYZ over the D65 white of the same matrix, so that white is 1, 1, 1. */
static const double xyz_of_rgb[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382},
};

typedef struct flip_space {
    double to_xyz[3][3];   /* linear RGB to XYZ over white */
    double from_xyz[3][3]; /* its inverse */
    double linear[256];    /* sRGB code to linear */
    double largest;        /* difference of pure green and pure blue, to the power q_c */
} flip_space;

static void invert(double m[3][3], double inverse[3][3])
{
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            int r1 = (c + 1) % 3, r2 = (c + 2) % 3, c1 = (r + 1) % 3, c2 = (r + 2) % 3;
            inverse[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        }
    }
    double determinant = m[0][0] * inverse[0][0] + m[0][1] * inverse[1][0] + m[0][2] * inverse[2][0];
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            inverse[r][c] /= determinant;
        }
    }
}

static void transform(double m[3][3], const double in[3], double out[3])
{
    for (int r = 0; r < 3; r++) {
        out[r] = m[r][0] * in[0] + m[r][1] * in[1] + m[r][2] * in[2];
    }
}

static double lab_curve(double t)
{
    static const double delta = 6.0 / 29;
    return t > delta * delta * delta ? cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

/* Converts linear RGB to L*a*b* with Hunt's adjustment: chroma decreases with lightness. */
static void hunt_lab(flip_space *space, const double rgb[3], double lab[3])
{
    double xyz[3];
    transform(space->to_xyz, rgb, xyz);
    double fx = lab_curve(xyz[0]), fy = lab_curve(xyz[1]), fz = lab_curve(xyz[2]);
    lab[0] = 116 * fy - 16;
    lab[1] = 0.01 * lab[0] * 500 * (fx - fy);
    lab[2] = 0.01 * lab[0] * 200 * (fy - fz);
}

static double hyab(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

static void flip_space_init(flip_space *space)
{
    for (int r = 0; r < 3; r++) {
        double white = xyz_of_rgb[r][0] + xyz_of_rgb[r][1] + xyz_of_rgb[r][2];
        for (int c = 0; c < 3; c++) {
            space->to_xyz[r][c] = xyz_of_rgb[r][c] / white;
        }
    }
    invert(space->to_xyz, space->from_xyz);
    for (int i = 0; i < 256; i++) {
        double s = i / 255.0;
        space->linear[i] = s > 0.04045 ? pow((s + 0.055) / 1.055, 2.4) : s / 12.92;
    }
    double green[3], blue[3];
    hunt_lab(space, (const double[3]){0, 1, 0}, green);
    hunt_lab(space, (const double[3]){0, 0, 1}, blue);
    space->largest = pow(hyab(green, blue), exponent_colour);
}

/* Samples exp(-x^2 / (2 sigma^2)), x = -radius..radius; returns the sum. */
static double bell(double *taps, uint32_t radius, double sigma)
{
    double sum = 0;
    for (uint32_t k = 0; k <= 2 * radius; k++) {
        double x = (double)k - radius;
        taps[k] = exp(-x * x / (2 * sigma * sigma));
        sum += taps[k];
    }
    return sum;
}

/* Filters one channel by its contrast sensitivity: a1 sqrt(pi / b1) exp(-pi^2 d^2 / b1) + the same of a2, b2, where d
 * is in degrees; normalised to a sum of 1. Each term is separable. `sum` and `term` hold a plane. */
static void contrast_filter(double *plane, double *sum, double *term, double *work, uint32_t width, uint32_t height,
                            const double a[2], const double b[2])
{
    double taps[2][MOST_TAPS], scaled[MOST_TAPS], weight[2], total = 0;
    double widest = sqrt(0.04 / (2 * PI * PI)); /* the largest b of all channels determines the common radius */
    uint32_t radius = (uint32_t)ceil(3 * widest * PIXELS_A_DEGREE);
    size_t pixels = (size_t)width * height;
    for (int t = 0; t < 2; t++) {
        double one = bell(taps[t], radius, sqrt(b[t] / (2 * PI * PI)) * PIXELS_A_DEGREE);
        weight[t] = a[t] * sqrt(PI / b[t]);
        total += weight[t] * one * one;
    }
    for (size_t i = 0; i < pixels; i++) {
        sum[i] = 0;
    }
    for (int t = 0; t < 2; t++) {
        if (weight[t] <= 0) {
            continue;
        }
        for (uint32_t k = 0; k <= 2 * radius; k++) {
            scaled[k] = taps[t][k] * weight[t] / total;
        }
        metrics_filter(plane, term, work, width, height, scaled, taps[t], radius, METRICS_BORDER_REPLICATE);
        for (size_t i = 0; i < pixels; i++) {
            sum[i] += term[i];
        }
    }
    for (size_t i = 0; i < pixels; i++) {
        plane[i] = sum[i];
    }
}

/* Converts the image to opponent colours: Y, Cx, Cz (linear, as L*a*b* would be without its cube root). */
static void opponent_planes(flip_space *space, const uint8_t *rgb, size_t pixels, double *planes)
{
    for (size_t i = 0; i < pixels; i++) {
        double xyz[3],
            linear[3] = {space->linear[rgb[3 * i]], space->linear[rgb[3 * i + 1]], space->linear[rgb[3 * i + 2]]};
        transform(space->to_xyz, linear, xyz);
        planes[i] = 116 * xyz[1] - 16;
        planes[pixels + i] = 500 * (xyz[0] - xyz[1]);
        planes[2 * pixels + i] = 200 * (xyz[1] - xyz[2]);
    }
}

static void perceived_lab(flip_space *space, const double *planes, size_t pixels, size_t i, double lab[3])
{
    double xyz[3], rgb[3];
    xyz[1] = (planes[i] + 16) / 116;
    xyz[0] = planes[pixels + i] / 500 + xyz[1];
    xyz[2] = xyz[1] - planes[2 * pixels + i] / 200;
    transform(space->from_xyz, xyz, rgb);
    for (int c = 0; c < 3; c++) {
        rgb[c] = rgb[c] < 0 ? 0 : rgb[c] > 1 ? 1 : rgb[c];
    }
    hunt_lab(space, rgb, lab);
}

/* Computes a detector's taps along its own axis, such that with the Gaussian `smooth` across, the positive weights sum
 * to 1 and the negative ones to -1. The first derivative of a Gaussian detects edges, the second points. */
static void detector_taps(int points, double sigma, uint32_t radius, double *taps, double *smooth)
{
    double across = bell(smooth, radius, sigma), positive = 0, negative = 0;
    for (uint32_t k = 0; k <= 2 * radius; k++) {
        double x = (double)k - radius;
        taps[k] = (points ? x * x / (sigma * sigma) - 1 : -x) * exp(-x * x / (2 * sigma * sigma));
        positive += taps[k] > 0 ? taps[k] : 0;
        negative += taps[k] < 0 ? -taps[k] : 0;
    }
    for (uint32_t k = 0; k <= 2 * radius; k++) {
        taps[k] /= (taps[k] < 0 ? negative : positive) * across;
    }
}

/* Computes strength = length of the vector of the detector's responses along x and y, on luminance in 0..1. `answer`
 * holds two planes. */
static void feature_strength(const double *luma, double *strength, double *answer, double *work, uint32_t width,
                             uint32_t height, int points)
{
    double taps[MOST_TAPS], smooth[MOST_TAPS];
    double sigma = 0.5 * feature_degrees * PIXELS_A_DEGREE;
    uint32_t radius = (uint32_t)ceil(3 * sigma);
    size_t pixels = (size_t)width * height;
    detector_taps(points, sigma, radius, taps, smooth);
    metrics_filter(luma, answer, work, width, height, taps, smooth, radius, METRICS_BORDER_REPLICATE);
    metrics_filter(luma, answer + pixels, work, width, height, smooth, taps, radius, METRICS_BORDER_REPLICATE);
    for (size_t i = 0; i < pixels; i++) {
        strength[i] = hypot(answer[i], answer[pixels + i]);
    }
}

/* Maps differences so that small ones fill most of the range, and rare large ones the rest. */
static double spread_difference(double power, double largest)
{
    double knee = share_colour * largest;
    return power < knee ? reach_colour * power / knee
                        : reach_colour + (power - knee) / (largest - knee) * (1 - reach_colour);
}

double metric_flip(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height)
{
    /* achromatic, red-green, blue-yellow: the two terms' weights and widths (the paper's table 1) */
    static const double sensitivity_a[3][2] = {{1, 0}, {1, 0}, {34.1, 13.5}};
    static const double sensitivity_b[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
    size_t pixels = (size_t)width * height, count = 0;
    double *memory = malloc(14 * pixels * sizeof *memory);
    if (memory == NULL) {
        return NAN;
    }
    double *opponent[2] = {memory, memory + 3 * pixels};
    double *feature[2][2] = {{memory + 6 * pixels, memory + 7 * pixels}, {memory + 8 * pixels, memory + 9 * pixels}};
    double *scratch = memory + 10 * pixels, *luma = memory + 12 * pixels, *work = memory + 13 * pixels;
    const uint8_t *images[2] = {target, render};
    flip_space space;
    flip_space_init(&space);
    for (int image = 0; image < 2; image++) {
        opponent_planes(&space, images[image], pixels, opponent[image]);
        for (size_t i = 0; i < pixels; i++) {
            luma[i] = (opponent[image][i] + 16) / 116;
        }
        feature_strength(luma, feature[image][0], scratch, work, width, height, 0);
        feature_strength(luma, feature[image][1], scratch, work, width, height, 1);
        for (size_t c = 0; c < 3; c++) {
            contrast_filter(opponent[image] + c * pixels, scratch, scratch + pixels, work, width, height,
                            sensitivity_a[c], sensitivity_b[c]);
        }
    }
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (mask != NULL && mask[i] == 0) {
            continue;
        }
        double a[3], b[3];
        perceived_lab(&space, opponent[0], pixels, i, a);
        perceived_lab(&space, opponent[1], pixels, i, b);
        double colour = spread_difference(pow(hyab(a, b), exponent_colour), space.largest);
        double edges = fabs(feature[0][0][i] - feature[1][0][i]), points = fabs(feature[0][1][i] - feature[1][1][i]);
        double features = pow((edges > points ? edges : points) / sqrt(2), exponent_feature);
        sum += pow(colour, 1 - (features > 1 ? 1 : features));
        count++;
    }
    free(memory);
    return count == 0 ? NAN : sum / (double)count;
}
