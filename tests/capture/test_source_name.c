/* SPDX-License-Identifier: Apache-2.0 */
/* A source's name never contains a password, a token or a folder. */
#include "capture/source_name.h"
#include "test.h"

TEST(names_hold_no_credentials_and_no_folders)
{
    static const char *const pairs[][2] = {
        {"replay:/home/me/rec.mcap", "replay:rec.mcap"},
        {"replay:rec.mcap", "replay:rec.mcap"},
        {"v4l2:/dev/video0", "v4l2:video0"},
        {"libcamera:0", "libcamera:0"},
        {"opencv:p%03d.png", "opencv:p%03d.png"},
        {"opencv:rtsp://10.0.0.1:554/live/1", "opencv:rtsp://10.0.0.1:554/live/1"},
        {"opencv:rtsp://me:secret@10.0.0.1:554/live?token=secret#secret", "opencv:rtsp://10.0.0.1:554/live"},
        {"opencv:rtsp://me:sec@ret@camera", "opencv:rtsp://camera"},
        {"opencv:http://camera?token=secret", "opencv:http://camera"},
        {"opencv:rtsp://me:sec/ret@camera/live", "opencv:rtsp://"},
        {"opencv:rtsp://me:sec?ret@camera/live", "opencv:rtsp://"},
        {"opencv:rtspsrc location=rtsp://me:secret@camera ! appsink", "opencv:(pipeline)"},
        {"opencv:souphttpsrc user-pw=secret ! appsink", "opencv:(pipeline)"},
        {"rtsp://me:secret@camera/live", "rtsp://camera/live"},
        {"/home/me/film.avi", "film.avi"},
        {"", ""},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        char name[T3R_SOURCE_NAME_BYTES];
        t3r_source_name(pairs[i][0], name, sizeof name);
        assert_string_equal(name, pairs[i][1]);
    }
    char cut[8];
    t3r_source_name("opencv:rtsp://camera", cut, sizeof cut);
    assert_string_equal(cut, "opencv:");
}
