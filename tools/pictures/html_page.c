/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/html_page.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/text/markup.h"
#include "pictures/png_bytes.h"

struct html_page {
    char *title, *introduction;
    char *table_text, *body_text; /* buffers of the streams */
    size_t table_bytes, body_bytes;
    FILE *table, *body;
    bool within_table, within_row, heading_done, within_section, within_strip, failed;
};

static const char head[] = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>";

static const char style[] =
    "</title>\n<style>\n"
    ":root { color-scheme: light dark; --ink: #1d2126; --quiet: #5c6672; --paper: #fbfaf8; --line: #dcd9d2;"
    " --accent: #0b6e63; }\n"
    "@media (prefers-color-scheme: dark) { :root { --ink: #e6e4df; --quiet: #9aa3ad; --paper: #16181b; --line: #33373c;"
    " --accent: #5fc9b8; } }\n"
    "* { box-sizing: border-box; }\n"
    "body { margin: 0 auto; max-width: 92rem; padding: 2.5rem clamp(1rem, 4vw, 3.5rem) 5rem; background: var(--paper);"
    " color: var(--ink); font: 1rem/1.55 system-ui, sans-serif; -webkit-text-size-adjust: 100%; }\n"
    "h1 { font-size: clamp(1.6rem, 4vw, 2rem); line-height: 1.2; letter-spacing: -.02em; margin: 0 0 .5rem; }\n"
    "h2 { font-size: 1.25rem; margin: 3rem 0 .75rem; padding-top: 1.25rem; border-top: 1px solid var(--line); }\n"
    "h3 { font-size: .9rem; font-weight: 600; color: var(--accent); margin: 1.25rem 0 .4rem; }\n"
    "p { max-width: 46rem; color: var(--quiet); margin: .25rem 0 1.25rem; }\n"
    "details { margin: 2rem 0 0; padding-top: 1.25rem; border-top: 1px solid var(--line); }\n"
    "summary { font-size: 1.25rem; font-weight: 700; cursor: pointer; padding: .4rem 0; }\n"
    ".scroll { overflow-x: auto; margin-top: .75rem; }\n"
    "table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; }\n"
    "th, td { padding: .3rem .8rem .3rem 0; text-align: left; white-space: nowrap;"
    " border-bottom: 1px solid var(--line); }\n"
    "th { color: var(--quiet); font-weight: 600; }\n"
    ".strip { display: grid; gap: .9rem; grid-template-columns: repeat(auto-fill, minmax(13rem, 1fr)); }\n"
    "figure { margin: 0; }\n"
    "figcaption { margin-top: .3rem; font-size: .82rem; color: var(--quiet); font-variant-numeric: tabular-nums; }\n"
    ".view { position: relative; isolation: isolate; overflow: hidden; border-radius: 4px; background: #000; }\n"
    ".view img { display: block; width: 100%; height: auto; }\n"
    ".compared::after { content: \"\"; position: absolute; inset: 0; display: none; mix-blend-mode: difference;"
    " background: var(--reference) 0 0 / 100% 100%; }\n"
    "#errors:checked ~ main .compared { filter: brightness(3); }\n"
    "#errors:checked ~ main .compared::after { display: block; }\n"
    "#errors { position: fixed; opacity: 0; }\n"
    "label { position: fixed; right: 1rem; bottom: 1rem; z-index: 2; display: flex; align-items: center; min-height: "
    "2.75rem;"
    " padding: 0 1rem; border: 1px solid var(--line); border-radius: 7px; background: var(--paper); user-select: none;"
    " cursor: pointer; }\n"
    "#errors:checked + label { border-color: var(--accent); background: var(--accent); color: var(--paper); }\n"
    "#errors:focus-visible + label { outline: 2px solid var(--accent); outline-offset: 2px; }\n"
    "@media (max-width: 34rem) { body { padding-top: 1.2rem; } h2 { margin-top: 2rem; }"
    " table { font-size: .8125rem; } th, td { padding-right: .5rem; } .strip { gap: .7rem; grid-template-columns: 1fr "
    "1fr; } }\n"
    "</style>\n</head>\n<body>\n";

/* Writes "data:image/png;base64,...". */
static void write_picture(html_page *page, uint32_t width, uint32_t height, uint32_t channels, const uint8_t *samples)
{
    size_t count;
    uint8_t *bytes = png_bytes(width, height, channels, samples, &count);
    if (bytes == NULL) {
        page->failed = true;
        return;
    }
    fputs("data:image/png;base64,", page->body);
    markup_base64(page->body, bytes, count);
    free(bytes);
}

