/* SPDX-License-Identifier: Apache-2.0 */
#include "study/chart/svg.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "cli/text/markup.h"

/* Pixels. */
#define WIDTH 1040.0
#define EDGE 28.0
#define HEADER 74.0
#define PANEL_LEFT 74.0 /* margin within a panel, for the labels of ticks */
#define PANEL_TOP 30.0
#define PANEL_RIGHT 14.0
#define PANEL_BOTTOM 46.0
#define HEIGHT_ALONE 560.0
#define HEIGHT_OF_SEVERAL 390.0
#define LEGEND_ROW 24.0
#define CHARACTER 6.9   /* mean width of a character at 13 pixels */
#define LABEL_ROOM 34.0 /* width of a budget's label */
#define RADIUS 4.6
#define RING 8.5
#define WHISKER_CASES 4u /* fewer have no quartiles worth drawing */

typedef struct panel {
    double left, top, right, bottom; /* the plot area */
    double label_x, label_y;         /* position of the front's last label */
} panel;

/* ---- style ----------------------------------------------------------------------------------------------------- */

static void write_colours(FILE *out, const char *const colours[CHART_COLOURS], const char *paper, const char *ink,
                          const char *quiet, const char *grid)
{
    fprintf(out, ".paper{fill:%s}text{fill:%s}.quiet{fill:%s}.grid{stroke:%s}.front{stroke:%s}.ring{stroke:%s}", paper,
            ink, quiet, grid, ink, ink);
    for (uint32_t c = 0; c < CHART_COLOURS; c++) {
        fprintf(out, ".c%u{fill:%s}.l%u{stroke:%s}", (unsigned)c, colours[c], (unsigned)c, colours[c]);
    }
}

static void write_style(FILE *out, chart_ground ground)
{
    fputs("<style>text{font:13px system-ui,sans-serif}.title{font-size:21px;font-weight:700}.small{font-size:12px}"
          ".name{font-weight:600}.grid{stroke-width:1}.front{fill:none;stroke-width:1.5;stroke-opacity:.55}"
          ".ring{fill:none;stroke-width:1.6}.line{fill:none;stroke-width:1.4;stroke-opacity:.4}"
          ".whisker{fill:none;stroke-width:1.3;stroke-opacity:.4}.part{fill-opacity:.25}",
          out);
    if (ground != CHART_GROUND_DARK) {
        write_colours(out, chart_colours_light, "#fbfaf8", "#1d2126", "#5c6672", "#e4e1da");
    }
    if (ground != CHART_GROUND_LIGHT) {
        fputs(ground == CHART_GROUND_READER ? "@media(prefers-color-scheme:dark){" : "", out);
        write_colours(out, chart_colours_dark, "#16181b", "#e6e4df", "#9aa3ad", "#2b2f34");
        fputs(ground == CHART_GROUND_READER ? "}" : "", out);
    }
    fputs("</style>\n", out);
}

/* ---- a panel --------------------------------------------------------------------------------------------------- */

static double clamp(double share)
{
    return fmin(fmax(share, 0), 1);
}

static double at_x(const panel *p, const chart_view *view, double value)
{
    return p->left + clamp(chart_axis_place(&view->x, value)) * (p->right - p->left);
}

static double at_y(const panel *p, const chart_view *view, double value)
{
    double share = clamp(chart_axis_place(&view->y, value));
    return view->y.falling ? p->top + share * (p->bottom - p->top) : p->bottom - share * (p->bottom - p->top);
}

