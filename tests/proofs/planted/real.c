/* SPDX-License-Identifier: Apache-2.0 */
int planted_real(int a, int b);

int planted_real(int a, int b)
{
    return (int)((float)a * 0.3f + (float)b);
}