html_page *html_page_new(const char *title, const char *introduction)
{
    html_page *page = calloc(1, sizeof *page);
    if (page == NULL) {
        return NULL;
    }
    page->title = strdup(title);
    page->introduction = strdup(introduction);
    page->table = open_memstream(&page->table_text, &page->table_bytes);
    page->body = open_memstream(&page->body_text, &page->body_bytes);
    if (page->title == NULL || page->introduction == NULL || page->table == NULL || page->body == NULL) {
        html_page_free(page);
        return NULL;
    }
    return page;
}

static void end_table(html_page *page)
{
    if (page->within_table) {
        fputs("</table></div></details>\n", page->table);
        page->within_table = false;
    }
}

void html_page_table(html_page *page, const char *heading, const char *note, int folded)
{
    end_table(page);
    fprintf(page->table, "<details%s><summary>", folded ? "" : " open");
    markup_text(page->table, heading);
    fputs("</summary>\n", page->table);
    if (note[0] != '\0') {
        fputs("<p>", page->table);
        markup_text(page->table, note);
        fputs("</p>\n", page->table);
    }
    fputs("<div class=\"scroll\"><table>\n", page->table);
    page->within_table = true;
    page->heading_done = false;
}

void html_page_table_cell(html_page *page, const char *text)
{
    const char *kind = page->heading_done ? "td" : "th";
    if (!page->within_row) {
        fputs("<tr>", page->table);
        page->within_row = true;
    }
    fprintf(page->table, "<%s>", kind);
    markup_text(page->table, text);
    fprintf(page->table, "</%s>", kind);
}

void html_page_table_end_row(html_page *page)
{
    fputs("</tr>\n", page->table);
    page->within_row = false;
    page->heading_done = true;
}

static void end_strip(html_page *page)
{
    if (page->within_strip) {
        fputs("</div>\n", page->body);
        page->within_strip = false;
    }
}

static void end_section(html_page *page)
{
    end_strip(page);
    if (page->within_section) {
        fputs("</section>\n", page->body);
        page->within_section = false;
    }
}

void html_page_section(html_page *page, const char *heading, uint32_t width, uint32_t height, const uint8_t *reference)
{
    end_section(page);
    fputs("<section style=\"--reference: url(", page->body);
    write_picture(page, width, height, 3, reference);
    fputs(")\">\n<h2>", page->body);
    markup_text(page->body, heading);
    fputs("</h2>\n", page->body);
    page->within_section = true;
}

void html_page_strip(html_page *page, const char *heading)
{
    end_strip(page);
    fputs("<h3>", page->body);
    markup_text(page->body, heading);
    fputs("</h3>\n<div class=\"strip\">\n", page->body);
    page->within_strip = true;
}

void html_page_picture(html_page *page, const char *caption, uint32_t width, uint32_t height, uint32_t channels,
                       const uint8_t *samples, int compared)
{
    fprintf(page->body, "<figure><div class=\"view%s\"><img loading=\"lazy\" width=\"%u\" height=\"%u\" alt=\"",
            compared ? " compared" : "", (unsigned)width, (unsigned)height);
    markup_text(page->body, caption);
    fputs("\" src=\"", page->body);
    write_picture(page, width, height, channels, samples);
    fputs("\"></div><figcaption>", page->body);
    markup_text(page->body, caption);
    fputs("</figcaption></figure>\n", page->body);
}

static void write_page(html_page *page, FILE *out)
{
    fputs(head, out);
    markup_text(out, page->title);
    fputs(style, out);
    fputs("<h1>", out);
    markup_text(out, page->title);
    fputs("</h1>\n<p>", out);
    markup_text(out, page->introduction);
    fputs(" Errors are differences from the target, three times as bright.</p>\n"
          "<input type=\"checkbox\" id=\"errors\"><label for=\"errors\">Show errors</label>\n<main>\n",
          out);
    fwrite(page->table_text, 1, page->table_bytes, out);
    fwrite(page->body_text, 1, page->body_bytes, out);
    fputs("</main>\n</body>\n</html>\n", out);
}

int html_page_write(html_page *page, FILE *out)
{
    end_table(page);
    end_section(page);
    if (fflush(page->table) != 0 || fflush(page->body) != 0 || ferror(page->table) || ferror(page->body) ||
        page->failed) {
        return -1;
    }
    write_page(page, out);
    return 0;
}

void html_page_free(html_page *page)
{
    if (page == NULL) {
        return;
    }
    if (page->table != NULL) {
        fclose(page->table);
    }
    if (page->body != NULL) {
        fclose(page->body);
    }
    free(page->table_text);
    free(page->body_text);
    free(page->introduction);
    free(page->title);
    free(page);
}