static void write_axes(FILE *out, const panel *p, const chart_view *view)
{
    const chart_measure_about *cost = &chart_measures[view->choice.cost],
                              *quality = &chart_measures[view->choice.quality];
    for (uint32_t i = 0; i < view->y.tick_count; i++) {
        double y = at_y(p, view, view->y.tick[i].value);
        fprintf(out,
                "<path class='grid' d='M%.1f,%.1fH%.1f'/><text class='quiet small' x='%.1f' y='%.1f' "
                "text-anchor='end'>%s</text>\n",
                p->left, y, p->right, p->left - 8, y + 4, view->y.tick[i].label);
    }
    for (uint32_t i = 0; i < view->x.tick_count; i++) {
        double x = at_x(p, view, view->x.tick[i].value);
        fprintf(out,
                "<path class='grid' d='M%.1f,%.1fV%.1f'/><text class='quiet small' x='%.1f' y='%.1f' "
                "text-anchor='middle'>%s</text>\n",
                x, p->top, p->bottom, x, p->bottom + 18, view->x.tick[i].label);
    }
    fprintf(out, "<text class='name' x='%.1f' y='%.1f'>%s%s</text>", p->left - PANEL_LEFT, p->top - 14, quality->title,
            quality->less_is_better ? ", less is better" : "");
    fprintf(out, "<text class='name' x='%.1f' y='%.1f' text-anchor='end'>%s</text>\n", p->right, p->bottom + 38,
            cost->title);
}

/* Writes the front as steps; everything above it is better than any measured point. */
static void write_front(FILE *out, const panel *p, const chart_view *view)
{
    if (view->front_count == 0) {
        return;
    }
    fputs("<path class='front' d='", out);
    for (uint32_t i = 0; i < view->front_count; i++) {
        const chart_spot *spot = &view->spots[view->front[i]];
        double x = at_x(p, view, spot->cost.mean), y = at_y(p, view, spot->quality.mean);
        if (i == 0) {
            fprintf(out, "M%.1f,%.1fV%.1f", x, p->bottom, y);
        } else {
            fprintf(out, "H%.1fV%.1f", x, y);
        }
    }
    fprintf(out, "H%.1f'/>\n", p->right);
}

static void write_line(FILE *out, const panel *p, const chart_view *view, const chart_series *series, uint32_t colour)
{
    const char *command = "M";
    uint32_t shown = 0;
    for (uint32_t i = 0; i < series->point_count; i++) {
        shown += view->spots[series->first_point + i].shown;
    }
    if (shown < 2) {
        return;
    }
    fprintf(out, "<path class='line l%u' d='", (unsigned)colour);
    for (uint32_t i = 0; i < series->point_count; i++) {
        const chart_spot *spot = &view->spots[series->first_point + i];
        if (spot->shown) {
            fprintf(out, "%s%.1f,%.1f", command, at_x(p, view, spot->cost.mean), at_y(p, view, spot->quality.mean));
            command = "L";
        }
    }
    fputs("'/>\n", out);
}

static void write_spread(FILE *out, const panel *p, const chart_view *view, const chart_spot *spot, uint32_t colour)
{
    bool time = chart_measures[view->choice.cost].unit == CHART_MILLISECONDS;
    if (time && spot->cost.cases >= WHISKER_CASES) {
        double y = at_y(p, view, spot->quality.mean), middle = at_x(p, view, spot->cost.median);
        fprintf(out, "<path class='whisker l%u' d='M%.1f,%.1fH%.1fM%.1f,%.1fv7'/>", (unsigned)colour,
                at_x(p, view, spot->cost.low), y, at_x(p, view, spot->cost.high), middle, y - 3.5);
    }
}

static void write_about(FILE *out, const chart_points *points, const chart_view *view, uint32_t point, const char *name)
{
    char keep[CHART_NAME_BYTES], cost[CHART_LABEL_BYTES], quality[CHART_LABEL_BYTES];
    const chart_spot *spot = &view->spots[point];
    chart_setting_text(points, point, CHART_KEEP, keep, sizeof keep);
    chart_value_text(view->choice.cost, spot->cost.mean, cost, sizeof cost);
    chart_value_text(view->choice.quality, spot->quality.mean, quality, sizeof quality);
    fputs("<title>", out);
    markup_text(out, name);
    fputs(keep[0] != '\0' ? ", " : "", out);
    markup_text(out, keep);
    fprintf(out, ": %s, %s%s</title>", quality, cost, spot->front ? ", on the front" : "");
}

