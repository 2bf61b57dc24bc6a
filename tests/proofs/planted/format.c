/* SPDX-License-Identifier: Apache-2.0 */
/* Not by the repository's .clang-format. */
int planted( int x ){ return x; }
