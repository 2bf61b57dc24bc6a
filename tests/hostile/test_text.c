/* SPDX-License-Identifier: Apache-2.0 */
/* Foreign text: which characters are replaced and which are kept, and that reasons and messages are cleaned. */
#include <stdlib.h>
#include <string.h>

#include "host/reason.h"
#include "host/text.h"
#include "test.h"

static const struct {
    const char *given, *cleaned;
} texts[] = {
    {"", ""},
    {"plain /path_0.png", "plain /path_0.png"},
    {"Gr\xc3\xb6\xc3\x9f"
     "e \xe2\x82\xac \xf0\x9f\x98\x80",
     "Gr\xc3\xb6\xc3\x9f"
     "e \xe2\x82\xac \xf0\x9f\x98\x80"},
    {"\x1b]0;owned\x07", "?]0;owned?"},
    {"a\nb\tc\r\x7f", "a?b?c??"},
    {"c1 \xc2\x9b"
     "31m",
     "c1 ??31m"},
    {"no break \xc2\xa0", "no break \xc2\xa0"},
    {"\xff\xfe raw \x9b", "?? raw ?"},
    {"cut \xe2\x82", "cut ??"},
    {"overlong \xc0\x9b", "overlong ??"},
    {"surrogate \xed\xa0\x80", "surrogate ???"},
    {"turned \xe2\x80\xae"
     "gpj.exe",
     "turned ???gpj.exe"},
    {"line \xe2\x80\xa8 isolate \xe2\x81\xa6", "line ??? isolate ???"},
};

TEST(controls_and_broken_characters_become_question_marks)
{
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        char text[64], copy[64];
        strcpy(text, texts[i].given);
        assert_int_equal(t3r_text_is_clean(t3r_text_of(text)), strcmp(texts[i].given, texts[i].cleaned) == 0);
        t3r_text_clean(text);
        assert_string_equal(text, texts[i].cleaned);
        assert_true(t3r_text_is_clean(t3r_text_of(text)));
        t3r_text_copy(copy, sizeof copy, t3r_text_of(texts[i].given));
        assert_string_equal(copy, texts[i].cleaned);
    }
}

TEST(copies_hold_whole_characters_of_counted_text)
{
    char copy[8];
    t3r_text_copy(copy, sizeof copy, (t3r_text){"a\0b", 3});
    assert_string_equal(copy, "a?b");
    t3r_text_copy(copy, 6, t3r_text_of("ab\xe2\x82\xac\xe2\x82\xac"));
    assert_string_equal(copy, "ab\xe2\x82\xac");
    t3r_text_copy(copy, 5, t3r_text_of("ab\xe2\x82\xac"));
    assert_string_equal(copy, "ab");
    t3r_text_copy(copy, 1, t3r_text_of("ab"));
    assert_string_equal(copy, "");
}

TEST(reasons_are_clean_and_cut_to_fit)
{
    char reason[12];
    assert_int_equal(t3r_reason(reason, sizeof reason, "%s: %s", "\x1b[2J", "gone"), -1);
    assert_string_equal(reason, "?[2J: gone");
    t3r_reason(reason, 6, "abcd\xe2\x82\xac");
    assert_string_equal(reason, "abcd?");
    assert_int_equal(t3r_reason(NULL, 0, "nobody asks"), -1);
}
