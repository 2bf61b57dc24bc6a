/* SPDX-License-Identifier: Apache-2.0 */
#include "oracle_raster.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *allocate(size_t count, size_t bytes)
{
    void *p = calloc(count == 0 ? 1 : count, bytes);
    if (p == NULL) {
        fprintf(stderr, "oracle: out of memory\n");
        exit(EXIT_FAILURE);
    }
    return p;
}

static void rotation_from_quaternion(const double q[4], double r[9])
{
    double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    double w = q[0] / norm, x = q[1] / norm, y = q[2] / norm, z = q[3] / norm;
    const double m[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
        2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y),
    };
    memcpy(r, m, sizeof m);
}

void oracle_from_t3r(const t3r_gaussian *from, oracle_gaussian *to)
{
    for (int i = 0; i < 3; i++) {
        to->position[i] = ldexp(from->position_q20[i], -20);
        to->colour[i] = from->colour_q7[i] / (128.0 * 255.0);
    }
    for (int i = 0; i < 9; i++) {
        to->factor[i] = ldexp(from->factor[i], from->factor_exponent);
    }
    to->opacity = ldexp(from->opacity_q15, -15);
}

oracle_camera oracle_camera_from_t3r(const t3r_camera *from, const t3r_scene_frame *frame, uint32_t width,
                                     uint32_t height)
{
    oracle_camera c = {
        .width = width,
        .height = height,
        .fx = ldexp(from->fx_q16, -16),
        .fy = ldexp(from->fy_q16, -16),
        .cx = ldexp(from->cx_q16, -16),
        .cy = ldexp(from->cy_q16, -16),
    };
    double q[4];
    for (int i = 0; i < 4; i++) {
        q[i] = ldexp(from->rotation_q30[i], -30);
    }
    rotation_from_quaternion(q, c.rotation);
    for (int i = 0; i < 3; i++) {
        /* the difference is taken in integers: far from the world's origin doubles would lose bits */
        int64_t moved = (int64_t)((uint64_t)from->position_q32[i] - (uint64_t)frame->origin_q32[i]);
        c.position[i] = ldexp((double)moved, -32 - frame->exponent);
    }
    return c;
}

static size_t property_column(char *const *names, size_t count, const char *name)
{
    size_t column = 0;
    while (column < count && strcmp(names[column], name) != 0) {
        column++;
    }
    return column;
}

oracle_gaussian *oracle_read_ply(const char *path, const t3r_scene_frame *frame, size_t *count)
{
    enum { MOST = 128, WANTED = 14 };
    static const char *const wanted[WANTED] = {"x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                                               "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return NULL;
    }
    char line[256], name[64], storage[MOST][64];
    char *names[MOST];
    size_t columns = 0;
    unsigned long vertices = 0;
    while (fgets(line, sizeof line, file) != NULL && strncmp(line, "end_header", 10) != 0) {
        if (sscanf(line, "property float %63s", name) == 1 && columns < MOST) {
            memcpy(storage[columns], name, sizeof name);
            names[columns] = storage[columns];
            columns++;
        }
        (void)sscanf(line, "element vertex %lu", &vertices);
    }
    size_t column[WANTED];
    for (size_t i = 0; i < WANTED; i++) {
        column[i] = property_column(names, columns, wanted[i]);
        if (column[i] == columns) {
            fclose(file);
            return NULL;
        }
    }
    oracle_gaussian *gaussians = allocate(vertices, sizeof *gaussians);
    float *row = allocate(columns, sizeof *row);
    for (size_t g = 0; g < vertices; g++) {
        if (fread(row, sizeof *row, columns, file) != columns) {
            free(gaussians);
            gaussians = NULL;
            break;
        }
        double v[WANTED], r[9];
        for (size_t i = 0; i < WANTED; i++) {
            v[i] = row[column[i]];
        }
        rotation_from_quaternion(&v[10], r);
        for (int i = 0; i < 3; i++) {
            double colour = 0.5 + 0.28209479177387814 * v[3 + i];
            gaussians[g].colour[i] = colour < 0 ? 0 : colour > 1 ? 1 : colour;
            gaussians[g].position[i] = ldexp(v[i] - ldexp((double)frame->origin_q32[i], -32), -frame->exponent);
            for (int k = 0; k < 3; k++) {
                gaussians[g].factor[i * 3 + k] = ldexp(r[i * 3 + k] * exp(v[7 + k]), -frame->exponent);
            }
        }
        gaussians[g].opacity = 1 / (1 + exp(-v[6]));
    }
    free(row);
    fclose(file);
    *count = vertices;
    return gaussians;
}

