/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/summary/scale_picture.h"

#include <inttypes.h>
#include <math.h>

#include "cli/text/markup.h"

/* In pixels of the picture. */
#define LEFT 52
#define TOP 34
#define WIDTH 620
#define PANEL_HEIGHT 110
#define PANEL_GAP 26
#define BOTTOM 40
#define RIGHT 20

typedef struct layout {
    double low, high; /* base-2 logarithms of the axis limits */
    double most;      /* share of Gaussians at full panel height */
} layout;

static double across(const layout *l, double scale)
{
    return LEFT + WIDTH * (log2(scale) - l->low) / (l->high - l->low);
}

static double largest_share(const scale_panel *panels, uint32_t count, const scale_bins *bins)
{
    uint32_t counts[SCALE_BINS_MOST];
    double most = 0;
    for (uint32_t i = 0; i < count; i++) {
        scale_bins_fill(bins, panels[i].scales, counts);
        for (uint32_t b = 0; b < bins->count; b++) {
            most = fmax(most, (double)counts[b] / panels[i].scales->count);
        }
    }
    return most;
}

/* Writes ticks at 1, 2, 5 times powers of ten along one edge; above three decades only at powers of ten. unit: a world
 * unit in units of the axis. */
static void write_ticks(FILE *file, const layout *l, double unit, double y, double name_y)
{
    static const double times[] = {1, 2, 5};
    int of_power = (l->high - l->low) * log10(2) > 3 ? 1 : 3;
    int first = (int)floor(log10(exp2(l->low) * unit)), last = (int)ceil(log10(exp2(l->high) * unit));
    for (int power = first; power <= last; power++) {
        for (int t = 0; t < of_power; t++) {
            double value = times[t] * pow(10, power), x = across(l, value / unit);
            if (x >= LEFT - 0.01 && x <= LEFT + WIDTH + 0.01) {
                fprintf(file, "<line class='tick' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", x, x, y,
                        y + (name_y > y ? 5 : -5));
                fprintf(file, "<text x='%.1f' y='%.1f' text-anchor='middle'>%.3g</text>\n", x, name_y, value);
            }
        }
    }
}

static void write_panel(FILE *file, const layout *l, const scale_panel *panel, const scale_bins *bins, double top,
                        double pixels)
{
    uint32_t counts[SCALE_BINS_MOST];
    double foot = top + PANEL_HEIGHT, total = panel->scales->count;
    double median = splat_scales_quantile(panel->scales, 0.5);
    scale_bins_fill(bins, panel->scales, counts);
    fprintf(file, "<line class='grid' x1='%d' x2='%d' y1='%.1f' y2='%.1f'/>\n", LEFT, LEFT + WIDTH, foot, foot);
    for (uint32_t b = 0; b < bins->count; b++) {
        double left = across(l, scale_bins_edge(bins, b)), height = counts[b] / total / l->most * PANEL_HEIGHT;
        if (counts[b] > 0) {
            fprintf(file,
                    "<rect x='%.2f' y='%.2f' width='%.2f' height='%.2f'><title>%.3g to %.3g: %.2f %%</title></rect>\n",
                    left, foot - height, across(l, scale_bins_edge(bins, b + 1)) - left, height,
                    scale_bins_edge(bins, b), scale_bins_edge(bins, b + 1), counts[b] / total * 100);
        }
    }
    double x = fmin(fmax(across(l, median), LEFT), LEFT + WIDTH);
    fprintf(file, "<line class='middle' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>\n", x, x, top, foot);
    fprintf(file, "<text class='name' x='%d' y='%.1f'>", LEFT, top - 6);
    markup_text(file, panel->name);
    fprintf(file, ": %" PRIu32 " Gaussians, median %.3g", panel->scales->count, median);
    if (pixels > 0) {
        fprintf(file, " = %.2f px", median * pixels);
    }
    fputs("</text>\n", file);
    fprintf(file, "<text x='%d' y='%.1f' text-anchor='end'>%.0f %%</text>\n", LEFT - 6, top + 10, l->most * 100);
    fprintf(file, "<text x='%d' y='%.1f' text-anchor='end'>0</text>\n", LEFT - 6, foot);
}

void scale_picture_write(FILE *file, const scale_panel *panels, uint32_t count, const scale_bins *bins, double pixels)
{
    int top = TOP + (pixels > 0 ? 34 : 0), step = PANEL_HEIGHT + PANEL_GAP;
    int foot = top + step * (int)count - PANEL_GAP;
    layout l = {.low = (double)bins->first / SCALE_BINS_AN_OCTAVE,
                .high = (double)(bins->first + (int)bins->count) / SCALE_BINS_AN_OCTAVE,
                .most = largest_share(panels, count, bins)};
    int width = LEFT + WIDTH + RIGHT, height = foot + BOTTOM;
    fprintf(file,
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %d %d' width='%d' height='%d' role='img'>\n"
            "<title>Splat scales: share of the Gaussians upwards, scale across (logarithmic)</title>\n"
            "<style>text{font:12px sans-serif;fill:#222}.name{font-weight:600}.grid{stroke:#8888;stroke-width:1}"
            ".tick{stroke:#888;stroke-width:1}.middle{stroke:#d33;stroke-width:2;stroke-dasharray:6 4}"
            "rect{fill:hsl(215 55%% 55%%);stroke:#0006;stroke-width:.5}"
            "@media(prefers-color-scheme:dark){text{fill:#ddd}.middle{stroke:#f77}}</style>\n",
            width, height, width, height);
    for (uint32_t i = 0; i < count; i++) {
        write_panel(file, &l, &panels[i], bins, top + step * (int)i, pixels);
    }
    write_ticks(file, &l, 1, foot, foot + 17);
    fprintf(file, "<text x='%d' y='%d' text-anchor='end'>scale, world units</text>\n", LEFT + WIDTH, foot + 33);
    if (pixels > 0) {
        write_ticks(file, &l, pixels, TOP - 4, TOP - 13);
        fprintf(file, "<line class='grid' x1='%d' x2='%d' y1='%d' y2='%d'/>", LEFT, LEFT + WIDTH, TOP - 4, TOP - 4);
        fprintf(file, "<text x='%d' y='%d' text-anchor='end'>pixels at the median depth</text>\n", LEFT + WIDTH,
                TOP + 10);
    }
    fputs("</svg>\n", file);
}