/* Writes a budget's label left of the front and above it, where no point can be; at the left edge of the plot to the
 * right and below. */
static void write_budget(FILE *out, panel *p, const chart_points *points, const chart_view *view, uint32_t point)
{
    const char *budget = points->table->texts.text[points->points[point].setting[CHART_KEEP]];
    const chart_spot *spot = &view->spots[point];
    double x = at_x(p, view, spot->cost.mean) - 8, y = at_y(p, view, spot->quality.mean) - 9;
    bool at_edge = x - LABEL_ROOM < p->left;
    if (at_edge) {
        x += 18;
        y += 26;
    }
    bool crowded = fabs(x - p->label_x) < LABEL_ROOM && fabs(y - p->label_y) < 14;
    if (budget[0] == '\0' || crowded) {
        return;
    }
    p->label_x = x;
    p->label_y = y;
    fprintf(out, "<text class='quiet small' x='%.1f' y='%.1f' text-anchor='%s'>", x, y, at_edge ? "start" : "end");
    markup_text(out, budget);
    fprintf(out, "%s</text>\n", isdigit((unsigned char)budget[strlen(budget) - 1]) ? " %" : "");
}

static void write_spot(FILE *out, panel *p, const chart_points *points, const chart_view *view, uint32_t point,
                       const chart_name *name)
{
    const chart_spot *spot = &view->spots[point];
    double x = at_x(p, view, spot->cost.mean), y = at_y(p, view, spot->quality.mean);
    fputs("<g>", out);
    write_about(out, points, view, point, name->text);
    write_spread(out, p, view, spot, name->colour);
    fprintf(out, "<path class='c%u%s' transform='translate(%.1f %.1f) scale(%.1f)' d='%s'/>", (unsigned)name->colour,
            spot->complete ? "" : " part", x, y, RADIUS, chart_shapes[name->shape]);
    if (spot->front) {
        fprintf(out, "<circle class='ring' cx='%.1f' cy='%.1f' r='%.1f'/>", x, y, RING);
    }
    fputs("</g>\n", out);
}

static void write_panel(FILE *out, panel *p, const chart_points *points, const chart_names *names,
                        const chart_view *view)
{
    write_axes(out, p, view);
    write_front(out, p, view);
    for (uint32_t s = points->series_count; s-- > 0;) {
        const chart_series *series = &points->series[s];
        write_line(out, p, view, series, names->series[s].colour);
        for (uint32_t i = 0; i < series->point_count; i++) {
            if (view->spots[series->first_point + i].shown) {
                write_spot(out, p, points, view, series->first_point + i, &names->series[s]);
            }
        }
    }
    for (uint32_t i = 0; i < view->front_count; i++) {
        write_budget(out, p, points, view, view->front[i]);
    }
}

/* ---- the picture ----------------------------------------------------------------------------------------------- */

/* Returns a text's width in pixels, estimated from its characters. */
static double text_width(const char *text)
{
    double characters = 0;
    for (const char *c = text; *c != '\0'; c++) {
        characters += ((unsigned char)*c & 0xC0) != 0x80;
    }
    return characters * CHARACTER;
}

static bool has_spots(const chart_points *points, const chart_view *views, uint32_t count, uint32_t series)
{
    for (uint32_t v = 0; v < count; v++) {
        for (uint32_t i = 0; i < points->series[series].point_count; i++) {
            if (views[v].spots[points->series[series].first_point + i].shown) {
                return true;
            }
        }
    }
    return false;
}

