/* SPDX-License-Identifier: Apache-2.0 */
/* Planted: a product that leaves 64 bits without a sign. */
int main(void)
{
    const uint64_t side = t3r_any_unsigned(0, UINT64_C(1) << 32);
    return side * side > 0;
}
