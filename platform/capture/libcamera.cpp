/* SPDX-License-Identifier: Apache-2.0 */
// Wraps libcamera as a table in C; exceptions and the library's threads stay inside.
//
// Written for and tested with libcamera 0.0.3 (Debian 12). Two changes of later versions matter here:
//
//   0.1   generateConfiguration() takes a Span of roles instead of a vector: the list in braces below fits both
//   0.2   CameraConfiguration has `orientation` instead of `transform`: neither is used
#include "libcamera_shim.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dirent.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <linux/videodev2.h>

#include <libcamera/libcamera.h>

namespace lc = libcamera;

namespace
{

// DRM names the order within a little-endian word, so its BGR888 is R, G, B in memory.
struct named_format {
    const char *name;
    lc::PixelFormat format;
};
const std::array<named_format, 6> formats = {{{"YUYV", lc::formats::YUYV},
                                              {"UYVY", lc::formats::UYVY},
                                              {"NV12", lc::formats::NV12},
                                              {"RGB3", lc::formats::BGR888},
                                              {"BGR3", lc::formats::RGB888},
                                              {"GREY", lc::formats::R8}}};

// Returns the process's only manager, which the library demands; it is kept while in use.
std::shared_ptr<lc::CameraManager> manager(char *error, size_t error_bytes)
{
    static std::weak_ptr<lc::CameraManager> shared;
    std::shared_ptr<lc::CameraManager> there = shared.lock();
    if (there) {
        return there;
    }
    std::shared_ptr<lc::CameraManager> made(new lc::CameraManager, [](lc::CameraManager *m) {
        m->stop();
        delete m;
    });
    if (made->start() != 0) {
        std::snprintf(error, error_bytes, "libcamera does not start");
        return nullptr;
    }
    shared = made;
    return made;
}

struct mapping {
    void *memory;
    size_t bytes;
};

} // namespace

struct t3r_libcamera_stream {
    std::shared_ptr<lc::CameraManager> cameras;
    std::shared_ptr<lc::Camera> camera;
    std::unique_ptr<lc::CameraConfiguration> configuration;
    lc::Stream *stream = nullptr;
    std::unique_ptr<lc::FrameBufferAllocator> allocator;
    std::vector<std::unique_ptr<lc::Request>> requests;
    std::vector<mapping> mappings;
    bool acquired = false, started = false;

    std::mutex lock; // guards the following
    std::condition_variable more;
    std::array<t3r_libcamera_done, T3R_LIBCAMERA_MOST_BUFFERS> done{};
    size_t first = 0, count = 0; // a ring: holds a buffer at most once
    bool gone = false;           // reported by udev to the library
    bool refused = false;        // the device took a buffer no longer

    void on_done(lc::Request *request)
    {
        const lc::FrameMetadata &m = request->buffers().at(stream)->metadata();
        std::lock_guard<std::mutex> held(lock);
        // a cancelled buffer that is queued again would be cancelled again, forever
        refused = refused || request->status() == lc::Request::RequestCancelled;
        if (count < done.size() && !refused) {
            t3r_libcamera_done &d = done[(first + count++) % done.size()];
            d.index = static_cast<uint32_t>(request->cookie());
            d.sequence = m.sequence;
            d.stamp_ns = m.timestamp;
            d.bytes = 0;
            for (const auto &plane : m.planes()) {
                d.bytes += plane.bytesused;
            }
            d.whole = request->status() == lc::Request::RequestComplete && m.status == lc::FrameMetadata::FrameSuccess;
        }
        more.notify_one();
    }

    void on_gone()
    {
        std::lock_guard<std::mutex> held(lock);
        gone = true;
        more.notify_one();
    }
};

