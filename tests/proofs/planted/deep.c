/* SPDX-License-Identifier: Apache-2.0 */
void planted_fill(unsigned char *bytes, unsigned n);
unsigned t3r_planted(unsigned n);

unsigned t3r_planted(unsigned n)
{
    unsigned char bytes[14 * 1024]; /* and the return address: just over the higher limit */
    planted_fill(bytes, n);
    return bytes[n];
}
