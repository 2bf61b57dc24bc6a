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

/* Copies what fits and terminates it; room > 0. Control characters become '?', and so does every byte over 127
 * of a text that is not UTF-8: the copy is safe to print and to put into JSON. */
void t3r_text_copy(char *out, size_t room, t3r_text text);

#endif
