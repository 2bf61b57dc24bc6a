/* SPDX-License-Identifier: Apache-2.0 */
/* Text inside a file's bytes: counted, not terminated, and not necessarily UTF-8. */
#ifndef T3R_PLATFORM_TEXT_H
#define T3R_PLATFORM_TEXT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct t3r_text {
    const char *chars;
    size_t count;
} t3r_text;

/* Returns a terminated string as a text. */
t3r_text t3r_text_of(const char *string);
bool t3r_text_is(t3r_text text, const char *literal);
bool t3r_text_same(t3r_text a, t3r_text b);

/* Returns the bytes of a byte order mark of UTF-8 at the front, 3; or 0. */
size_t t3r_text_mark(t3r_text text);

/* Whether a text is clean: UTF-8 without control characters (C0, DEL, C1, line separators, direction marks). Text from
 * files is data that a terminal, a page or a table must not obey. */
bool t3r_text_is_clean(t3r_text text);
/* Returns the bytes of the clean character at the front; 0 if there is none. */
size_t t3r_text_character(t3r_text text);
/* Cleans a string in place: each unclean byte becomes '?'. */
void t3r_text_clean(char *text);
/* Copies the whole characters that fit, then cleans and terminates the copy; room > 0. */
void t3r_text_copy(char *out, size_t room, t3r_text text);

#endif
