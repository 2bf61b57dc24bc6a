/* SPDX-License-Identifier: Apache-2.0 */
/* An example of a firmware's debug build: failed assertions are counted. */
#ifndef T3R_NOTED_ASSERT_H
#define T3R_NOTED_ASSERT_H

void noted_assertion(void);
#define T3R_ASSERT(condition) ((condition) ? (void)0 : noted_assertion())

#endif
