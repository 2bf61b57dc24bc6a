#include "recording_file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/reason.h"

int t3r_recording_file_open(t3r_recording_file *file, const char *path, bool sync, char *error, size_t error_bytes)
{
    file->held = 0;
    file->sync = sync;
    file->fd = open(path, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    return file->fd >= 0 ? 0 : t3r_reason(error, error_bytes, "%s: %s", path, strerror(errno));
}

/* Writes all bytes; goes on after a signal interrupted a write. */
static int write_all(int fd, const uint8_t *bytes, size_t count)
{
    while (count > 0) {
        ssize_t written = write(fd, bytes, count);
        if (written < 0 && errno != EINTR) {
            return -1;
        }
        if (written > 0) {
            bytes += written;
            count -= (size_t)written;
        }
    }
    return 0;
}

static int flush(t3r_recording_file *file)
{
    size_t held = file->held;
    file->held = 0;
    return write_all(file->fd, file->room, held);
}

static int append(void *user, const void *bytes, size_t count)
{
    t3r_recording_file *file = user;
    if (count > sizeof file->room - file->held && flush(file) != 0) {
        return -1;
    }
    if (count > sizeof file->room) {
        return write_all(file->fd, bytes, count);
    }
    memcpy(file->room + file->held, bytes, count);
    file->held += count;
    return 0;
}

static int read_back(void *user, uint64_t offset, void *bytes, size_t count)
{
    t3r_recording_file *file = user;
    if (flush(file) != 0) {
        return -1;
    }
    for (size_t got = 0; got < count;) {
        ssize_t some = pread(file->fd, (uint8_t *)bytes + got, count - got, (off_t)(offset + got));
        if (some == 0 || (some < 0 && errno != EINTR)) {
            return -1;
        }
        got += some > 0 ? (size_t)some : 0;
    }
    return 0;
}

t3r_sink t3r_recording_file_sink(t3r_recording_file *file)
{
    struct stat about;
    bool regular = fstat(file->fd, &about) == 0 && S_ISREG(about.st_mode);
    return (t3r_sink){append, file, regular ? read_back : NULL};
}

int t3r_recording_file_message_end(void *user)
{
    t3r_recording_file *file = user;
    if (flush(file) != 0) {
        return -1;
    }
    /* devices and pipes have nothing to synchronise */
    return file->sync && fdatasync(file->fd) != 0 && errno != EINVAL && errno != EROFS ? -1 : 0;
}

int t3r_recording_file_close(t3r_recording_file *file)
{
    if (file->fd < 0) {
        return 0;
    }
    int error = flush(file) != 0 ? errno : 0;
    if (close(file->fd) != 0 && error == 0) {
        error = errno;
    }
    file->fd = -1;
    return error;
}
