/* SPDX-License-Identifier: Apache-2.0 */
/* Included by what stands above: no offence. */
