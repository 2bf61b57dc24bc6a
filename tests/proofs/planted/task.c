/* SPDX-License-Identifier: Apache-2.0 */
void t3r_planted(void (*each)(void (*task)(int), int), int n);
void planted_fill(int n);

static void planted_task(int n)
{
    planted_fill(n);
}

void t3r_planted(void (*each)(void (*task)(int), int), int n)
{
    each(planted_task, n);
}
