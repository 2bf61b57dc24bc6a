/* SPDX-License-Identifier: Apache-2.0 */
#include "recording_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/reason.h"

typedef struct part_name {
    char text[T3R_RECORDING_PATH_BYTES + 8];
} part_name;

static part_name part_of(const t3r_recording_file *file)
{
    part_name name;
    snprintf(name.text, sizeof name.text, "%s.part", file->path);
    return name;
}

/* Whether another process records to the file of this name. */
static bool is_busy(const char *path)
{
    const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    const bool busy = fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (fd >= 0) {
        close(fd);
    }
    return busy;
}

/* Whether the descriptor is of the file that has this name now. */
static bool is_named(int fd, const char *path)
{
    struct stat opened, named;
    return fstat(fd, &opened) == 0 && stat(path, &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

/* Opens and locks the part, and empties it. Returns the descriptor, or -1 with errno. */
static int open_part(const char *path, const char *part)
{
    const int fd = open(part, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (fd < 0) {
        return -1;
    }
    if (flock(fd, LOCK_EX | LOCK_NB) != 0 || !is_named(fd, part) || is_busy(path) || ftruncate(fd, 0) != 0) {
        close(fd);
        errno = EBUSY;
        return -1;
    }
    return fd;
}

int t3r_recording_file_open(t3r_recording_file *file, const char *path, bool sync, char *error, size_t error_bytes)
{
    struct stat there;
    file->held = 0;
    file->sync = sync;
    file->placed = stat(path, &there) == 0 && !S_ISREG(there.st_mode);
    snprintf(file->path, sizeof file->path, "%s", path);
    file->fd = file->placed ? open(path, O_RDWR | O_CLOEXEC) : open_part(path, part_of(file).text);
    return file->fd >= 0    ? 0
           : errno == EBUSY ? t3r_reason(error, error_bytes, "%s: another process records to it", path)
                            : t3r_reason(error, error_bytes, "%s: %s", path, strerror(errno));
}

int t3r_recording_file_place(t3r_recording_file *file)
{
    if (file->placed) {
        return 0;
    }
    if (is_busy(file->path)) {
        errno = EBUSY;
        return -1;
    }
    if (fdatasync(file->fd) != 0 || rename(part_of(file).text, file->path) != 0) {
        return -1;
    }
    file->placed = true;
    return 0;
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
    if (!file->placed) {
        (void)unlink(part_of(file).text);
    } else if (fdatasync(file->fd) != 0 && errno != EINVAL && errno != EROFS && error == 0) {
        error = errno;
    }
    if (close(file->fd) != 0 && error == 0) {
        error = errno;
    }
    file->fd = -1;
    return error;
}
