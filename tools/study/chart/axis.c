/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/axis.h"

#include <math.h>
#include <stdio.h>

#define ROOM 0.06       /* margin at either end, as a share of the range */
#define LOG_RATIO 5.0   /* ratio of the largest to the smallest value from which an axis is logarithmic */
#define LOG_LEAST 1e-9  /* smallest value on a logarithmic axis; smaller ones are not measurements */
#define TICKS_WANTED 8u /* at most; the step is the smallest round one that gives no more */

static double value_on_scale(const chart_axis *axis, double value)
{
    return axis->logarithmic ? log(value) : value;
}

double chart_axis_place(const chart_axis *axis, double value)
{
    double low = value_on_scale(axis, axis->low), high = value_on_scale(axis, axis->high);
    return (value_on_scale(axis, value) - low) / (high - low);
}

/* Writes the value with at most `decimals` decimals, without trailing zeros. */
static void short_number(double value, int decimals, char *text, size_t bytes)
{
    int length = snprintf(text, bytes, "%.*f", decimals, value);
    while (decimals > 0 && length > 1 && (text[length - 1] == '0' || text[length - 1] == '.')) {
        bool point = text[--length] == '.';
        text[length] = '\0';
        if (point) {
            return;
        }
    }
}

/* Returns the unit for a size; each unit is 1024 times the next smaller one. */
static const char *byte_unit(double value, double *unit)
{
    static const char *const names[] = {"B", "KiB", "MiB", "GiB", "TiB"};
    uint32_t i = 0;
    for (*unit = 1; i + 1 < sizeof names / sizeof names[0] && fabs(value) >= *unit * 1024; i++) {
        *unit *= 1024;
    }
    return names[i];
}

static void tick_label(chart_unit kind, double value, double step, char *text, size_t bytes)
{
    double unit = 1;
    const char *name = kind == CHART_DECIBELS ? "dB" : "";
    if (kind == CHART_BYTES) {
        name = byte_unit(value, &unit);
    } else if (kind == CHART_MILLISECONDS) {
        unit = value >= 1000 ? 1000 : 1;
        name = value >= 1000 ? "s" : "ms";
    }
    char number[CHART_LABEL_BYTES - 8];
    double digits =
        step > 0 ? ceil(-log10(step / unit) - 1e-9) : 6; /* decimals that a tick of a logarithmic axis needs */
    short_number(value / unit, digits < 0 ? 0 : digits > 6 ? 6 : (int)digits, number, sizeof number);
    snprintf(text, bytes, "%s%s%s", number, *name != '\0' ? " " : "", name);
}

void chart_value_text(chart_measure measure, double value, char *text, size_t bytes)
{
    const chart_measure_about *about = &chart_measures[measure];
    double unit = 1;
    if (isnan(value)) {
        snprintf(text, bytes, "-");
    } else if (about->unit == CHART_BYTES) {
        const char *name = byte_unit(value, &unit);
        snprintf(text, bytes, "%.*f %s", unit > 1 ? 2 : 0, value / unit, name);
    } else if (about->unit == CHART_MILLISECONDS) {
        bool seconds = value >= 1000;
        snprintf(text, bytes, "%.3g %s", seconds ? value / 1000 : value, seconds ? "s" : "ms");
    } else {
        snprintf(text, bytes, "%.*f%s", about->decimals, value, about->unit == CHART_DECIBELS ? " dB" : "");
    }
}

static void add(chart_axis *axis, chart_unit unit, double value, double step)
{
    double place = axis->logarithmic && value <= 0 ? -1 : chart_axis_place(axis, value);
    /* tolerance for range ends that are round numbers themselves */
    if (axis->tick_count < CHART_TICKS_MOST && place >= -1e-9 && place <= 1 + 1e-9) {
        chart_tick *tick = &axis->tick[axis->tick_count++];
        tick->value = value == 0 ? 0 : value; /* no -0 */
        tick_label(unit, value, step, tick->label, sizeof tick->label);
    }
}

