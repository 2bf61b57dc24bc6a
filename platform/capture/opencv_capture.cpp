/* SPDX-License-Identifier: Apache-2.0 */
// Wraps VideoCapture as a table in C; exceptions stay inside.
#include "opencv_shim.h"

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>

struct t3r_opencv_film {
    cv::VideoCapture capture;
    cv::Mat picture;
    std::string backend;
    bool live = false;
};

namespace
{

int complain(char *error, size_t error_bytes, const char *name, const char *what)
{
    std::snprintf(error, error_bytes, "%s: %s", name, what);
    return -1;
}

bool is_number(const char *text)
{
    if (*text == '\0') {
        return false;
    }
    for (; *text != '\0'; text++) {
        if (!std::isdigit(static_cast<unsigned char>(*text))) {
            return false;
        }
    }
    return true;
}

// Whether the text numbers pictures, as p%d.png or p%03d.png. In a URL, % starts an escaped byte.
bool is_numbered(const char *text)
{
    if (std::strstr(text, "://") != nullptr) {
        return false;
    }
    for (const char *at = std::strchr(text, '%'); at != nullptr; at = std::strchr(at + 1, '%')) {
        const char *end = at + 1;
        while (std::isdigit(static_cast<unsigned char>(*end))) {
            end++;
        }
        if (*end == 'd' || *end == 'u') { // OpenCV's patterns
            return true;
        }
    }
    return false;
}

// Returns the back end of this name, or CAP_ANY; -1 when there is none.
int backend_named(const char *name)
{
    if (name == nullptr) {
        return cv::CAP_ANY;
    }
    for (cv::VideoCaptureAPIs api : cv::videoio_registry::getBackends()) {
        if (cv::videoio_registry::getBackendName(api) == name) {
            return api;
        }
    }
    return -1;
}

std::vector<int> parameters(const t3r_opencv_request &r, bool device, int api)
{
    std::vector<int> list;
    auto add = [&list](int property, int value) {
        list.push_back(property);
        list.push_back(value);
    };
    if (device && r.width != 0) {
        add(cv::CAP_PROP_FRAME_WIDTH, static_cast<int>(r.width));
        add(cv::CAP_PROP_FRAME_HEIGHT, static_cast<int>(r.height));
    }
    if (device && r.rate_millihertz != 0) {
        add(cv::CAP_PROP_FPS, static_cast<int>((r.rate_millihertz + 500) / 1000));
    }
    if (device && r.fourcc != nullptr && std::strlen(r.fourcc) == 4) {
        add(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc(r.fourcc[0], r.fourcc[1], r.fourcc[2], r.fourcc[3]));
    }
    // back ends refuse parameters that they do not know
    if (!device && api == cv::CAP_FFMPEG) {
        add(cv::CAP_PROP_OPEN_TIMEOUT_MSEC, static_cast<int>(r.timeout_ms));
        add(cv::CAP_PROP_READ_TIMEOUT_MSEC, static_cast<int>(r.timeout_ms));
    }
    return list;
}

bool open_film(t3r_opencv_film &film, const t3r_opencv_request &r, int api)
{
    film.live = is_number(r.url) || std::strncmp(r.url, "/dev/video", 10) == 0;
    std::vector<int> list = parameters(r, film.live, api);
    bool done = is_number(r.url) ? film.capture.open(std::atoi(r.url), api, list) : film.capture.open(r.url, api, list);
    if (done && r.unchanged) {
        film.capture.set(cv::CAP_PROP_CONVERT_RGB, 0);
    }
    return done;
}

t3r_opencv_film *open(const t3r_opencv_request *request, char *error, size_t error_bytes)
{
    t3r_opencv_film *film = nullptr;
    try {
        // FFMPEG reduces numbered pictures to 8 bits
        bool pictures = request->backend == nullptr && is_numbered(request->url);
        int api = pictures ? static_cast<int>(cv::CAP_IMAGES) : backend_named(request->backend);
        if (api < 0) {
            complain(error, error_bytes, request->backend, "is not a back end of this OpenCV");
            return nullptr;
        }
        film = new t3r_opencv_film;
        if (open_film(*film, *request, api)) {
            film->backend = film->capture.getBackendName();
            return film;
        }
        complain(error, error_bytes, request->name, "OpenCV cannot open it");
    } catch (const std::exception &wrong) {
        complain(error, error_bytes, request->name, wrong.what());
    }
    delete film;
    return nullptr;
}

int read(t3r_opencv_film *film, t3r_opencv_picture *picture, char *error, size_t error_bytes)
{
    try {
        if (!film->capture.read(film->picture) || film->picture.empty()) {
            return 0;
        }
        const cv::Mat &m = film->picture;
        picture->data = m.data;
        picture->width = static_cast<uint32_t>(m.cols);
        picture->height = static_cast<uint32_t>(m.rows);
        picture->stride = static_cast<uint32_t>(m.step[0]);
        picture->channels = static_cast<uint32_t>(m.channels());
        picture->bytes = static_cast<uint32_t>(m.elemSize1());
        picture->position_ms = film->capture.get(cv::CAP_PROP_POS_MSEC);
        return 1;
    } catch (const std::exception &wrong) {
        return complain(error, error_bytes, "OpenCV", wrong.what());
    }
}

void close(t3r_opencv_film *film)
{
    try {
        delete film;
    } catch (...) { // there is nothing left to report to
    }
}

const char *backend(const t3r_opencv_film *film)
{
    return film->backend.c_str();
}

double rate(const t3r_opencv_film *film)
{
    try {
        return film->capture.get(cv::CAP_PROP_FPS);
    } catch (...) {
        return 0;
    }
}

bool live(const t3r_opencv_film *film)
{
    return film->live;
}

} // namespace

extern "C" {
extern const t3r_opencv_shim t3r_shim;
const t3r_opencv_shim t3r_shim = {CV_VERSION, open, read, close, backend, rate, live};
}
