/* SPDX-License-Identifier: Apache-2.0 */
/* One of two files that call each other. */
int odd(unsigned n);
int even(unsigned n);
int even(unsigned n)
{
    return n == 0 ? 1 : odd(n - 1);
}
