#include <stddef.h>

void *malloc(size_t bytes);
void *planted_heap(size_t bytes);

void *planted_heap(size_t bytes)
{
    return malloc(bytes);
}
