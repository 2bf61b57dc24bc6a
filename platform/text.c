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

/* Bytes of the UTF-8 sequence at the front of s, 0 when there is none (overlong forms and surrogates included). */
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

void t3r_text_copy(char *out, size_t room, t3r_text text)
{
    const unsigned char *s = (const unsigned char *)text.chars;
    size_t at = 0; /* the whole sequences that fit and are UTF-8 end here */
    bool utf8 = true;
    while (utf8 && at < text.count) {
        size_t length = sequence_bytes(s + at, text.count - at);
        if (length > 0 && at + length >= room) {
            break;
        }
        utf8 = length > 0;
        at += length;
    }
    size_t count = utf8 ? at : text.count < room - 1 ? text.count : room - 1;
    for (size_t i = 0; i < count; i++) {
        bool safe = s[i] >= 0x20 && s[i] != 0x7f && (utf8 || s[i] < 0x80);
        out[i] = safe ? (char)s[i] : '?';
    }
    out[count] = '\0';
}
