/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/page.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "cli/text/markup.h"
#include "study/chart/svg.h"

/* Embedded by the build: page.html with the marks <!--style-->, <!--svg-->, <!--data--> and <!--script-->. */
extern const char chart_page_html[], chart_page_css[], chart_page_js[];

/* More spreads would make the page slow. Above this limit the page offers only the view of all scenes together. */
#define SPREADS_MOST 60000u

typedef struct page {
    FILE *out;
    const chart_points *points;
    const chart_names *names;
    const chart_pictures *pictures;
    bool scenes; /* each can be chosen */
} page;

/* ---- JSON within a script element ------------------------------------------------------------------------------ */

static void json_text(FILE *out, const char *text)
{
    fputc('"', out);
    for (const unsigned char *p = (const unsigned char *)text; *p != '\0'; p++) {
        if (*p < 0x20 || *p == '"' || *p == '\\' || *p == '<') { /* '<': no end of the script element */
            fprintf(out, "\\u%04x", *p);
        } else {
            fputc(*p, out);
        }
    }
    fputc('"', out);
}

static void json_number(FILE *out, double value)
{
    if (isnan(value)) {
        fputs("null", out);
    } else {
        fprintf(out, "%.7g", value);
    }
}

static void json_picture(FILE *out, uint32_t number)
{
    if (number == CHART_NO_PICTURE) {
        fputs("null", out);
    } else {
        fprintf(out, "%u", (unsigned)number);
    }
}

static const char *comma(bool first)
{
    return first ? "" : ",";
}

/* ---- the parts of the data ------------------------------------------------------------------------------------- */

static void write_measures(const page *p)
{
    static const char *const units[] = {"", "dB", "ms", "bytes"};
    fputs("\"measures\":[", p->out);
    for (int m = 0; m < CHART_MEASURES; m++) {
        const chart_measure_about *about = &chart_measures[m];
        fprintf(p->out,
                "%s{\"key\":\"%s\",\"title\":\"%s\",\"unit\":\"%s\",\"decimals\":%d,\"less\":%s,\"quality\":%s,"
                "\"cost\":%s}",
                comma(m == 0), about->column, about->title, units[about->unit], about->decimals,
                about->less_is_better ? "true" : "false", m < CHART_QUALITIES ? "true" : "false",
                m >= CHART_QUALITIES && m < CHART_COSTS_END ? "true" : "false");
    }
    fprintf(p->out, "],\"gaussians\":%d,\n\"shapes\":[", CHART_GAUSSIANS);
    for (uint32_t s = 0; s < CHART_SHAPES; s++) {
        fprintf(p->out, "%s\"%s\"", comma(s == 0), chart_shapes[s]);
    }
    fputs("],\n", p->out);
}

static void write_series(const page *p)
{
    fputs("\"series\":[", p->out);
    for (uint32_t s = 0; s < p->points->series_count; s++) {
        const chart_series *series = &p->points->series[s];
        fprintf(p->out, "%s{\"name\":", comma(s == 0));
        json_text(p->out, p->names->series[s].text);
        fprintf(p->out, ",\"colour\":%u,\"shape\":%u,\"points\":[", (unsigned)p->names->series[s].colour,
                (unsigned)p->names->series[s].shape);
        for (uint32_t i = 0; i < series->point_count; i++) {
            fprintf(p->out, "%s%u", comma(i == 0), (unsigned)(series->first_point + i));
        }
        fputs("]}", p->out);
    }
    fputs("],\n", p->out);
}

static void write_cases(const page *p)
{
    const chart_table *table = p->points->table;
    fputs("\"scenes\":[", p->out);
    for (uint32_t s = 0; s < table->scenes.count; s++) {
        fputs(comma(s == 0), p->out);
        json_text(p->out, table->scenes.text[s]);
    }
    fputs("],\n\"cases\":[", p->out);
    for (uint32_t c = 0; c < table->case_keys.count; c++) {
        const chart_case *it = &table->cases[c];
        char name[512] = "";
        if (table->texts.text[it->target][0] != '\0') {
            snprintf(name, sizeof name, "frame %.100s from %.300s", table->texts.text[it->target],
                     table->texts.text[it->context]);
        }
        fprintf(p->out, "%s{\"scene\":%u,\"name\":", comma(c == 0), (unsigned)it->scene);
        json_text(p->out, name);
        fputc('}', p->out);
    }
    fputs("],\n", p->out);
}