typedef struct splat {
    double x, y, z;      /* pixels, pixels, camera z */
    double gx[3], gy[3]; /* the projected factor: covariance = gx.gx + 0.3, gx.gy, gy.gy + 0.3 */
    double inverse_det;
    double reach_x, reach_y; /* half sides of the box outside which alpha < 1/255 */
    double slope_x, slope_y; /* change of depth a pixel, in parts of z */
    double most;             /* of one over depth, in parts of 1 / z */
    double with_depth;       /* |covariance| of a pixel's coordinates with depth, in parts of z, both added */
    double opacity;
    double colour[3];
} splat;

typedef struct order {
    double key; /* camera z in steps of 2^-20 */
    size_t index;
} order;

static int compare_order(const void *a, const void *b)
{
    const order *p = a, *q = b;
    if (p->key != q->key) {
        return p->key < q->key ? -1 : 1;
    }
    return p->index < q->index ? -1 : p->index > q->index;
}

static double clamped(double x, double limit)
{
    return x < -limit ? -limit : x > limit ? limit : x;
}

/* The surface of the drawn footprint: the mean depth of the Gaussian at a pixel is linear about its mean, and two
 * standard deviations from it at most. row: of the factor, along the axis, in parts of z. */
static void find_surface(splat *s, const double row[3])
{
    double xx = 0.3, xy = 0, yy = 0.3, xz = 0, yz = 0, zz = 0;
    for (int k = 0; k < 3; k++) {
        xx += s->gx[k] * s->gx[k];
        xy += s->gx[k] * s->gy[k];
        yy += s->gy[k] * s->gy[k];
        xz += s->gx[k] * row[k];
        yz += s->gy[k] * row[k];
        zz += row[k] * row[k];
    }
    s->slope_x = (yy * xz - xy * yz) * s->inverse_det;
    s->slope_y = (xx * yz - xy * xz) * s->inverse_det;
    s->most = 2 * sqrt(zz) / (1 + 2 * sqrt(zz));
    s->with_depth = fabs(xz) + fabs(yz);
}

static double depth_at(const splat *s, double dx, double dy)
{
    return s->z / (1 - clamped(s->slope_x * dx + s->slope_y * dy, s->most));
}

/* The error that steps of 2^-30 in the inverse covariance allow, and a hundredth of a standard deviation. */
static double slack_at(const splat *s, double z, double distance)
{
    return z * z / s->z * (5e-3 * s->most + ldexp(s->with_depth * distance, -30));
}

/* 0 = culled */
static int project(const oracle_gaussian *g, const oracle_camera *c, splat *s)
{
    double t[3], f[9];
    for (int i = 0; i < 3; i++) {
        t[i] = 0;
        for (int j = 0; j < 3; j++) {
            t[i] += c->rotation[j * 3 + i] * (g->position[j] - c->position[j]);
        }
        for (int k = 0; k < 3; k++) {
            f[i * 3 + k] = 0;
            for (int j = 0; j < 3; j++) {
                f[i * 3 + k] += c->rotation[j * 3 + i] * g->factor[j * 3 + k];
            }
        }
    }
    double z = t[2];
    if (z <= ORACLE_NEAR || fabs(t[0]) > 16 * z || fabs(t[1]) > 16 * z || g->opacity * 255 < 1) {
        return 0;
    }
    /* the farther edge, half a pixel beyond the outermost centres */
    double slope_x = clamped(t[0] / z, 1.3 * fmax(c->cx + 0.5, c->width - 0.5 - c->cx) / c->fx);
    double slope_y = clamped(t[1] / z, 1.3 * fmax(c->cy + 0.5, c->height - 0.5 - c->cy) / c->fy);
    double trace = 0, minors = 0;
    for (int k = 0; k < 3; k++) {
        s->gx[k] = clamped(c->fx / z * (f[k] - slope_x * f[6 + k]), ORACLE_MOST_PIXELS);
        s->gy[k] = clamped(c->fy / z * (f[3 + k] - slope_y * f[6 + k]), ORACLE_MOST_PIXELS);
        trace += s->gx[k] * s->gx[k] + s->gy[k] * s->gy[k];
    }
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3;
        double minor = s->gx[k] * s->gy[l] - s->gx[l] * s->gy[k];
        minors += minor * minor;
    }
    /* det(G G^T + 0.3 I) by Cauchy-Binet: a sum of positive terms, so nothing cancels for needles */
    s->inverse_det = 1 / (minors + 0.3 * trace + 0.09);
    double q_most = log(255 * g->opacity);
    s->reach_x = sqrt(2 * q_most * (s->gx[0] * s->gx[0] + s->gx[1] * s->gx[1] + s->gx[2] * s->gx[2] + 0.3));
    s->reach_y = sqrt(2 * q_most * (s->gy[0] * s->gy[0] + s->gy[1] * s->gy[1] + s->gy[2] * s->gy[2] + 0.3));
    s->x = c->fx * t[0] / z + c->cx;
    s->y = c->fy * t[1] / z + c->cy;
    s->z = z;
    s->opacity = g->opacity;
    find_surface(s, (const double[]){clamped(f[6] / z, ORACLE_DEEPEST), clamped(f[7] / z, ORACLE_DEEPEST),
                                     clamped(f[8] / z, ORACLE_DEEPEST)});
    memcpy(s->colour, g->colour, sizeof s->colour);
    return 1;
}

