#include "fixed_text.h"

int t3r_q40_from_text(t3r_text text, uint64_t *value_q40)
{
    uint64_t whole = 0;
    size_t i = 0;
    for (; i < text.count && text.chars[i] >= '0' && text.chars[i] <= '9'; i++) {
        whole = whole * 10 + (uint64_t)(text.chars[i] - '0');
        if (whole >> 24 != 0) {
            return -1;
        }
    }
    if (i == 0) {
        return -1;
    }
    uint64_t part = 0, unit = 1; /* the fraction is part / unit, unit = 10^digits <= 10^18 */
    if (i < text.count) {
        size_t point = i++;
        if (text.chars[point] != '.' || i == text.count || text.count - i > 18) {
            return -1;
        }
        for (; i < text.count; i++) {
            if (text.chars[i] < '0' || text.chars[i] > '9') {
                return -1;
            }
            part = part * 10 + (uint64_t)(text.chars[i] - '0');
            unit *= 10;
        }
    }
    uint64_t value = whole;
    for (uint32_t bit = 0; bit < 40; bit++) { /* long division: part < unit < 2^60 throughout */
        part *= 2;
        value = value << 1 | (part >= unit);
        part -= part >= unit ? unit : 0;
    }
    value += part * 2 > unit || (part * 2 == unit && (value & 1) != 0);
    *value_q40 = value;
    return 0;
}

/* Writes a value as decimal digits; returns their number. */
static uint32_t digits(uint64_t value, char *out)
{
    char reversed[20];
    uint32_t count = 0;
    do {
        reversed[count++] = (char)('0' + value % 10);
        value /= 10;
    } while (value != 0);
    for (uint32_t i = 0; i < count; i++) {
        out[i] = reversed[count - 1 - i];
    }
    return count;
}

void t3r_q40_to_text(uint64_t value_q40, char text[T3R_Q40_TEXT_BYTES])
{
    const uint64_t mask = ((uint64_t)1 << 40) - 1;
    uint64_t rest = value_q40 & mask; /* remainder after the digits so far, in Q40 of the last digit */
    uint64_t shown = 0, unit = 1;     /* the fraction so far is shown / unit */
    /* Cut after 13 places, the value is off by less than 2^-43, so it reads back. */
    for (uint32_t places = 0; places <= 13; places++) {
        for (uint64_t up = 0; up <= 1; up++) {
            uint64_t whole = (value_q40 >> 40) + (shown + up) / unit;
            uint32_t length = digits(whole, text);
            if (places > 0) {
                text[length++] = '.';
                uint64_t fraction = (shown + up) % unit;
                for (uint64_t place = unit / 10; place > 0; place /= 10) {
                    text[length++] = (char)('0' + fraction / place % 10);
                }
            }
            text[length] = '\0';
            uint64_t back;
            if (t3r_q40_from_text((t3r_text){text, length}, &back) == 0 && back == value_q40) {
                return;
            }
        }
        rest *= 10;
        shown = shown * 10 + (rest >> 40);
        rest &= mask;
        unit *= 10;
    }
}