namespace
{

int complain(char *error, size_t error_bytes, const char *camera, const char *what)
{
    std::snprintf(error, error_bytes, "libcamera:%s: %s", camera, what);
    return -1;
}

std::shared_ptr<lc::Camera> find(lc::CameraManager &cameras, const std::string &wish)
{
    std::vector<std::shared_ptr<lc::Camera>> all = cameras.cameras();
    char *end = nullptr;
    unsigned long number = std::strtoul(wish.c_str(), &end, 10);
    if (!wish.empty() && *end == '\0') {
        return number < all.size() ? all[number] : nullptr;
    }
    return cameras.get(wish);
}

// Configures the first wished format that the camera accepts unchanged. Returns nullptr, or why there is none.
const char *configure(t3r_libcamera_stream &s, const t3r_libcamera_request &r, t3r_libcamera_agreed &agreed)
{
    for (const named_format &f : formats) {
        if (r.format != nullptr && std::strcmp(r.format, f.name) != 0) {
            continue;
        }
        s.configuration = s.camera->generateConfiguration({lc::StreamRole::Viewfinder});
        if (!s.configuration || s.configuration->size() == 0) {
            return "has no viewfinder stream";
        }
        lc::StreamConfiguration &c = s.configuration->at(0);
        c.size = {r.width, r.height};
        c.pixelFormat = f.format;
        c.bufferCount = r.buffers;
        if (s.configuration->validate() == lc::CameraConfiguration::Invalid || c.pixelFormat != f.format) {
            continue;
        }
        if (s.camera->configure(s.configuration.get()) != 0) {
            return "refuses the configuration that it called valid";
        }
        s.stream = c.stream();
        std::snprintf(agreed.format, sizeof agreed.format, "%s", f.name);
        agreed.width = c.size.width;
        agreed.height = c.size.height;
        agreed.stride = c.stride;
        return nullptr;
    }
    return r.format != nullptr ? "does not offer the format" : "offers no format that is read";
}

// Maps the planes of a buffer. They may share a file descriptor; each is mapped from its start to its own end.
const char *map_buffer(t3r_libcamera_stream &s, const lc::FrameBuffer &buffer, t3r_libcamera_agreed &agreed)
{
    const std::vector<lc::FrameBuffer::Plane> &planes = buffer.planes();
    auto &out = agreed.buffer[agreed.buffers];
    for (size_t p = 0; p < planes.size() && p < 2; p++) {
        size_t bytes = static_cast<size_t>(planes[p].offset) + planes[p].length;
        void *memory = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, planes[p].fd.get(), 0);
        if (memory == MAP_FAILED) {
            return "a buffer cannot be mapped";
        }
        s.mappings.push_back({memory, bytes});
        out.plane[p] = static_cast<const uint8_t *>(memory) + planes[p].offset;
        out.bytes[p] = planes[p].length;
    }
    bool second = planes.size() < 2 && std::strcmp(agreed.format, "NV12") == 0;
    size_t luma = static_cast<size_t>(agreed.stride) * agreed.height;
    if (second && out.bytes[0] > luma) {
        out.plane[1] = out.plane[0] + luma;
        out.bytes[1] = out.bytes[0] - luma;
    }
    agreed.buffers++;
    return nullptr;
}

const char *prepare(t3r_libcamera_stream &s, const t3r_libcamera_request &r, t3r_libcamera_agreed &agreed)
{
    s.allocator = std::make_unique<lc::FrameBufferAllocator>(s.camera);
    if (s.allocator->allocate(s.stream) < 0) {
        return "gives no buffers";
    }
    agreed.buffers = 0;
    for (const auto &buffer : s.allocator->buffers(s.stream)) {
        if (agreed.buffers == T3R_LIBCAMERA_MOST_BUFFERS) {
            break;
        }
        std::unique_ptr<lc::Request> request = s.camera->createRequest(agreed.buffers);
        if (!request || request->addBuffer(s.stream, buffer.get()) != 0) {
            return "gives no requests";
        }
        const char *wrong = map_buffer(s, *buffer, agreed);
        if (wrong != nullptr) {
            return wrong;
        }
        s.requests.push_back(std::move(request));
    }
    lc::ControlList controls(s.camera->controls());
    if (r.rate_millihertz != 0 && s.camera->controls().count(&lc::controls::FrameDurationLimits) != 0) {
        int64_t us = 1000000000 / static_cast<int64_t>(r.rate_millihertz);
        controls.set(lc::controls::FrameDurationLimits, lc::Span<const int64_t, 2>({us, us}));
    }
    s.camera->requestCompleted.connect(&s, &t3r_libcamera_stream::on_done);
    s.camera->disconnected.connect(&s, &t3r_libcamera_stream::on_gone);
    if (s.camera->start(&controls) != 0) {
        return "does not start";
    }
    s.started = true;
    for (auto &request : s.requests) {
        if (s.camera->queueRequest(request.get()) != 0) {
            return "takes no requests";
        }
    }
    return nullptr;
}

// Finds the video devices that this process has open but that no longer exist, as many as there is room for.
size_t gone_devices(std::array<int, 16> &found)
{
    size_t count = 0;
    DIR *folder = opendir("/proc/self/fd");
    while (folder != nullptr && count < found.size()) {
        const dirent *entry = readdir(folder);
        if (entry == nullptr) {
            break;
        }
        char path[32] = ""; // the rest after /dev/video does not matter
        ssize_t length = readlinkat(dirfd(folder), entry->d_name, path, sizeof path - 1);
        int fd = std::atoi(entry->d_name);
        v4l2_capability can;
        if (length > 0 && std::strncmp(path, "/dev/video", 10) == 0 && ioctl(fd, VIDIOC_QUERYCAP, &can) != 0 &&
            errno == ENODEV) {
            found[count++] = fd;
        }
    }
    if (folder != nullptr) {
        closedir(folder);
    }
    return count;
}

