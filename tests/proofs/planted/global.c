/* SPDX-License-Identifier: Apache-2.0 */
int planted_next(void);

int planted_next(void)
{
    static int calls;
    return ++calls;
}
