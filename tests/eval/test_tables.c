/* SPDX-License-Identifier: Apache-2.0 */
/* Cells, means, CSV quoting, JSON, and the page's escaping. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/tables/csv.h"
#include "cli/tables/csv_read.h"
#include "evaluation/table.h"
#include "pictures/html_page.h"
#include "test.h"

static evaluation_row make_row(const char *scene, const char *by, double keep, double psnr, double holes)
{
    evaluation_row row = {.head = "analytic",
                          .bits = "",
                          .method = by,
                          .refine = "0",
                          .allocate = "density",
                          .depth = "sensor",
                          .wavelet = "db2",
                          .levels = "2",
                          .clusters = "300",
                          .settings = "default",
                          .picture = "1/trim3r_2.5.png",
                          .ablation = ""};
    snprintf(row.scene, sizeof row.scene, "%s", scene);
    snprintf(row.context, sizeof row.context, "0,2");
    snprintf(row.target, sizeof row.target, "1");
    for (int i = 0; i < EVALUATION_VALUE_COUNT; i++) {
        row.value[i] = NAN;
    }
    row.value[EVALUATION_KEEP] = keep;
    row.value[EVALUATION_GAUSSIANS] = 13107;
    row.value[EVALUATION_PSNR] = psnr;
    row.value[EVALUATION_HOLES] = holes;
    return row;
}

static char *csv_text(void (*write)(csv_table *table, const void *data), const void *data)
{
    char *text = NULL;
    size_t bytes = 0;
    csv_table table = {.file = open_memstream(&text, &bytes)};
    assert_non_null(table.file);
    write(&table, data);
    fclose(table.file);
    return text;
}

static void write_awkward(csv_table *table, const void *data)
{
    (void)data;
    csv_cell(table, "plain");
    csv_cell(table, "a,b");
    csv_cell(table, "say \"x\"");
    csv_cell(table, NULL);
    csv_cell(table, "");
    csv_cell(table, "two\nlines");
    csv_end_row(table);
    csv_cell(table, "next");
    csv_end_row(table);
}

static void write_unclean(csv_table *table, const void *data)
{
    (void)data;
    csv_cell(table, "\x1b[31mred");
    csv_cell(table, "tab\there");
    csv_cell(table, "half \xc3");
    csv_cell(table, "gr\xc3\xbc\xc3\x9f\x7f");
    csv_cell(table, "\xe2\x80\xae");
    csv_end_row(table);
}

TEST(test_csv_is_read_whatever_its_cells_were)
{
    char *text = csv_text(write_unclean, NULL), error[256] = "";
    assert_string_equal(text, "?[31mred,tab\there,half ?,gr\xc3\xbc\xc3\x9f?,???\n");
    csv_reader *reader = malloc(sizeof *reader);
    assert_non_null(reader);
    csv_reader_open(reader, "table", text, strlen(text));
    assert_int_equal(csv_reader_next(reader, error, sizeof error), 1);
    assert_int_equal(reader->cell_count, 5);
    free(reader);
    free(text);
}

TEST(test_csv_quotes_what_needs_it)
{
    char *text = csv_text(write_awkward, NULL);
    assert_string_equal(text, "plain,\"a,b\",\"say \"\"x\"\"\",,,\"two\nlines\"\nnext\n");
    free(text);
}

static void write_table(csv_table *table, const void *data)
{
    evaluation_csv_header(table);
    evaluation_csv_row(table, data);
}

TEST(test_columns_and_empty_cells)
{
    evaluation_row row = make_row("room", "trim3r", 2.5, 21.25, 0);
    char *text = csv_text(write_table, &row);
    assert_string_equal(
        text,
        "scene,context,target,method,head,bits,refine,allocate,depth,ablation,wavelet,levels,clusters,settings,keep,"
        "requested,"
        "gaussians,psnr_all,ssim_all,perceptual_all,psnr,ssim,sharp,holes,psnr_seen,context_psnr,perceptual,build_ms,"
        "render_ms,arena_bytes,scene_bytes,"
        "planar_psnr,loss,"
        "picture,bits_epoch\n"
        "room,\"0,2\",1,trim3r,analytic,,0,density,sensor,,db2,2,300,default,2.5,,13107,,,,21.2500,,,0.00000,,,,,,,,,,"
        "1/trim3r_2.5.png,\n");
    free(text);
    assert_null(evaluation_column_name(EVALUATION_COLUMNS));
}

TEST(test_json_of_a_row)
{
    evaluation_row row = make_row("a \"room\"", "trim3r", 10, 21.25, NAN);
    cJSON *object = evaluation_json(&row);
    char *text = cJSON_PrintUnformatted(object);
    cJSON *back = cJSON_Parse(text);
    assert_non_null(back);
    assert_string_equal(cJSON_GetObjectItem(back, "scene")->valuestring, "a \"room\"");
    assert_true(cJSON_GetObjectItem(back, "gaussians")->valuedouble == 13107);
    assert_true(cJSON_GetObjectItem(back, "psnr")->valuedouble == 21.25);
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(back, "holes")));
    assert_int_equal(cJSON_GetArraySize(back), EVALUATION_COLUMNS);
    cJSON_Delete(back);
    cJSON_free(text);
    cJSON_Delete(object);
}

TEST(test_means_group_by_settings)
{
    evaluation_row rows[] = {
        make_row("a", "trim3r", 10, 20, 0.5), make_row("a", "random", 10, 8, 0.9),
        make_row("b", "trim3r", 10, 30, NAN), make_row("b", "trim3r", 5, 18, 0.1),
        make_row("b", "random", 10, 10, 0.7),
    };
    evaluation_row means[5];
    assert_int_equal(evaluation_means(rows, 5, false, means), 3);
    assert_string_equal(means[0].method, "trim3r");
    assert_string_equal(means[0].scene, "mean");
    assert_string_equal(means[0].target, "");
    assert_true(means[0].value[EVALUATION_KEEP] == 10);
    assert_true(means[0].value[EVALUATION_PSNR] == 25);
    assert_true(means[0].value[EVALUATION_HOLES] == 0.5); /* the row without one does not count */
    assert_true(isnan(means[0].value[EVALUATION_SSIM]));
    assert_string_equal(means[1].method, "random");
    assert_true(means[1].value[EVALUATION_PSNR] == 9);
    assert_true(means[2].value[EVALUATION_KEEP] == 5);
    assert_true(means[2].value[EVALUATION_PSNR] == 18);
    assert_int_equal(evaluation_means(rows, 5, true, means), 5);
    assert_string_equal(means[2].scene, "b");
    assert_string_equal(means[2].context, "mean");
    assert_true(means[2].value[EVALUATION_PSNR] == 30);
    assert_string_equal(means[2].picture, "");
    rows[2].wavelet = "haar"; /* next to "a", db2 */
    assert_int_equal(evaluation_means(rows, 5, false, means), 4);
    rows[2].wavelet = "db2";
    rows[2].ablation = "k-5"; /* next to "a", without ablation */
    assert_int_equal(evaluation_means(rows, 5, false, means), 4);
    assert_true(means[0].value[EVALUATION_PSNR] == 20);
    assert_string_equal(means[2].ablation, "k-5");
}

