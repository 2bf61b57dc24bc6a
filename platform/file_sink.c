#include "recording.h"

static int append(void *user, const void *bytes, size_t count)
{
    return fwrite(bytes, 1, count, user) == count ? 0 : -1;
}

t3r_sink t3r_file_sink(FILE *file)
{
    return (t3r_sink){append, file};
}