static void write_cell(const page *p, uint32_t index)
{
    const chart_cell *cell = &p->points->cells[index];
    const chart_shots *shots = &p->pictures->of_cell[index];
    fprintf(p->out, "[%u,", (unsigned)cell->scene_case);
    json_picture(p->out, shots->render);
    fputc(',', p->out);
    json_picture(p->out, shots->target);
    fputc(',', p->out);
    json_picture(p->out, shots->mask);
    for (int m = 0; m < CHART_MEASURES; m++) {
        fputc(',', p->out);
        json_number(p->out, cell->value[m]);
    }
    fputc(']', p->out);
}

static void write_points(const page *p)
{
    fputs("\"points\":[", p->out);
    for (uint32_t i = 0; i < p->points->count; i++) {
        const chart_point *point = &p->points->points[i];
        char text[CHART_NAME_BYTES];
        bool first = true;
        chart_setting_text(p->points, i, CHART_KEEP, text, sizeof text);
        fprintf(p->out, "%s\n{\"series\":%u,\"keep\":", comma(i == 0), (unsigned)point->series);
        json_text(p->out, text);
        fputs(",\"settings\":[", p->out);
        for (int s = 0; s < CHART_KEEP; s++) {
            chart_setting_text(p->points, i, (chart_setting)s, text, sizeof text);
            if (text[0] != '\0') {
                fputs(comma(first), p->out);
                json_text(p->out, text);
                first = false;
            }
        }
        fputs("],\"cells\":[", p->out);
        for (uint32_t c = 0; c < point->cell_count; c++) {
            fputs(comma(c == 0), p->out);
            write_cell(p, point->first_cell + c);
        }
        fputs("]}", p->out);
    }
    fputs("],\n", p->out);
}

static void write_axis(const page *p, const char *name, const chart_axis *axis)
{
    fprintf(p->out, "\"%s\":{\"low\":%.9g,\"high\":%.9g,\"log\":%s,\"falling\":%s,\"ticks\":[", name, axis->low,
            axis->high, axis->logarithmic ? "true" : "false", axis->falling ? "true" : "false");
    for (uint32_t t = 0; t < axis->tick_count; t++) {
        fprintf(p->out, "%s[%.9g,\"%s\"]", comma(t == 0), axis->tick[t].value, axis->tick[t].label);
    }
    fputs("]}", p->out);
}

/* Axes and complete points of each quality against each cost. */
static int write_pairs(const page *p, uint32_t scene)
{
    bool first = true;
    fputs(",\"pairs\":{", p->out);
    for (int q = 0; q < CHART_QUALITIES; q++) {
        for (int c = CHART_QUALITIES; c < CHART_COSTS_END; c++) {
            chart_view view;
            if (chart_view_make(&view, p->points, (chart_choice){(chart_measure)q, (chart_measure)c, scene}) != 0) {
                return -1;
            }
            if (view.shown > 0) {
                bool none = true;
                fprintf(p->out, "%s\n\"%d:%d\":{", comma(first), q, c);
                write_axis(p, "x", &view.x);
                fputc(',', p->out);
                write_axis(p, "y", &view.y);
                fprintf(p->out, ",\"cases\":%u,\"complete\":[", (unsigned)view.cases);
                for (uint32_t i = 0; i < p->points->count; i++) {
                    if (view.spots[i].complete) {
                        fprintf(p->out, "%s%u", comma(none), (unsigned)i);
                        none = false;
                    }
                }
                fputs("]}", p->out);
                first = false;
            }
            chart_view_free(&view);
        }
    }
    fputc('}', p->out);
    return 0;
}

static int write_choice(const page *p, uint32_t scene)
{
    fputs("\n{\"scene\":", p->out);
    if (scene == CHART_ALL_SCENES) {
        fputs("null", p->out);
    } else {
        fprintf(p->out, "%u", (unsigned)scene);
    }
    fputs(",\"spreads\":[", p->out);
    for (uint32_t i = 0; i < p->points->count; i++) {
        fprintf(p->out, "%s[", comma(i == 0));
        for (int m = 0; m < CHART_MEASURES; m++) {
            chart_spread s = chart_points_spread(p->points, i, (chart_measure)m, scene);
            if (s.cases == 0) {
                fprintf(p->out, "%snull", comma(m == 0));
            } else {
                fprintf(p->out, "%s[%.7g,%.7g,%.7g,%.7g,%u]", comma(m == 0), s.mean, s.low, s.median, s.high,
                        (unsigned)s.cases);
            }
        }
        fputc(']', p->out);
    }
    fputc(']', p->out);
    int failed = write_pairs(p, scene);
    fputc('}', p->out);
    return failed;
}

static int write_choices(const page *p)
{
    uint32_t scenes = p->scenes ? p->points->table->scenes.count : 0;
    fputs("\"choices\":[", p->out);
    int failed = write_choice(p, CHART_ALL_SCENES);
    for (uint32_t s = 0; s < scenes && failed == 0; s++) {
        fputc(',', p->out);
        failed = write_choice(p, s);
    }
    fputs("]\n", p->out);
    return failed;
}