TEST(test_page_escapes_and_embeds)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *out = open_memstream(&text, &bytes);
    assert_non_null(out);
    const uint8_t rgb[2 * 2 * 3] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9}, grey[4] = {0, 255, 255, 0};
    html_page *page = html_page_new("<script>", "a & b");
    assert_non_null(page);
    html_page_table(page, "t1", "", 0);
    html_page_table_cell(page, "name");
    html_page_table_end_row(page);
    html_page_table_cell(page, "\"x\" < 'y'");
    html_page_table_end_row(page);
    html_page_table(page, "t2", "", 1);
    html_page_table_cell(page, "other");
    html_page_table_end_row(page);
    html_page_section(page, "one", 2, 2, rgb);
    html_page_strip(page, "s1");
    html_page_picture(page, "caption", 2, 2, 3, rgb, 1);
    html_page_strip(page, "s2");
    html_page_picture(page, "mask", 2, 2, 1, grey, 0);
    html_page_section(page, "two", 2, 2, rgb);
    assert_int_equal(html_page_write(page, out), 0);
    assert_int_equal(fclose(out), 0);
    assert_null(strstr(text, "<script>"));
    assert_non_null(strstr(text, "<title>&lt;script&gt;</title>"));
    assert_non_null(strstr(text, "a &amp; b"));
    assert_non_null(strstr(text, "<th>name</th>"));
    assert_non_null(strstr(text, "<th>other</th>"));
    assert_non_null(strstr(text, "<details open><summary>t1<"));
    assert_non_null(strstr(text, "<details><summary>t2<"));
    assert_non_null(strstr(text, "<td>&quot;x&quot; &lt; &#39;y&#39;</td>"));
    assert_non_null(strstr(text, "prefers-color-scheme: dark"));
    /* the first bytes of every PNG, in base 64 */
    assert_non_null(strstr(text, "src=\"data:image/png;base64,iVBORw0KGgo"));
    assert_null(strstr(text, "http"));
    int open = 0, closed = 0;
    for (const char *p = text; (p = strstr(p, "<div")) != NULL; p++) {
        open++;
    }
    for (const char *p = text; (p = strstr(p, "</div>")) != NULL; p++) {
        closed++;
    }
    assert_int_equal(open, closed);
    free(text);
    html_page_free(page);
}
