/* SPDX-License-Identifier: Apache-2.0 */
#include "import/poses/intrinsics.h"

#include <stdbool.h>
#include <string.h>

#include "cli/options/option_values.h"

uint32_t intrinsics_of_text(const char *text, double numbers[INTRINSICS_NUMBERS])
{
    memset(numbers, 0, INTRINSICS_NUMBERS * sizeof *numbers);
    const uint32_t count = numbers_of_text(text, numbers, INTRINSICS_NUMBERS);
    const bool known = count == 4 || count == 8 || count == 9 || count == INTRINSICS_NUMBERS;
    return known && numbers[0] > 0 && numbers[1] > 0 ? count : 0;
}
