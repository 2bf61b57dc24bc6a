/* SPDX-License-Identifier: Apache-2.0 */
/* Planted: a shift by 32. */
int main(void)
{
    const uint32_t shift = (uint32_t)t3r_any(0, 32);
    return (int)(1u << shift);
}
