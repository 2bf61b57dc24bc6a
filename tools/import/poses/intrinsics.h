/* SPDX-License-Identifier: Apache-2.0 */
/* Intrinsics that a user gives, the same for all commands. */
#ifndef TRIM3R_TOOLS_INTRINSICS_H
#define TRIM3R_TOOLS_INTRINSICS_H

#include <stdint.h>

#define INTRINSICS_NUMBERS 12u /* fx fy cx cy, and k1 k2 p1 p2 k3 k4 k5 k6 of OpenCV */
#define INTRINSICS_FORM "fx,fy,cx,cy[,k1,k2,p1,p2[,k3[,k4,k5,k6]]]"

/* Parses INTRINSICS_FORM, with focal lengths above 0; numbers that are not given become 0. Returns how many are given;
 * 0: the text has another form. */
uint32_t intrinsics_of_text(const char *text, double numbers[INTRINSICS_NUMBERS]);

#endif
