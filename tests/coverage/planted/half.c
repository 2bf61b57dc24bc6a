/* SPDX-License-Identifier: Apache-2.0 */
/* One way out of a condition is never taken, and a condition never evaluated: the counting must find both. */
static int half(int number)
{
    if (number < 0) {
        return number < -100 ? -2 : -1;
    }
    return 1;
}

int main(void)
{
    return half(7) - 1;
}
