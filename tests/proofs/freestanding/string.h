/* All of <string.h> that the runtime may use: a call of anything else does not compile. */
#ifndef T3R_PROOF_STRING_H
#define T3R_PROOF_STRING_H

#include <stddef.h>

void *memcpy(void *restrict to, const void *restrict from, size_t count);
void *memmove(void *to, const void *from, size_t count);
void *memset(void *to, int byte, size_t count);
int memcmp(const void *a, const void *b, size_t count);

#endif
