/* SPDX-License-Identifier: Apache-2.0 */
/* Tables of any origin: what is read, and what is refused with its line. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/csv_read.h"
#include "test.h"

static csv_reader reader;

static void expect_row(uint32_t line, uint32_t cells, const char *const *texts)
{
    char error[256] = "";
    assert_int_equal(csv_reader_next(&reader, error, sizeof error), 1);
    assert_int_equal(reader.line, line);
    assert_int_equal(reader.cell_count, cells);
    for (uint32_t i = 0; i < cells; i++) {
        assert_string_equal(reader.cell[i], texts[i]);
    }
}

static void expect_end(void)
{
    char error[256] = "";
    assert_int_equal(csv_reader_next(&reader, error, sizeof error), 0);
    assert_int_equal(csv_reader_next(&reader, error, sizeof error), 0);
}

static void open_text(const char *text)
{
    csv_reader_open(&reader, "t.csv", text, strlen(text));
}

TEST(test_cells)
{
    open_text("\xEF\xBB\xBF"
              "a,b,\r\n\n\"x,\"\"y\"\"\",\"two\nlines\",\xC3\xA9\n,,\n\"\"\nlast");
    expect_row(1, 3, (const char *const[]){"a", "b", ""});
    expect_row(3, 3, (const char *const[]){"x,\"y\"", "two\nlines", "\xC3\xA9"});
    expect_row(5, 3, (const char *const[]){"", "", ""});
    expect_row(6, 1, (const char *const[]){""});
    expect_row(7, 1, (const char *const[]){"last"});
    expect_end();
    open_text("");
    expect_end();
    open_text("\n\r\n\n");
    expect_end();
    open_text("a,");
    expect_row(1, 2, (const char *const[]){"a", ""});
    expect_end();
}

static void refuse(const char *text, size_t bytes, const char *why)
{
    char error[256] = "";
    int got;
    csv_reader_open(&reader, "t.csv", text, bytes);
    while ((got = csv_reader_next(&reader, error, sizeof error)) == 1) {
    }
    assert_int_equal(got, -1);
    assert_string_equal(error, why);
}

TEST(test_refusals)
{
    refuse("a\n\"b", 4, "t.csv:2: a quote that is not closed");
    refuse("a\n\n\"b\nc\"d", 9, "t.csv:3: text after a quoted cell");
    refuse("\"b\" ,", 5, "t.csv:1: text after a quoted cell");
    refuse("ab\"c", 4, "t.csv:1: a quote within a cell that did not begin with one");
    refuse("a\0b", 3, "t.csv:1: a control character");
    refuse("\"a\0b\"", 5, "t.csv:1: a control character");
    refuse("a\rb", 3, "t.csv:1: a control character");
    static const char *const not_utf8[] = {
        "\x80",     "\xC3",     "\xC0\x80",    "\xE0\x80\x80", "\xED\xA0\x80", "\xF5\x80\x80\x80", "\xF4\x90\x80\x80",
        "\xE2\x82", "\xC2\x85", "\xE2\x80\xAE"};
    for (size_t i = 0; i < sizeof not_utf8 / sizeof not_utf8[0]; i++) {
        refuse(not_utf8[i], strlen(not_utf8[i]), "t.csv:1: bytes that are no printable UTF-8");
    }
}

TEST(test_bounds)
{
    char *text = malloc(CSV_ROW_BYTES_MOST + 1), error[256];
    assert_non_null(text);
    memset(text, 'x', CSV_ROW_BYTES_MOST + 1);
    csv_reader_open(&reader, "t.csv", text, CSV_ROW_BYTES_MOST - 1);
    assert_int_equal(csv_reader_next(&reader, error, sizeof error), 1);
    assert_int_equal(strlen(reader.cell[0]), CSV_ROW_BYTES_MOST - 1);
    refuse(text, CSV_ROW_BYTES_MOST, "t.csv:1: a row of more than 16384 bytes");
    memset(text, ',', CSV_COLUMNS_MOST);
    csv_reader_open(&reader, "t.csv", text, CSV_COLUMNS_MOST - 1);
    assert_int_equal(csv_reader_next(&reader, error, sizeof error), 1);
    assert_int_equal(reader.cell_count, CSV_COLUMNS_MOST);
    refuse(text, CSV_COLUMNS_MOST, "t.csv:1: more than 256 cells in a row");
    free(text);
}

TEST(test_numbers)
{
    double value;
    bool given;
    static const char *const none[] = {"x",    "1x", " 1", "1 ",  "0x10", "inf", "-inf",   "1e999",
                                       "1e16", "-",  ".",  "1,5", "--1",  "1e",  "nan(1)", "infinity"};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        assert_int_equal(csv_number(none[i], &value, &given), -1);
    }
    static const char *const missing[] = {"", "nan", "NaN", "NAN"};
    for (size_t i = 0; i < sizeof missing / sizeof missing[0]; i++) {
        assert_int_equal(csv_number(missing[i], &value, &given), 0);
        assert_false(given);
        assert_true(isnan(value));
    }
    assert_int_equal(csv_number("-2.5e1", &value, &given), 0);
    assert_true(given && value == -25);
    assert_int_equal(csv_number("1e-320", &value, &given), 0); /* tiny is a number */
}
