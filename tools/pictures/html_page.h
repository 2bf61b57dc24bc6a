/* One self-contained HTML page of pictures and a table: nothing is fetched, pictures are embedded, texts escaped. It
 * follows the reader's light or dark setting, and a switch turns pictures into maps of their error.
 *
 * Calls are in the order of the page; html_page_write() reports an earlier failure. */
#ifndef TRIM3R_TOOLS_HTML_PAGE_H
#define TRIM3R_TOOLS_HTML_PAGE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct html_page html_page;

/* Returns NULL without memory. */
html_page *html_page_new(const char *title, const char *introduction);

/* Adds a table above the sections; cells of its first row are headings. `note` is printed above it unless empty.
 * `folded`: opens at a click. */
void html_page_table(html_page *page, const char *heading, const char *note, int folded);
void html_page_table_cell(html_page *page, const char *text);
void html_page_table_end_row(html_page *page);

/* Adds a section about one reference picture (RGB, rows without gaps), with which `compared` pictures are compared. */
void html_page_section(html_page *page, const char *heading, uint32_t width, uint32_t height, const uint8_t *reference);
/* Starts a new line of pictures within the section. */
void html_page_strip(html_page *page, const char *heading);
/* Adds a picture. channels: 3 = RGB, 1 = grey. */
void html_page_picture(html_page *page, const char *caption, uint32_t width, uint32_t height, uint32_t channels,
                       const uint8_t *samples, int compared);

/* Writes the page. Returns 0, or -1 when memory ran out earlier; the caller must check `out` for write errors. */
int html_page_write(html_page *page, FILE *out);
void html_page_free(html_page *page);

#endif
