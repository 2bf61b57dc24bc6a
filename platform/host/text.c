/* SPDX-License-Identifier: Apache-2.0 */
#include "text.h"

#include <string.h>

t3r_text t3r_text_of(const char *string)
{
    return (t3r_text){string, strlen(string)};
}

bool t3r_text_is(t3r_text text, const char *literal)
{
    return text.count == strlen(literal) && memcmp(text.chars, literal, text.count) == 0;
}

bool t3r_text_same(t3r_text a, t3r_text b)
{
    return a.count == b.count && memcmp(a.chars, b.chars, a.count) == 0;
}

size_t t3r_text_mark(t3r_text text)
{
    static const char mark[] = "\xEF\xBB\xBF";
    const size_t count = sizeof mark - 1;
    return text.count >= count && memcmp(text.chars, mark, count) == 0 ? count : 0;
}

/* Returns the bytes of the UTF-8 sequence at the front of s; 0 for an invalid one (overlong forms and surrogates
 * included). */
static size_t sequence_bytes(const unsigned char *s, size_t count)
{
    if (s[0] < 0x80) {
        return 1;
    }
    size_t length = s[0] >= 0xf0 ? 4 : s[0] >= 0xe0 ? 3 : 2;
    if (s[0] < 0xc2 || s[0] > 0xf4 || length > count) {
        return 0;
    }
    for (size_t i = 1; i < length; i++) {
        if ((s[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    bool wrong = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xed && s[1] > 0x9f) || (s[0] == 0xf0 && s[1] < 0x90) ||
                 (s[0] == 0xf4 && s[1] > 0x8f);
    return wrong ? 0 : length;
}

/* Whether a character is U+0000..1F, U+007F..9F, or one of the separators and direction marks U+2028..202E and
 * U+2066..2069, which reorder a line. */
static bool is_control(const unsigned char *s, size_t length)
{
    if (length == 1) {
        return s[0] < 0x20 || s[0] == 0x7f;
    }
    return (length == 2 && s[0] == 0xc2 && s[1] < 0xa0) ||
           (length == 3 && s[0] == 0xe2 &&
            ((s[1] == 0x80 && s[2] >= 0xa8 && s[2] <= 0xae) || (s[1] == 0x81 && s[2] >= 0xa6 && s[2] <= 0xa9)));
}

size_t t3r_text_character(t3r_text text)
{
    const unsigned char *s = (const unsigned char *)text.chars;
    const size_t length = text.count > 0 ? sequence_bytes(s, text.count) : 0;
    return length > 0 && !is_control(s, length) ? length : 0;
}

bool t3r_text_is_clean(t3r_text text)
{
    for (size_t at = 0, length; at < text.count; at += length) {
        length = t3r_text_character((t3r_text){text.chars + at, text.count - at});
        if (length == 0) {
            return false;
        }
    }
    return true;
}

void t3r_text_clean(char *text)
{
    unsigned char *s = (unsigned char *)text;
    for (size_t at = 0, count = strlen(text); at < count;) {
        size_t length = sequence_bytes(s + at, count - at);
        if (length == 0 || is_control(s + at, length)) {
            length = length == 0 ? 1 : length;
            memset(s + at, '?', length);
        }
        at += length;
    }
}

void t3r_text_copy(char *out, size_t room, t3r_text text)
{
    const unsigned char *s = (const unsigned char *)text.chars;
    size_t count = 0;
    for (size_t length; count < text.count && count + 1 < room; count += length) {
        length = sequence_bytes(s + count, text.count - count);
        length = length == 0 ? 1 : length;
        if (count + length >= room) {
            break; /* only whole sequences */
        }
        memcpy(out + count, s + count, length);
        out[count] = out[count] != '\0' ? out[count] : '?'; /* a zero would end the copy */
    }
    out[count] = '\0';
    t3r_text_clean(out);
}
