/* SPDX-License-Identifier: Apache-2.0 */
#include "viewer/server.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include "cli/cli.h"
#include "host/reason.h"

enum {
    HTTP_PORT = 80,
    REQUEST_BYTES = 8192,
    HEAD_BYTES = 512,
    CLIENTS_MOST = 16,
    ASK_SECONDS = 5,    /* for a whole request */
    ANSWER_SECONDS = 60 /* for a whole answer */
};

/* A connection: its request is read, then its answer is sent. */
typedef struct client {
    int socket; /* non-blocking */
    double until;
    size_t count; /* bytes of the request read, or of head and body sent */
    char request[REQUEST_BYTES];
    char head[HEAD_BYTES];
    size_t head_bytes; /* 0: the request is not complete */
    size_t body_bytes; /* to be sent */
    server_answer answer;
} client;

typedef struct server {
    int listener;
    uint16_t port;
    server_answer (*find)(void *user, const char *path);
    void *user;
    client clients[CLIENTS_MOST];
    uint32_t count;
} server;

int server_open(uint16_t *port, char *error, size_t error_bytes)
{
    struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_port = htons(*port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t length = sizeof address;
    const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), on = 1;
    if (listener < 0 || setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
        bind(listener, (struct sockaddr *)&address, sizeof address) != 0 || listen(listener, 8) != 0 ||
        getsockname(listener, (struct sockaddr *)&address, &length) != 0) {
        (void)t3r_reason(error, error_bytes, "127.0.0.1:%u: %s", (unsigned)*port, strerror(errno));
        if (listener >= 0) {
            close(listener);
        }
        return -1;
    }
    *port = ntohs(address.sin_port);
    return listener;
}

static bool is_own_host(const char *request, uint16_t port)
{
    static const char *const hosts[] = {"127.0.0.1", "localhost"};
    char names[2][32];
    for (int i = 0; i < 2; i++) { /* browsers leave out HTTP's own port */
        snprintf(names[i], sizeof names[i], port == HTTP_PORT ? "%s\r" : "%s:%u\r", hosts[i], (unsigned)port);
    }
    for (const char *line = strstr(request, "\r\n"); line != NULL; line = strstr(line + 2, "\r\n")) {
        if (strncasecmp(line + 2, "host:", 5) == 0) {
            const char *name = line + 7 + strspn(line + 7, " ");
            return strncasecmp(name, names[0], strlen(names[0])) == 0 ||
                   strncasecmp(name, names[1], strlen(names[1])) == 0;
        }
    }
    return false;
}

static void begin_answer(client *c, const char *status, server_answer answer, bool with_body)
{
    c->head_bytes = (size_t)snprintf(c->head, sizeof c->head,
                                     "HTTP/1.1 %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\n"
                                     "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
                                     "Cross-Origin-Opener-Policy: same-origin\r\n" /* for threads */
                                     "Cross-Origin-Embedder-Policy: require-corp\r\n"
                                     "Connection: close\r\n\r\n",
                                     status, answer.type != NULL ? answer.type : "text/plain", answer.bytes);
    c->answer = answer;
    c->body_bytes = with_body ? answer.bytes : 0;
    c->count = 0;
    c->until = cli_now() + ANSWER_SECONDS;
}

static void choose_answer(const server *s, client *c)
{
    static const server_answer nothing = {.type = NULL};
    const bool get = strncmp(c->request, "GET ", 4) == 0, head = strncmp(c->request, "HEAD ", 5) == 0;
    if (!is_own_host(c->request, s->port)) {
        begin_answer(c, "403 Forbidden", nothing, true);
    } else if (!get && !head) {
        begin_answer(c, "405 Method Not Allowed", nothing, true);
    } else {
        char *path = c->request + (get ? 4 : 5);
        path[strcspn(path, " \r")] = '\0';
        const server_answer found = s->find(s->user, path);
        begin_answer(c, found.type != NULL ? "200 OK" : "404 Not Found", found, get);
    }
}

