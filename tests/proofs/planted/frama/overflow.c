/* SPDX-License-Identifier: Apache-2.0 */
/* Planted: a sum that leaves 32 bits. */
int main(void)
{
    const int x = (int)t3r_any(0, INT32_MAX);
    return x + 1;
}
