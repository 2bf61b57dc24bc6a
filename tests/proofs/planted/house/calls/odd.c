/* SPDX-License-Identifier: Apache-2.0 */
/* The other one. */
int even(unsigned n);
int odd(unsigned n);
int odd(unsigned n)
{
    return n == 0 ? 0 : even(n - 1);
}
