/* SPDX-License-Identifier: Apache-2.0 */
void planted_fill(unsigned char *bytes, unsigned n);
unsigned t3r_planted(unsigned n);

unsigned t3r_planted(unsigned n)
{
    unsigned char bytes[n + 1];
    planted_fill(bytes, n);
    return bytes[0];
}