/* Writes the legend in columns as wide as the longest name, or only measures it with out = NULL. Returns the height. */
static double write_legend(FILE *out, const chart_points *points, const chart_names *names, const chart_view *views,
                           uint32_t count, double top)
{
    double wide = 0;
    for (uint32_t s = 0; s < points->series_count; s++) {
        if (has_spots(points, views, count, s)) {
            wide = fmax(wide, 20 + text_width(names->series[s].text) + 24);
        }
    }
    uint32_t columns = (uint32_t)fmax(1, floor((WIDTH - 2 * EDGE) / wide)), place = 0;
    for (uint32_t s = 0; s < points->series_count; s++) {
        const chart_name *name = &names->series[s];
        double x = EDGE + place % columns * wide, y = top + 14 + place / columns * LEGEND_ROW;
        if (!has_spots(points, views, count, s)) {
            continue;
        }
        if (out != NULL) {
            fprintf(out, "<path class='c%u' transform='translate(%.1f %.1f) scale(%.1f)' d='%s'/>",
                    (unsigned)name->colour, x + 7, y - 4.5, RADIUS + 0.6, chart_shapes[name->shape]);
            fprintf(out, "<text x='%.1f' y='%.1f'>", x + 20, y);
            markup_text(out, name->text);
            fputs("</text>\n", out);
        }
        place++;
    }
    return (place + columns - 1) / columns * LEGEND_ROW + 10;
}

static void write_title(FILE *out, const chart_points *points, const chart_names *names, const chart_view *views,
                        uint32_t count)
{
    const chart_choice *choice = &views[0].choice;
    fprintf(out, "<text class='title' x='%.0f' y='38'>%s against ", EDGE, chart_measures[choice->quality].title);
    for (uint32_t v = 0; v < count; v++) {
        const char *title = chart_measures[views[v].choice.cost].title;
        fprintf(out, "%s%c%s",
                v == 0           ? ""
                : v + 1 == count ? " and "
                                 : ", ",
                tolower((unsigned char)title[0]), title + 1);
    }
    fprintf(out, "</text>\n<text class='quiet' x='%.0f' y='60'>", EDGE);
    if (choice->scene != CHART_ALL_SCENES) {
        fputs("Scene ", out);
        markup_text(out, points->table->scenes.text[choice->scene]);
        fprintf(out, ", %u case%s", (unsigned)views[0].cases, views[0].cases == 1 ? "" : "s");
    } else {
        fprintf(out, "%u case%s of %u scene%s", (unsigned)views[0].cases, views[0].cases == 1 ? "" : "s",
                (unsigned)points->table->scenes.count, points->table->scenes.count == 1 ? "" : "s");
    }
    fputs(names->common[0] != '\0' ? "; unless named, " : "", out);
    markup_text(out, names->common);
    fputs(". Ringed: nothing is both cheaper and better.</text>\n", out);
}

void chart_svg_write(FILE *out, const chart_points *points, const chart_names *names, const chart_view *views,
                     uint32_t count, chart_ground ground)
{
    uint32_t columns = count > 1 ? 2 : 1, rows = (count + columns - 1) / columns;
    double wide = (WIDTH - 2 * EDGE - (columns - 1) * EDGE) / columns,
           high = count > 1 ? HEIGHT_OF_SEVERAL : HEIGHT_ALONE, legend_top = HEADER + rows * high + 6;
    double height = legend_top + write_legend(NULL, points, names, views, count, legend_top) + EDGE / 2;
    fprintf(out,
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %.0f %.0f' width='%.0f' height='%.0f' role='img'>\n"
            "<title>%s against cost</title>\n",
            WIDTH, height, WIDTH, height, chart_measures[views[0].choice.quality].title);
    write_style(out, ground);
    fprintf(out, "<rect class='paper' width='%.0f' height='%.0f' rx='%d'/>\n", WIDTH, height,
            ground == CHART_GROUND_READER ? 8 : 0);
    write_title(out, points, names, views, count);
    for (uint32_t v = 0; v < count; v++) {
        double x = EDGE + (v % columns) * (wide + EDGE), y = HEADER + (v / columns) * high;
        panel p = {.left = x + PANEL_LEFT,
                   .top = y + PANEL_TOP,
                   .right = x + wide - PANEL_RIGHT,
                   .bottom = y + high - PANEL_BOTTOM,
                   .label_x = -WIDTH,
                   .label_y = -WIDTH};
        write_panel(out, &p, points, names, &views[v]);
    }
    (void)write_legend(out, points, names, views, count, legend_top);
    fputs("</svg>\n", out);
}
