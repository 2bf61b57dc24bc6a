/* SPDX-License-Identifier: Apache-2.0 */
#include "oracle_analysis.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

static double distance2(const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < ORACLE_DIMENSIONS; i++) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sum;
}

double oracle_kmeans_assign(const double *points, size_t count, const double *centres, size_t k, uint32_t *labels)
{
    double sum = 0;
    for (size_t p = 0; p < count; p++) {
        double least = DBL_MAX;
        size_t best = 0;
        for (size_t c = 0; c < k; c++) {
            double d = distance2(&points[p * ORACLE_DIMENSIONS], &centres[c * ORACLE_DIMENSIONS]);
            if (d < least) {
                least = d;
                best = c;
            }
        }
        if (labels != NULL) {
            labels[p] = (uint32_t)best;
        }
        sum += least;
    }
    return count == 0 ? 0 : sum / (double)count;
}

double oracle_kmeans_msd(const double *points, size_t count, const double *centres, const uint32_t *labels)
{
    double sum = 0;
    for (size_t p = 0; p < count; p++) {
        sum += distance2(&points[p * ORACLE_DIMENSIONS], &centres[labels[p] * (size_t)ORACLE_DIMENSIONS]);
    }
    return count == 0 ? 0 : sum / (double)count;
}

double oracle_kmeans_lloyd(const double *points, size_t count, double *centres, size_t k, uint32_t most)
{
    uint32_t *labels = calloc(count == 0 ? 1 : count, sizeof *labels);
    double *sums = calloc(k, (ORACLE_DIMENSIONS + 1) * sizeof *sums);
    if (labels == NULL || sums == NULL) {
        fprintf(stderr, "oracle: out of memory\n");
        exit(EXIT_FAILURE);
    }
    double msd = oracle_kmeans_assign(points, count, centres, k, labels);
    for (uint32_t round = 0; round < most; round++) {
        for (size_t i = 0; i < k * (ORACLE_DIMENSIONS + 1); i++) {
            sums[i] = 0;
        }
        for (size_t p = 0; p < count; p++) {
            double *sum = &sums[labels[p] * (size_t)(ORACLE_DIMENSIONS + 1)];
            for (int i = 0; i < ORACLE_DIMENSIONS; i++) {
                sum[i] += points[p * ORACLE_DIMENSIONS + (size_t)i];
            }
            sum[ORACLE_DIMENSIONS] += 1;
        }
        for (size_t c = 0; c < k; c++) {
            const double *sum = &sums[c * (ORACLE_DIMENSIONS + 1)];
            for (size_t i = 0; i < ORACLE_DIMENSIONS && sum[ORACLE_DIMENSIONS] > 0; i++) {
                centres[c * ORACLE_DIMENSIONS + i] = sum[i] / sum[ORACLE_DIMENSIONS];
            }
        }
        double next = oracle_kmeans_assign(points, count, centres, k, labels);
        if (next >= msd) {
            break;
        }
        msd = next;
    }
    free(sums);
    free(labels);
    return msd;
}
