/* SPDX-License-Identifier: Apache-2.0 */
/* Serves a page and its data by HTTP on loopback only. */
#ifndef TRIM3R_TOOLS_VIEWER_SERVER_H
#define TRIM3R_TOOLS_VIEWER_SERVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Binds 127.0.0.1 at this port, 0 = any free one, which is stored in *port. Returns a descriptor, or -1 with the reason
 * in error[]. */
int server_open(uint16_t *port, char *error, size_t error_bytes);

typedef struct server_answer {
    const char *type; /* a MIME type; NULL = nothing is found at the path */
    char *body;
    size_t bytes;
    bool owned; /* the body is on the heap, and freed once it is sent */
} server_answer;

/* Answers GET and HEAD by `find`, which gets the path with its query, until the process ends, several clients at a time
 * and each within a bounded time; returns only when accepting fails: -1 with the reason. Requests whose Host is not
 * this machine's loopback at this port are refused, so that no other site's page can read the answers. */
int server_run(int listener, uint16_t port, server_answer (*find)(void *user, const char *path), void *user,
               char *error, size_t error_bytes);

#endif
