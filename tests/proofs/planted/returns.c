/* SPDX-License-Identifier: Apache-2.0 */
/* Two ways out: a departure from a rule of MISRA C:2012 that the runtime departs from, too. */
int planted_sign(int number);

int planted_sign(int number)
{
    if (number < 0) {
        return -1;
    }
    return 1;
}
