#include "scene/formats/sog/codebook.h"

#include <stdlib.h>

enum { ROUNDS = 20 };

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Initialises half of the values evenly over the range and half at even quantiles, so that neither outliers nor
 * clusters are lost. */
static void begin(const double *numbers, size_t count, double values[CODEBOOK_VALUES])
{
    enum { HALF = CODEBOOK_VALUES / 2 };
    const double low = numbers[0], high = numbers[count - 1];
    for (int i = 0; i < HALF; i++) {
        values[i] = low + (high - low) * i / (HALF - 1);
        values[HALF + i] = numbers[(size_t)((i + 0.5) / HALF * (double)count)];
    }
    qsort(values, CODEBOOK_VALUES, sizeof values[0], ascending);
}

/* Moves each value to the mean of the numbers nearest to it; a value without numbers stays. */
static void improve(const double *numbers, size_t count, double values[CODEBOOK_VALUES])
{
    size_t at = 0;
    for (int i = 0; i < CODEBOOK_VALUES; i++) {
        const size_t first = at;
        double sum = 0;
        while (at < count && (i + 1 == CODEBOOK_VALUES || numbers[at] <= (values[i] + values[i + 1]) / 2)) {
            sum += numbers[at++];
        }
        if (at > first) {
            values[i] = sum / (double)(at - first);
        }
    }
}

void codebook_make(double *numbers, size_t count, double values[CODEBOOK_VALUES])
{
    qsort(numbers, count, sizeof numbers[0], ascending);
    begin(numbers, count, values);
    for (int round = 0; round < ROUNDS; round++) {
        improve(numbers, count, values);
    }
}

uint8_t codebook_index(const double values[CODEBOOK_VALUES], double number)
{
    int low = 0, high = CODEBOOK_VALUES - 1;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (number > (values[middle] + values[middle + 1]) / 2) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return (uint8_t)low;
}
