/* SPDX-License-Identifier: Apache-2.0 */
/* Planted: a division by zero. */
int main(void)
{
    const int d = (int)t3r_any(0, 10);
    return 100 / d;
}
