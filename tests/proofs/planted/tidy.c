/* SPDX-License-Identifier: Apache-2.0 */
/* Reads what is known to be nowhere. */
int first_of(const int *numbers);

int first_of(const int *numbers)
{
    if (numbers == 0) {
        return numbers[0];
    }
    return 0;
}
