/* SPDX-License-Identifier: Apache-2.0 */
#include "source_name.h"

#include <stdio.h>
#include <string.h>

#define LOWER "abcdefghijklmnopqrstuvwxyz"
#define LETTERS LOWER "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
#define DIGITS "0123456789"

void t3r_source_name(const char *source, char *name, size_t bytes)
{
    size_t adapter = strspn(source, LOWER DIGITS);
    adapter = adapter > 0 && source[adapter] == ':' && strncmp(source + adapter, "://", 3) != 0 ? adapter + 1 : 0;
    const char *what = source + adapter, *shown = what;
    size_t scheme = strspn(what, LETTERS DIGITS "+-."), length;
    if (scheme > 0 && strncmp(what + scheme, "://", 3) == 0) {
        const char *host = what + scheme + 3, *behind = host + strcspn(host, "/?#");
        const char *at = strrchr(host, '@');
        for (const char *p = host; p < behind; p++) {
            shown = *p == '@' ? p + 1 : shown;
        }
        scheme += 3;
        shown = shown == what ? host : shown;
        length = at != NULL && at >= behind ? 0 : strcspn(shown, "?#");
    } else if (strstr(what, "://") != NULL || strchr(what, '!') != NULL) {
        scheme = 0;
        shown = "(pipeline)";
        length = strlen(shown);
    } else {
        const char *slash = strrchr(what, '/');
        scheme = 0;
        shown = slash != NULL ? slash + 1 : what;
        length = strlen(shown);
    }
    snprintf(name, bytes, "%.*s%.*s%.*s", (int)adapter, source, (int)scheme, what, (int)length, shown);
}