void unmap(t3r_libcamera_stream *s)
{
    for (const mapping &m : s->mappings) {
        munmap(m.memory, m.bytes);
    }
    s->mappings.clear();
}

bool heard_of_unplugging(t3r_libcamera_stream *s)
{
    std::lock_guard<std::mutex> held(s->lock);
    return s->gone;
}

// Abandons a stream whose device is gone; returns whether that was necessary. Where udevd's messages do not arrive (in
// containers), the library does not notice an unplugging, and its stop() on a missing device fails an assertion and
// ends the process. So the manager and its thread are ended, the camera's objects are neither touched nor freed, and
// the devices are closed so that their names become available. A later manager searches for cameras again.
bool abandon(t3r_libcamera_stream *s)
{
    std::array<int, 16> devices;
    size_t count = heard_of_unplugging(s) ? 0 : gone_devices(devices);
    if (count == 0) {
        return false;
    }
    s->cameras.reset();
    unmap(s);
    for (size_t i = 0; i < count; i++) {
        ::close(devices[i]);
    }
    return true;
}

void close(t3r_libcamera_stream *s)
{
    if (s == nullptr) {
        return;
    }
    if (s->started && abandon(s)) {
        return;
    }
    if (s->started) {
        s->camera->stop();
    }
    if (s->camera) {
        s->camera->requestCompleted.disconnect(s);
        s->camera->disconnected.disconnect(s);
    }
    unmap(s);
    s->requests.clear();
    if (s->allocator && s->stream != nullptr) {
        s->allocator->free(s->stream);
    }
    s->allocator.reset();
    if (s->acquired) {
        s->camera->release();
    }
    s->camera.reset();
    delete s;
}

t3r_libcamera_stream *open(const t3r_libcamera_request *request, t3r_libcamera_agreed *agreed, char *error,
                           size_t error_bytes)
{
    t3r_libcamera_stream *s = nullptr;
    try {
        s = new t3r_libcamera_stream;
        const char *wrong = nullptr;
        std::memset(agreed, 0, sizeof *agreed);
        s->cameras = manager(error, error_bytes);
        if (!s->cameras) {
            close(s);
            return nullptr;
        }
        s->camera = find(*s->cameras, request->camera);
        if (!s->camera) {
            wrong = "there is no such camera (trim3r capture --list)";
        } else if (s->camera->acquire() != 0) {
            wrong = "another program captures from it";
        } else {
            s->acquired = true;
            wrong = configure(*s, *request, *agreed);
        }
        wrong = wrong != nullptr ? wrong : prepare(*s, *request, *agreed);
        if (wrong == nullptr) {
            std::snprintf(agreed->id, sizeof agreed->id, "%s", s->camera->id().c_str());
            return s;
        }
        complain(error, error_bytes, request->camera, wrong);
    } catch (const std::exception &wrong) {
        complain(error, error_bytes, request->camera, wrong.what());
    }
    close(s);
    return nullptr;
}

int wait(t3r_libcamera_stream *s, uint32_t timeout_ms, t3r_libcamera_done *done)
{
    std::unique_lock<std::mutex> held(s->lock);
    s->more.wait_for(held, std::chrono::milliseconds(timeout_ms),
                     [s] { return s->gone || s->refused || s->count > 0; });
    if (s->count > 0) {
        *done = s->done[s->first];
        s->first = (s->first + 1) % s->done.size();
        s->count--;
        return 1;
    }
    return s->gone ? -1 : s->refused ? -2 : 0;
}

int queue(t3r_libcamera_stream *s, uint32_t index)
{
    lc::Request *request = s->requests[index].get();
    request->reuse(lc::Request::ReuseBuffers);
    return s->camera->queueRequest(request) == 0 ? 0 : -1;
}

void list(void (*say)(void *user, const char *line), void *user)
{
    try {
        char error[128] = "";
        std::shared_ptr<lc::CameraManager> cameras = manager(error, sizeof error);
        if (!cameras) {
            say(user, error);
            return;
        }
        int number = 0;
        for (const auto &camera : cameras->cameras()) {
            std::string line = "libcamera:" + std::to_string(number++) + "  " + camera->id();
            say(user, line.c_str());
        }
    } catch (const std::exception &wrong) {
        say(user, wrong.what());
    }
}

} // namespace

extern "C" {
const t3r_libcamera_shim t3r_shim = {"0.0.3", open, wait, queue, close, list};
}
