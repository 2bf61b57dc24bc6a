/* One self-contained HTML page of pictures and a table: nothing is fetched, pictures are embedded, texts escaped.
 * It follows the reader's light or dark setting, and a switch turns pictures into maps of their error.
 *
 * Calls come in the order of the page; a failure is kept and told by html_page_write(). */
#ifndef TRIM3R_TOOLS_HTML_PAGE_H
#define TRIM3R_TOOLS_HTML_PAGE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct html_page html_page;

/* NULL without memory. */
html_page *html_page_new(const char *title, const char *introduction);

/* A table above the sections; cells of its first row are headings. `note` stands above it unless it is empty.
 * `folded`: opens at a click. */
void html_page_table(html_page *page, const char *heading, const char *note, int folded);
void html_page_table_cell(html_page *page, const char *text);
void html_page_table_end_row(html_page *page);

/* A section about one reference picture (RGB, rows without gaps), which `compared` pictures are held against. */
void html_page_section(html_page *page, const char *heading, uint32_t width, uint32_t height, const uint8_t *reference);
/* A new line of pictures within the section. */
void html_page_strip(html_page *page, const char *heading);
/* channels: 3 = RGB, 1 = grey. */
void html_page_picture(html_page *page, const char *caption, uint32_t width, uint32_t height, uint32_t channels,
                       const uint8_t *samples, int compared);

/* 0, or -1 when memory ran out on the way; whether `out` took it all is the caller's to ask. */
int html_page_write(html_page *page, FILE *out);
void html_page_free(html_page *page);

#endif
