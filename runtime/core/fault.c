/* SPDX-License-Identifier: Apache-2.0 */
#include "fault.h"

void t3r_note(t3r_fault *fault, const char *text, int64_t first, int64_t second, int64_t third, int64_t fourth)
{
    *fault = (t3r_fault){.text = text, .number = {first, second, third, fourth}};
}
