/* SPDX-License-Identifier: Apache-2.0 */
/* Planted: no alarm, but what follows is never reached, and so not looked at. */
int main(void)
{
    while (1) {
    }
    return 0;
}
