/* SPDX-License-Identifier: Apache-2.0 */
/* Machines of plans: files of prices, and the fit of prices to times. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "planning/machine.h"
#include "planning/price_fit.h"

static machine some_machine(void)
{
    machine m = {.threads = 3, .cpu = "avx2"};
    for (int work = 0; work < T3R_WORK_COUNT; work++) {
        m.prices.milli[work] = (uint32_t)work * 1000003u;
    }
    m.prices.milli[T3R_WORK_MACS] = UINT32_MAX;
    return m;
}

static void files_come_back(void **state)
{
    (void)state;
    char path[64], error[256] = "";
    snprintf(path, sizeof path, "test_machine_%d.json", (int)getpid());
    const machine written = some_machine();
    machine found;
    assert_int_equal(machine_write(&written, path, error, sizeof error), 0);
    assert_int_equal(machine_read(&found, path, error, sizeof error), 0);
    assert_memory_equal(&found.prices, &written.prices, sizeof found.prices);
    assert_int_equal(found.threads, 3);
    assert_string_equal(found.cpu, "avx2");
    unlink(path);
    assert_int_equal(machine_read(&found, path, error, sizeof error), -1);
    assert_non_null(strstr(error, path));
    assert_int_equal(machine_write(&written, "absent/m.json", error, sizeof error), -1);
}

/* Writes the text of a valid file with one part replaced. */
static void text_with(const char *instead, const char *by, char *text, size_t bytes)
{
    size_t length = (size_t)snprintf(text, bytes,
                                     "{\"trim3r_machine\": 1, \"bits_epoch\": %d, \"threads\": 1, "
                                     "\"cpu_used\": \"none\", \"picoseconds\": {",
                                     T3R_BITS_EPOCH);
    for (int work = 0; work < T3R_WORK_COUNT; work++) {
        length += (size_t)snprintf(text + length, bytes - length, "%s\"%s\": 5", work > 0 ? ", " : "",
                                   t3r_work_name((t3r_work)work));
    }
    snprintf(text + length, bytes - length, "}}");
    char *at = instead != NULL ? strstr(text, instead) : NULL;
    if (at != NULL) {
        char behind[4096];
        snprintf(behind, sizeof behind, "%s", at + strlen(instead));
        snprintf(at, bytes - (size_t)(at - text), "%s%s", by, behind);
    }
}

static void refuses_foreign_files(void **state)
{
    (void)state;
    char text[4096], error[256];
    machine m;
    text_with(NULL, NULL, text, sizeof text);
    assert_int_equal(machine_parse(&m, text, strlen(text), error, sizeof error), 0);
    assert_int_equal(m.prices.milli[T3R_WORK_LABELS], 5);
    const struct {
        const char *instead, *by, *why;
    } bad[] = {
        {"{", "[", "not JSON"},
        {"trim3r_machine", "machine", "not a file"},
        {"\"trim3r_machine\": 1", "\"trim3r_machine\": 2", "trim3r_machine"},
        {"\"bits_epoch\": ", "\"bits_epoch\": 9", "bits epoch 9"},
        {"\"threads\": 1", "\"threads\": 0", "threads"},
        {"\"threads\": 1", "\"threads\": 1.5", "threads"},
        {"\"none\"", "7", "cpu_used"},
        {"picoseconds", "prices", "picoseconds"},
        {"\"image\": 5", "\"image\": -1", "image"},
        {"\"image\": 5", "\"image\": 4294967296", "image"},
        {"\"image\": 5", "\"image\": 1e999", "image"},
        {"\"image\": 5", "\"image\": null", "image"},
        {"\"image\": 5, ", "", "image"},
        {"\"image\": 5", "\"image\": 5, \"more\": 5", "more"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        error[0] = '\0';
        text_with(bad[i].instead, bad[i].by, text, sizeof text);
        assert_int_equal(machine_parse(&m, text, strlen(text), error, sizeof error), -1);
        if (strstr(error, bad[i].why) == NULL) {
            fail_msg("%s for %s: %s", bad[i].by, bad[i].instead, error);
        }
    }
}

static void fits_find_the_prices(void **state)
{
    (void)state;
    price_fit fit = {.kinds = 3, .times = 6};
    const double wanted[3] = {2e-9, 0, 3e-6};
    for (uint32_t i = 0; i < fit.times; i++) {
        fit.units[i][0] = 1e5 * (1 + i);
        fit.units[i][1] = 1e4 * (1 + i * i % 5);
        fit.units[i][2] = 10 * (1 + i % 3);
        for (uint32_t k = 0; k < 3; k++) {
            fit.seconds[i] += fit.units[i][k] * wanted[k];
        }
    }
    double found[PRICE_FIT_KINDS];
    assert_true(price_fit_solve(&fit, found) < 1e-6);
    for (uint32_t k = 0; k < 3; k++) {
        assert_true(fabs(found[k] - wanted[k]) < 1e-12 + 1e-4 * wanted[k]);
    }
    /* no price is below 0, and the remaining error is reported */
    fit = (price_fit){.kinds = 1, .times = 2, .units = {{1}, {1}}, .seconds = {1, 4}};
    assert_true(price_fit_solve(&fit, found) > 0.3 && found[0] > 1 && found[0] < 4);
    fit = (price_fit){.kinds = 2, .times = 2, .units = {{1, 1}, {1, 2}}, .seconds = {2, 1}};
    (void)price_fit_solve(&fit, found);
    assert_true(found[0] >= 0 && found[1] >= 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(files_come_back), cmocka_unit_test(refuses_foreign_files),
                                       cmocka_unit_test(fits_find_the_prices)};
    return cmocka_run_group_tests_name("machine", tests, NULL, NULL);
}
