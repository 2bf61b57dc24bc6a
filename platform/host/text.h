/* Text inside a file's bytes: counted, not terminated, not trusted to be UTF-8. */
#ifndef T3R_PLATFORM_TEXT_H
#define T3R_PLATFORM_TEXT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct t3r_text {
    const char *chars;
    size_t count;
} t3r_text;

/* A terminated string as a text. */
t3r_text t3r_text_of(const char *string);
bool t3r_text_is(t3r_text text, const char *literal);
bool t3r_text_same(t3r_text a, t3r_text b);

/* Text of others is data: a terminal, a page or a table must not obey it. Clean text is UTF-8 without control
 * characters (C0, DEL, C1, line separators, changes of direction). */
bool t3r_text_is_clean(t3r_text text);
/* Bytes of the clean character at the front, 0 where there is none. */
size_t t3r_text_character(t3r_text text);
/* Makes a string clean in its place: each byte of what may not stand there becomes '?'. */
void t3r_text_clean(char *text);
/* Copies what fits, whole characters alone, cleans and terminates it; room > 0. */
void t3r_text_copy(char *out, size_t room, t3r_text text);

#endif
