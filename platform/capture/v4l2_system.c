#include "v4l2_system.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

static int kernel_open(void *user, const char *path)
{
    (void)user;
    return open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
}

static int kernel_ioctl(void *user, int fd, unsigned long request, void *argument)
{
    (void)user;
    return ioctl(fd, request, argument);
}

static void *kernel_map(void *user, int fd, size_t bytes, int64_t offset)
{
    (void)user;
    /* some drivers refuse a mapping of capture buffers without PROT_WRITE */
    void *memory = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, (off_t)offset);
    return memory == MAP_FAILED ? NULL : memory;
}

static int kernel_unmap(void *user, void *memory, size_t bytes)
{
    (void)user;
    return munmap(memory, bytes);
}

static int kernel_poll(void *user, struct pollfd *fds, uint32_t count, int timeout_ms)
{
    (void)user;
    return poll(fds, count, timeout_ms);
}

static int kernel_close(void *user, int fd)
{
    (void)user;
    return close(fd);
}

static int64_t kernel_now_ns(void *user)
{
    (void)user;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

const t3r_v4l2_system t3r_v4l2_kernel = {
    .open = kernel_open,
    .ioctl = kernel_ioctl,
    .map = kernel_map,
    .unmap = kernel_unmap,
    .poll = kernel_poll,
    .close = kernel_close,
    .now_ns = kernel_now_ns,
};
