/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r, the product alone. */
#include <stddef.h>

#include "trim3r/front.h"

int main(int argc, char **argv)
{
    return trim3r_main(argc, argv, NULL);
}
