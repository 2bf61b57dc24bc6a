#include "pictures/plan_picture.h"

#include <stdint.h>

/* In pixels of the picture. */
#define LEFT 74
#define TOP 24
#define COLUMN 84
#define GRAPH_HEIGHT 420
#define LEGEND_WIDTH 290
#define LEGEND_ROW 20

/* Returns hues a golden angle apart, so that neighbours in the table differ. */
static int hue(uint32_t index)
{
    return (int)((uint64_t)index * 13751 / 100 % 360);
}

static double height_of(const t3r_plan_info *plan, size_t bytes)
{
    return plan->bytes == 0 ? 0 : (double)bytes / (double)plan->bytes * GRAPH_HEIGHT;
}

static void write_axis(FILE *file, const t3r_plan_info *plan)
{
    for (int part = 0; part <= 4; part++) {
        double y = TOP + GRAPH_HEIGHT * (1 - part / 4.0);
        fprintf(file, "<line class='grid' x1='%d' x2='%d' y1='%.1f' y2='%.1f'/>", LEFT, LEFT + COLUMN * T3R_STAGE_COUNT,
                y, y);
        fprintf(file, "<text x='%d' y='%.1f' text-anchor='end'>%.2f MiB</text>\n", LEFT - 6, y + 4,
                (double)plan->bytes * part / 4 / 1048576);
    }
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        fprintf(file, "<text x='%d' y='%d' text-anchor='middle'>%s</text>\n", LEFT + COLUMN * stage + COLUMN / 2,
                TOP + GRAPH_HEIGHT + 18, t3r_stage_name((t3r_stage)stage));
    }
    double least = TOP + GRAPH_HEIGHT - height_of(plan, plan->min_bytes);
    fprintf(file,
            "<line class='least' x1='%d' x2='%d' y1='%.1f' y2='%.1f'><title>least arena: %zu bytes</title></line>\n",
            LEFT, LEFT + COLUMN * T3R_STAGE_COUNT, least, least, plan->min_bytes);
}

static void write_buffer(FILE *file, const t3r_plan_info *plan, uint32_t index)
{
    const t3r_plan_buffer *b = &plan->buffers[index];
    double height = height_of(plan, b->bytes), bottom = TOP + GRAPH_HEIGHT - height_of(plan, b->offset);
    int x = LEFT + COLUMN * (int)b->first, width = COLUMN * ((int)b->last - (int)b->first + 1);
    fprintf(file,
            "<rect x='%d' y='%.2f' width='%d' height='%.2f' fill='hsl(%d 55%% 55%%)'><title>%s: %zu bytes, %s to %s"
            "</title></rect>\n",
            x, bottom - height, width, height < 0.5 ? 0.5 : height, hue(index), b->name, b->bytes,
            t3r_stage_name(b->first), t3r_stage_name(b->last));
    if (height >= 14 && width >= 2 * COLUMN) {
        fprintf(file, "<text class='on' x='%d' y='%.1f' text-anchor='middle'>%s</text>\n", x + width / 2,
                bottom - height / 2 + 4, b->name);
    }
}

static void write_legend(FILE *file, const t3r_plan_info *plan)
{
    int x = LEFT + COLUMN * T3R_STAGE_COUNT + 20, y = TOP + 6;
    for (uint32_t i = 0; i < plan->buffer_count; i++) {
        if (plan->buffers[i].bytes == 0) {
            continue;
        }
        fprintf(file,
                "<rect x='%d' y='%d' width='12' height='12' fill='hsl(%d 55%% 55%%)'/>"
                "<text x='%d' y='%d'>%s, %.1f KiB</text>\n",
                x, y - 10, hue(i), x + 18, y, plan->buffers[i].name, (double)plan->buffers[i].bytes / 1024);
        y += LEGEND_ROW;
    }
    fprintf(file,
            "<line class='least' x1='%d' x2='%d' y1='%d' y2='%d'/><text x='%d' y='%d'>least arena, %.2f MiB</text>\n",
            x, x + 12, y - 4, y - 4, x + 18, y, (double)plan->min_bytes / 1048576);
}

void plan_picture_write(FILE *file, const t3r_plan_info *plan)
{
    int width = LEFT + COLUMN * T3R_STAGE_COUNT + LEGEND_WIDTH, height = TOP + GRAPH_HEIGHT + 32;
    fprintf(file,
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %d %d' width='%d' height='%d' role='img'>\n"
            "<title>Arena of %zu bytes: stages across, bytes upwards</title>\n"
            "<style>text{font:12px sans-serif;fill:#222}.on{fill:#111}.grid{stroke:#8888;stroke-width:1}"
            ".least{stroke:#d33;stroke-width:2;stroke-dasharray:6 4}rect{stroke:#0006;stroke-width:.5}"
            "@media(prefers-color-scheme:dark){text{fill:#ddd}.on{fill:#111}.least{stroke:#f77}}</style>\n",
            width, height, width, height, plan->bytes);
    write_axis(file, plan);
    for (uint32_t i = 0; i < plan->buffer_count; i++) {
        if (plan->buffers[i].bytes > 0) {
            write_buffer(file, plan, i);
        }
    }
    write_legend(file, plan);
    fputs("</svg>\n", file);
}
