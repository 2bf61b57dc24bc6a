/* SPDX-License-Identifier: Apache-2.0 */
/* Serves one page by HTTP on loopback only. */
#ifndef TRIM3R_TOOLS_VIEWER_SERVER_H
#define TRIM3R_TOOLS_VIEWER_SERVER_H

#include <stddef.h>
#include <stdint.h>

/* Binds 127.0.0.1 at this port, 0 = any free one, which is stored in *port. Returns a descriptor, or -1 with the reason
 * in error[]. */
int server_open(uint16_t *port, char *error, size_t error_bytes);

/* Answers GET / with the page until the process ends, several clients at a time and each within a bounded time; returns
 * only when accepting fails: -1 with the reason. Requests whose Host is not this machine's loopback at this port are
 * refused, so that no other site's page can read the page. */
int server_run(int listener, uint16_t port, const char *page, size_t page_bytes, char *error, size_t error_bytes);

#endif
