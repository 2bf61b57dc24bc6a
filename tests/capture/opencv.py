#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""opencv.py TRIM3R: pictures and films by OpenCV's VideoCapture against the samples that they were made of, and
their Gaussians against those of a recording made without OpenCV. Skipped without the adapter or numpy and cv2."""
import functools
import http.server
import json
import os
import sys
import tempfile
import threading

try:
    import cv2
    import numpy
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

import mcap_read  # noqa: E402
from checks import check, done, skip  # noqa: E402
from program import expect, expect_json  # noqa: E402


def images(path, topic, dtype, channels):
    out = []
    for name, _, message in mcap_read.messages(open(path, "rb").read()):
        if name == topic:
            height, width, encoding, data = mcap_read.image(message)
            samples = numpy.frombuffer(data, dtype)
            out.append((encoding, samples.reshape(height, width, channels) if channels > 1 else
                        samples.reshape(height, width)))
    return out


class Server(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def keeps_secrets(film):
    """Neither user, password nor query of a stream's URL is recorded or printed."""
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Server, directory=os.getcwd())) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        place = f"127.0.0.1:{server.server_port}/{film}"
        out = expect(0, "capture", "--source", f"opencv:http://me:hidden@{place}?token=hidden", "-o", "stream.mcap", "--json")
        server.shutdown()
    check(json.loads(out)["source"] == f"opencv:http://{place}" and "hidden" not in out, out)
    with open("stream.mcap", "rb") as file:
        held = file.read()
    check(place.encode() in held and b"hidden" not in held, "the recording knows the stream and no secret")


def capture(source, name, *options):
    return expect_json("capture", "--source", source, "-o", name, *options)


listed = expect(0, "capture", "--list")
if " yes " not in next(line for line in listed.splitlines() if line.startswith("opencv")):
    skip("the adapter is not there")

with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    expect(0, "room", "--size", "64x48", "--frames", 5, "-o", "room.mcap")
    colour = [a for _, a in images("room.mcap", "/camera/image", numpy.uint8, 3)]
    depth = [a for _, a in images("room.mcap", "/camera/depth", "<u2", 1)]
    poses = [mcap_read.pose(m) for t, _, m in mcap_read.messages(open("room.mcap", "rb").read()) if t == "/camera/pose"]
    film = cv2.VideoWriter("film.avi", cv2.VideoWriter_fourcc(*"FFV1"), 30, (64, 48))
    for i, (c, d) in enumerate(zip(colour, depth)):
        cv2.imwrite(f"c{i:03d}.png", cv2.cvtColor(c, cv2.COLOR_RGB2BGR))
        cv2.imwrite(f"d{i:03d}.png", d)
        film.write(cv2.cvtColor(c, cv2.COLOR_RGB2BGR))
    film.release()
    capture("opencv:c%03d.png", "stamps.mcap")
    stamps = [mcap_read.stamp(mcap_read.Cdr(m)) for t, _, m in mcap_read.messages(open("stamps.mcap", "rb").read())
              if t == "/camera/image"]
    check(len(stamps) == 5 and abs(stamps[1] - 1e9 / 30) <= 1, f"stamps a thirtieth of a second apart: {stamps}")
    with open("euroc.csv", "w", encoding="ascii") as file:
        for stamp, (_, (x, y, z, qx, qy, qz, qw)) in zip(stamps, poses):
            file.write(",".join(map(repr, (stamp, x, y, z, qw, qx, qy, qz))) + "\n")
    # intrinsics exactly like the room's
    info = next(m for t, _, m in mcap_read.messages(open("room.mcap", "rb").read()) if t == "/camera/camera_info")
    cdr = mcap_read.Cdr(info)
    mcap_read.stamp(cdr), cdr.string(), cdr.number("I"), cdr.number("I"), cdr.string()
    for _ in range(cdr.number("I")):
        cdr.number("d")
    k = [cdr.number("d") for _ in range(9)]
    lens = ",".join(repr(k[i]) for i in (0, 4, 2, 5))

    told = capture("opencv:c%03d.png", "pictures.mcap", "--depth-source", "d%03d.png", "--intrinsics", lens, "--poses",
                   "euroc.csv")
    check(told["frames"] == told["paired"] == 5 and told["format"] == "bgr24", f"{told}")
    check("as they are stored" in told["note"], f"{told['note']}")
    for (encoding, got), want in zip(images("pictures.mcap", "/camera/image", numpy.uint8, 3), colour):
        check(encoding == "bgr8" and (got[..., ::-1] == want).all(), "colour, sample by sample")
    for (encoding, got), want in zip(images("pictures.mcap", "/camera/depth", "<u2", 1), depth):
        check(encoding == "16UC1" and (got == want).all(), "depth, sample by sample")
    ours = expect_json("replay", "room.mcap", "--refine", 0)
    theirs = expect_json("replay", "pictures.mcap", "--refine", 0)
    check(ours["hash"] == theirs["hash"], "the same Gaussians and the same view as without OpenCV")

    told = capture("opencv:film.avi", "film.mcap", "--backend", "FFMPEG")
    check(told["frames"] == 5 and told["clock"] == "stream", f"{told}")
    reader = cv2.VideoCapture("film.avi", cv2.CAP_FFMPEG)
    for _, got in images("film.mcap", "/camera/image", numpy.uint8, 3):
        good, want = reader.read()
        check(good and (got == want).all(), "a film as cv2 itself decodes it")
    check("FFMPEG" in told["note"], "the back end is named")
    keeps_secrets("film.avi")
    os.rename("film.avi", "100%.avi")
    check("CV_IMAGES" not in capture("opencv:100%.avi", "film.mcap")["note"], "a film whose name holds a %")
    os.rename("100%.avi", "100%3d.avi")
    check("CV_IMAGES" not in capture("opencv:file://" + os.path.abspath("100%3d.avi"), "film.mcap")["note"],
          "the % of a URL is no number of pictures")
    expect(1, "capture", "--source", "opencv:missing.avi", "--hash", err="cannot open")
    expect(1, "capture", "--source", "opencv:c%03d.png", "--backend", "NONE", "--hash", err="not a back end")
    expect(1, "capture", "--source", "opencv:d%03d.png", "--depth-source", "c%03d.png", "--hash")
    cv2.imwrite("clear0.png", numpy.full((48, 64, 4), 99, numpy.uint8))
    expect(1, "capture", "--source", "opencv:clear%d.png", "--hash", err="transparency, which trim3r import")
done()
