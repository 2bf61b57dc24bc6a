/* SPDX-License-Identifier: Apache-2.0 */
/* The number of the line planted by CMakeLists.txt that is wrong in this run, from T3R_PLANTED; 0 = none. */
#include <stdlib.h>

extern unsigned t3r_planted;
unsigned t3r_planted;

int LLVMFuzzerInitialize(int *count, char ***arguments);

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    (void)count;
    (void)arguments;
    const char *number = getenv("T3R_PLANTED");
    t3r_planted = number == NULL ? 0 : (unsigned)strtoul(number, NULL, 10);
    return 0;
}
