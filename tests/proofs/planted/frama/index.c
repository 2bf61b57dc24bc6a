/* SPDX-License-Identifier: Apache-2.0 */
/* Planted: an index behind an array's end. */
static const int table[4] = {1, 2, 3, 4};

int main(void)
{
    return table[t3r_any(0, 4)];
}