static void note_depth(double *depth, double z, double before, double after, double threshold)
{
    if (before >= threshold && after < threshold) {
        *depth = z;
    }
}

static void blend(const splat *s, oracle_image *image)
{
    double x0 = ceil(s->x - s->reach_x), x1 = floor(s->x + s->reach_x);
    double y0 = ceil(s->y - s->reach_y), y1 = floor(s->y + s->reach_y);
    if (x1 < 0 || y1 < 0 || x0 > image->width - 1.0 || y0 > image->height - 1.0) {
        return;
    }
    size_t left = (size_t)fmax(x0, 0), right = (size_t)fmin(x1, image->width - 1.0);
    size_t top = (size_t)fmax(y0, 0), bottom = (size_t)fmin(y1, image->height - 1.0);
    for (size_t y = top; y <= bottom; y++) {
        for (size_t x = left; x <= right; x++) {
            size_t pixel = y * image->width + x;
            double *t = &image->transmittance[pixel];
            if (*t < 1e-4) {
                continue;
            }
            double dx = (double)x - s->x, dy = (double)y - s->y;
            double sum = 0.3 * (dx * dx + dy * dy);
            for (int k = 0; k < 3; k++) {
                double e = s->gy[k] * dx - s->gx[k] * dy;
                sum += e * e;
            }
            double alpha = fmin(0.99, s->opacity * exp(-0.5 * sum * s->inverse_det));
            if (alpha < 1 / 255.0) {
                continue;
            }
            for (int i = 0; i < 3; i++) {
                image->rgb[pixel * 3 + (size_t)i] += *t * alpha * s->colour[i];
            }
            double after = *t * (1 - alpha);
            const double z = depth_at(s, dx, dy);
            note_depth(&image->depth_first[pixel], z, *t, after, 0.5 + ORACLE_DEPTH_MARGIN);
            note_depth(&image->depth[pixel], z, *t, after, 0.5);
            note_depth(&image->depth_last[pixel], z, *t, after, 0.5 - ORACLE_DEPTH_MARGIN);
            if (*t >= 0.5 && after < 0.5) {
                image->depth_slack[pixel] = slack_at(s, z, fabs(dx) + fabs(dy));
            }
            *t = after;
        }
    }
}

void oracle_render(const oracle_gaussian *gaussians, size_t count, const oracle_camera *camera, oracle_image *image)
{
    size_t pixels = (size_t)camera->width * camera->height;
    *image = (oracle_image){
        .width = camera->width,
        .height = camera->height,
        .rgb = allocate(pixels * 3, sizeof(double)),
        .transmittance = allocate(pixels, sizeof(double)),
        .depth = allocate(pixels, sizeof(double)),
        .depth_slack = allocate(pixels, sizeof(double)),
        .depth_first = allocate(pixels, sizeof(double)),
        .depth_last = allocate(pixels, sizeof(double)),
    };
    for (size_t i = 0; i < pixels; i++) {
        image->transmittance[i] = 1;
        image->depth_last[i] = HUGE_VAL;
    }
    splat *splats = allocate(count, sizeof *splats);
    order *orders = allocate(count, sizeof *orders);
    size_t drawn = 0;
    for (size_t i = 0; i < count; i++) {
        if (project(&gaussians[i], camera, &splats[i])) {
            orders[drawn++] = (order){floor(ldexp(splats[i].z, 20) + 0.5), i};
        }
    }
    qsort(orders, drawn, sizeof *orders, compare_order);
    for (size_t i = 0; i < drawn; i++) {
        blend(&splats[orders[i].index], image);
    }
    image->drawn = (uint32_t)drawn;
    free(orders);
    free(splats);
}

void oracle_image_free(oracle_image *image)
{
    free(image->rgb);
    free(image->transmittance);
    free(image->depth);
    free(image->depth_slack);
    free(image->depth_first);
    free(image->depth_last);
    *image = (oracle_image){0};
}

double oracle_psnr(const oracle_image *image, const uint8_t *rgb, size_t stride_bytes)
{
    double sum = 0;
    for (size_t y = 0; y < image->height; y++) {
        for (size_t x = 0; x < (size_t)image->width * 3; x++) {
            double want = floor(image->rgb[y * image->width * 3 + x] * 255 + 0.5);
            double error = rgb[y * stride_bytes + x] - want;
            sum += error * error;
        }
    }
    double mean = sum / (3.0 * image->width * image->height);
    return mean == 0 ? 99 : fmin(99, 10 * log10(255.0 * 255.0 / mean));
}
