#include "viewer/server.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "host/reason.h"

enum { REQUEST_BYTES = 8192, SECONDS = 5 };

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

/* Reads the head of a request as a string; false: it is too long, or does not arrive. */
static bool read_request(int client, char request[REQUEST_BYTES])
{
    size_t count = 0;
    while (count < REQUEST_BYTES - 1) {
        const ssize_t got = recv(client, request + count, REQUEST_BYTES - 1 - count, 0);
        if (got <= 0) {
            return false;
        }
        count += (size_t)got;
        request[count] = '\0';
        if (strstr(request, "\r\n\r\n") != NULL) {
            return true;
        }
    }
    return false;
}

static bool is_own_host(const char *request, uint16_t port)
{
    char names[2][32];
    snprintf(names[0], sizeof names[0], "127.0.0.1:%u\r", (unsigned)port);
    snprintf(names[1], sizeof names[1], "localhost:%u\r", (unsigned)port);
    for (const char *line = strstr(request, "\r\n"); line != NULL; line = strstr(line + 2, "\r\n")) {
        if (strncasecmp(line + 2, "host:", 5) == 0) {
            const char *name = line + 7 + strspn(line + 7, " ");
            return strncasecmp(name, names[0], strlen(names[0])) == 0 ||
                   strncasecmp(name, names[1], strlen(names[1])) == 0;
        }
    }
    return false;
}

static bool send_all(int client, const char *bytes, size_t count)
{
    while (count > 0) {
        const ssize_t sent = send(client, bytes, count, MSG_NOSIGNAL);
        if (sent <= 0) {
            return false;
        }
        bytes += sent;
        count -= (size_t)sent;
    }
    return true;
}

static void answer(int client, const char *status, const char *body, size_t count, bool with_body)
{
    char head[256];
    const int length =
        snprintf(head, sizeof head,
                 "HTTP/1.1 %s\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: %zu\r\n"
                 "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
                 status, count);
    if (send_all(client, head, (size_t)length) && with_body) {
        (void)send_all(client, body, count);
    }
}

static void serve(int client, uint16_t port, const char *page, size_t page_bytes)
{
    char request[REQUEST_BYTES];
    const struct timeval most = {.tv_sec = SECONDS}; /* for each part: a client that stalls delays the others */
    (void)setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
    (void)setsockopt(client, SOL_SOCKET, SO_SNDTIMEO, &most, sizeof most);
    if (!read_request(client, request)) {
        return;
    }
    const bool get = strncmp(request, "GET ", 4) == 0, head = strncmp(request, "HEAD ", 5) == 0;
    const char *path = request + (get ? 4 : 5);
    if (!is_own_host(request, port)) {
        answer(client, "403 Forbidden", "", 0, true);
    } else if (!get && !head) {
        answer(client, "405 Method Not Allowed", "", 0, true);
    } else if (strncmp(path, "/ ", 2) != 0) {
        answer(client, "404 Not Found", "", 0, true);
    } else {
        answer(client, "200 OK", page, page_bytes, get);
    }
}

int server_run(int listener, uint16_t port, const char *page, size_t page_bytes, char *error, size_t error_bytes)
{
    for (;;) {
        const int client = accept(listener, NULL, NULL);
        if (client >= 0) {
            serve(client, port, page, page_bytes);
            close(client);
        } else if (errno != EINTR && errno != ECONNABORTED) {
            return t3r_reason(error, error_bytes, "127.0.0.1:%u: %s", (unsigned)port, strerror(errno));
        }
    }
}