/* Reads what has arrived. Returns false when the connection is to be closed. */
static bool read_some(const server *s, client *c)
{
    const ssize_t got = recv(c->socket, c->request + c->count, REQUEST_BYTES - 1 - c->count, 0);
    if (got <= 0) {
        return got < 0 && (errno == EAGAIN || errno == EINTR);
    }
    c->count += (size_t)got;
    c->request[c->count] = '\0';
    if (strstr(c->request, "\r\n\r\n") != NULL) {
        choose_answer(s, c);
        return true;
    }
    return c->count < REQUEST_BYTES - 1;
}

/* Sends what the connection takes. Returns false when the connection is to be closed. */
static bool send_some(client *c)
{
    const bool in_head = c->count < c->head_bytes;
    const char *from = in_head ? c->head + c->count : c->answer.body + (c->count - c->head_bytes);
    const size_t left = in_head ? c->head_bytes - c->count : c->head_bytes + c->body_bytes - c->count;
    const ssize_t sent = send(c->socket, from, left, MSG_NOSIGNAL);
    if (sent < 0) {
        return errno == EAGAIN || errno == EINTR;
    }
    c->count += (size_t)sent;
    return c->count < c->head_bytes + c->body_bytes;
}

static void drop(server *s, uint32_t index)
{
    close(s->clients[index].socket);
    if (s->clients[index].answer.owned) {
        free(s->clients[index].answer.body);
    }
    s->clients[index] = s->clients[--s->count];
}

/* Takes a new connection; in place of the one that has the least time left, if there is no room. Returns -1 with errno
 * if no connection can be taken any more. */
static int take_client(server *s)
{
    const int socket = accept(s->listener, NULL, NULL);
    if (socket >= 0) {
        (void)fcntl(socket, F_SETFL, O_NONBLOCK);
    } else {
        return errno == EINTR || errno == ECONNABORTED || errno == EAGAIN ? 0 : -1;
    }
    if (s->count == CLIENTS_MOST) {
        uint32_t first = 0;
        for (uint32_t i = 1; i < s->count; i++) {
            first = s->clients[i].until < s->clients[first].until ? i : first;
        }
        drop(s, first);
    }
    client *c = &s->clients[s->count++];
    c->socket = socket;
    c->until = cli_now() + ASK_SECONDS;
    c->count = c->head_bytes = 0;
    c->answer = (server_answer){.type = NULL};
    return 0;
}

/* Returns milliseconds until the first connection's time is over; -1: there is none. */
static int wait_ms(const server *s)
{
    double least = INFINITY;
    for (uint32_t i = 0; i < s->count; i++) {
        least = fmin(least, s->clients[i].until - cli_now());
    }
    return s->count == 0 ? -1 : (int)(fmax(least, 0) * 1e3) + 1;
}

int server_run(int listener, uint16_t port, server_answer (*find)(void *user, const char *path), void *user,
               char *error, size_t error_bytes)
{
    static server s; /* the process has one */
    s = (server){.listener = listener, .port = port, .find = find, .user = user};
    for (;;) {
        struct pollfd polled[1 + CLIENTS_MOST] = {{.fd = listener, .events = POLLIN}};
        for (uint32_t i = 0; i < s.count; i++) {
            polled[1 + i] = (struct pollfd){s.clients[i].socket, s.clients[i].head_bytes > 0 ? POLLOUT : POLLIN, 0};
        }
        (void)poll(polled, 1 + s.count, wait_ms(&s));
        for (uint32_t i = s.count; i-- > 0;) { /* from the last, as drop() moves it into a gap */
            client *c = &s.clients[i];
            const bool in_time = cli_now() < c->until, is_ready = polled[1 + i].revents != 0;
            const bool stays = in_time && (!is_ready || (c->head_bytes > 0 ? send_some(c) : read_some(&s, c)));
            if (!stays) {
                drop(&s, i);
            }
        }
        if (polled[0].revents != 0 && take_client(&s) != 0) {
            return t3r_reason(error, error_bytes, "127.0.0.1:%u: %s", (unsigned)port, strerror(errno));
        }
    }
}
