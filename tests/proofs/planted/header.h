/* SPDX-License-Identifier: Apache-2.0 */
/* Does not say where size_t comes from. */
size_t planted_header(void);