static void write_texts(const page *p, const chart_view *first)
{
    const chart_table *table = p->points->table;
    uint32_t start = p->scenes && first->choice.scene != CHART_ALL_SCENES ? first->choice.scene + 1 : 0;
    char about[2 * CHART_NAME_BYTES], left_out[256] = "";
    snprintf(about, sizeof about, "%u point%s, %u case%s of %u scene%s%s%s.", (unsigned)p->points->count,
             p->points->count == 1 ? "" : "s", (unsigned)table->case_keys.count, table->case_keys.count == 1 ? "" : "s",
             (unsigned)table->scenes.count, table->scenes.count == 1 ? "" : "s",
             p->names->common[0] != '\0' ? "; unless named, " : "", p->names->common);
    if (p->pictures->left_out + p->pictures->missing > 0) {
        snprintf(left_out, sizeof left_out,
                 "Of the pictures, %u are left out because the report would be too large, and %u were not found.",
                 (unsigned)p->pictures->left_out, (unsigned)p->pictures->missing);
    }
    fprintf(p->out, "{\"start\":{\"choice\":%u,\"quality\":%d,\"cost\":%d},\n\"about\":", (unsigned)start,
            (int)first->choice.quality, (int)first->choice.cost);
    json_text(p->out, about);
    fputs(",\"leftOut\":", p->out);
    json_text(p->out, left_out);
    fputs(",\n", p->out);
}

static int write_data(const page *p, const chart_view *first)
{
    fputs("<script type=\"application/json\" id=\"data\">\n", p->out);
    write_texts(p, first);
    write_measures(p);
    write_series(p);
    write_cases(p);
    write_points(p);
    int failed = write_choices(p);
    fputs("}\n</script>\n", p->out);
    for (uint32_t i = 0; i < p->pictures->count; i++) {
        fprintf(p->out, "<script type=\"text/plain\" id=\"p%u\">", (unsigned)i);
        markup_base64(p->out, p->pictures->pictures[i].png, p->pictures->pictures[i].bytes);
        fputs("</script>\n", p->out);
    }
    return failed;
}

/* ---- the page -------------------------------------------------------------------------------------------------- */

static void write_ground(FILE *out, const char *const colours[CHART_COLOURS], const char *rest)
{
    fputs(rest, out);
    for (uint32_t c = 0; c < CHART_COLOURS; c++) {
        fprintf(out, "--c%u:%s;", (unsigned)c, colours[c]);
    }
}

/* Light, dark, and what the reader has set unless the page's button says otherwise. */
static void write_style(FILE *out)
{
    static const char light[] = "color-scheme:light;--paper:#fbfaf8;--raised:#fff;--ink:#1d2126;--quiet:#5c6672;"
                                "--line:#dcd9d2;--grid:#e9e6df;--accent:#0a7568;",
                      dark[] = "color-scheme:dark;--paper:#16181b;--raised:#1e2125;--ink:#e6e4df;--quiet:#9aa3ad;"
                               "--line:#363b41;--grid:#2a2e33;--accent:#53d6c1;";
    fputs("\n:root{", out);
    write_ground(out, chart_colours_light, light);
    fputs("}\n@media(prefers-color-scheme:dark){:root:not([data-theme=light]){", out);
    write_ground(out, chart_colours_dark, dark);
    fputs("}}\n:root[data-theme=dark]{", out);
    write_ground(out, chart_colours_dark, dark);
    fputs("}\n", out);
    fputs(chart_page_css, out);
}

/* Writes the template up to the mark and returns the text after the mark. */
static const char *up_to(FILE *out, const char *from, const char *mark)
{
    const char *at = strstr(from, mark);
    fwrite(from, 1, (size_t)(at - from), out);
    return at + strlen(mark);
}

int chart_page_write(FILE *out, const chart_points *points, const chart_names *names, const chart_pictures *pictures,
                     const chart_view *first)
{
    uint32_t scenes = points->table->scenes.count;
    page p = {.out = out, .points = points, .names = names, .pictures = pictures};
    p.scenes = scenes > 1 && (uint64_t)scenes * points->count <= SPREADS_MOST;
    const char *rest = up_to(out, chart_page_html, "<!--style-->");
    write_style(out);
    rest = up_to(out, rest, "<!--svg-->");
    chart_svg_write(out, points, names, first, 1, CHART_GROUND_READER);
    rest = up_to(out, rest, "<!--data-->");
    int failed = write_data(&p, first);
    rest = up_to(out, rest, "<!--script-->\n");
    fputs(chart_page_js, out);
    fputs(rest, out);
    return failed;
}
