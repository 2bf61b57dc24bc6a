/* SPDX-License-Identifier: Apache-2.0 */
unsigned planted_odd(unsigned n);
unsigned planted_even(unsigned n);
unsigned t3r_planted(unsigned n);

__attribute__((noinline)) unsigned planted_even(unsigned n)
{
    return n == 0 ? 1u : planted_odd(n - 1) + 1u;
}

__attribute__((noinline)) unsigned planted_odd(unsigned n)
{
    return n == 0 ? 0u : planted_even(n - 1) * 3u;
}

unsigned t3r_planted(unsigned n)
{
    return planted_even(n);
}