/* Returns the smallest step of 1, 2, 5 times a power of ten (for bytes, a power of two) that gives at most
 * TICKS_WANTED ticks. */
static double round_step(chart_unit unit, double range)
{
    double least = range / TICKS_WANTED;
    if (unit == CHART_BYTES) {
        return least <= 1 ? 1 : exp2(ceil(log2(least) - 1e-9));
    }
    double power = pow(10, floor(log10(least)));
    for (int i = 0; i < 3; i++) {
        static const double times[] = {1, 2, 5};
        if (times[i] * power >= least * (1 - 1e-9)) {
            return times[i] * power;
        }
    }
    return 10 * power;
}

static void linear_ticks(chart_axis *axis, chart_unit unit)
{
    double step = round_step(unit, axis->high - axis->low), first = ceil(axis->low / step - 1e-9);
    for (uint32_t i = 0; i < CHART_TICKS_MOST; i++) {
        add(axis, unit, (first + i) * step, step);
    }
}

/* Places ticks at powers of two, thinned until at most TICKS_WANTED remain. */
static void binary_ticks(chart_axis *axis)
{
    double low = log2(axis->low), range = log2(axis->high) - low, step = 1;
    while (range / step > TICKS_WANTED) {
        step += 1;
    }
    double first = ceil(low / step - 1e-9);
    for (uint32_t i = 0; i < CHART_TICKS_MOST; i++) {
        add(axis, CHART_BYTES, exp2((first + i) * step), 0);
    }
}

/* Places ticks at 1, 2, 5 times powers of ten; at 1, 2, 3, 5, 7 times for a range of little more than a decade; only
 * at powers of ten, thinned if necessary, if those are too many. */
static void decimal_ticks(chart_axis *axis, chart_unit unit)
{
    static const double few[] = {1, 2, 3, 5, 7}, some[] = {1, 2, 5};
    double decades = log10(axis->high / axis->low), every = 1;
    const double *times = decades < 1.3 ? few : some;
    uint32_t of_power = decades < 1.3 ? 5 : decades * 3 < CHART_TICKS_MOST - 1 ? 3 : 1;
    while (decades / every > TICKS_WANTED) {
        every += 1;
    }
    double first = floor(log10(axis->low) / every) * every;
    for (uint32_t i = 0; i <= TICKS_WANTED + 1; i++) {
        double power = pow(10, first + i * every);
        for (uint32_t t = 0; t < of_power; t++) {
            add(axis, unit, times[t] * power, 0);
        }
    }
}

chart_axis chart_axis_make(chart_measure measure, double least, double most)
{
    const chart_measure_about *about = &chart_measures[measure];
    bool cost = measure >= CHART_QUALITIES;
    chart_axis axis = {.logarithmic = cost && least >= LOG_LEAST && most / least > LOG_RATIO,
                       .falling = !cost && about->less_is_better != 0};
    if (axis.logarithmic) {
        double room = pow(most / least, ROOM);
        axis.low = least / room;
        axis.high = most * room;
    } else {
        /* least and most are nearly equal: widen the range until its digits differ, for bytes to whole ones */
        double range = most - least, digits = fmax(fabs(most), 1) * 1e-3;
        bool bytes = about->unit == CHART_BYTES, one = range <= (bytes ? fmax(digits, 16) : digits);
        double room = !one ? range * ROOM : bytes ? fmax(most * 0.05, 16) : 50 * digits;
        axis.low = cost && least >= 0 && least - room < 0 ? 0 : least - room;
        axis.high = most + room;
    }
    if (!axis.logarithmic) {
        linear_ticks(&axis, about->unit);
    } else if (about->unit == CHART_BYTES) {
        binary_ticks(&axis);
    } else {
        decimal_ticks(&axis, about->unit);
    }
    return axis;
}
