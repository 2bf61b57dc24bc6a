#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""wild.py TRIM3R: what files of others and odd surroundings must not do without a word: a lens that is not drawn, one bad
Gaussian in many, closed standard streams, files of the kernel, kinds of files that are not read, and two writers of one
recording."""
import fcntl
import json
import math
import os
import struct
import subprocess

from program import TRIM3R, check, expect, expect_json, in_scratch, room, run, write

POSE = {"fl_x": 40, "w": 32, "h": 32, "transform_matrix": [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]}
NUMBERS = ("x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3")
COUNT = 20


def rows():
    """Returns Gaussians in a row before the camera, as numbers of a .ply."""
    return [[i / COUNT - 0.5, 0, 2, i / COUNT, 0, 0, 3, -3, -3, -3, 1, 0, 0, 0] for i in range(COUNT)]


def ply(path, of):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(of)}\n"
    header += "".join(f"property float {name}\n" for name in NUMBERS) + "end_header\n"
    return write(path, header.encode() + b"".join(struct.pack("<14f", *row) for row in of))


def splat(path, of):
    """Writes a .splat; a rotation of 0 is stored as four bytes of 128."""
    return write(path, b"".join(struct.pack("<6f", *row[:3], *map(math.exp, row[7:10])) + bytes([100, 100, 100, 240])
                                + bytes(128 + int(127 * q) for q in row[10:]) for row in of))


def lenses_of_poses():
    """A camera with distortion is refused by its field, wherever the file states it."""
    ply("s.ply", rows())
    frame = {"file_path": "a.png", "transform_matrix": POSE["transform_matrix"]}
    lens = {name: POSE[name] for name in ("fl_x", "w", "h")}
    plain = {**lens, "frames": [frame]}
    expect(0, "render", "s.ply", "--pose", write("p.json", json.dumps(plain)), "-o", "v.png")
    for changed in ({**plain, "k1": 0.2}, {**plain, "camera_model": "SIMPLE_RADIAL", "k1": 0.2}, {**plain, "is_fisheye": True},
                    {**plain, "camera_model": "OPENCV_FISHEYE"}, {**plain, "k5": 0.1}, {**lens, "frames": [{**frame, "p1": 0.1}]},
                    {**POSE, "k2": -0.1}):
        write("p.json", json.dumps(changed))
        expect(1, "render", "s.ply", "--pose", "p.json", "-o", "v.png", "--force", err="pinhole")


def one_bad_gaussian():
    """One invalid Gaussian is named, and left out and counted on request; the others stay as they are."""
    for at, value in ((0, math.nan), (2, math.inf), (6, math.nan), (7, math.inf), (3, math.nan), (10, math.nan), (10, 0.0)):
        for write_scene, name in ((ply, "bad.ply"), (splat, "bad.splat")):
            if write_scene is splat and at not in (0, 2, 10):
                continue  # bytes are no NaN
            bad = rows()
            bad[7][at] = value if at != 10 or write_scene is ply else 0.0
            write_scene(name, bad)
            good = rows()
            del good[7]
            write_scene("good" + name[3:], good)
            expect(1, "info", name, err="--drop-invalid")
            expect(1, "convert", name, "-o", "out.ply", err="--drop-invalid")
            for target in ("out.ply", "out.spz", "out.glb"):
                expect(0, "convert", name, "--drop-invalid", "-o", target, err="1 invalid Gaussians are left out")
                check(expect_json("info", target)["scenes"][0]["gaussians"] == COUNT - 1, f"{name} to {target}")
            expect(0, "convert", "good" + name[3:], "-o", "same.ply")
            check(open("out.ply", "rb").read() == open("same.ply", "rb").read(), f"{name}, {NUMBERS[at]} = {value}: the others")


def floats_far_from_the_origin():
    """Floats whose steps are wider than the Gaussians lost detail when they were written: a warning says so."""
    def placed(east, north, width):
        return [[row[0] + east, row[1] + north, *row[2:7], *[math.log(width)] * 3, *row[10:]] for row in rows()]

    def text(path, of):
        header = f"ply\nformat ascii 1.0\nelement vertex {len(of)}\n" + "".join(f"property float {name}\n" for name in NUMBERS)
        singles = [struct.unpack("<14f", struct.pack("<14f", *row)) for row in of]
        return write(path, header + "end_header\n" + "".join(" ".join(map(repr, row)) + "\n" for row in singles))

    for place, width, is_lost in (((450000, 5400000), 0.05, True), ((450000, 5400000), 0.9, True), ((450000, 5400000), 2, False),
                                  ((450, 5400), 0.05, False), ((0, 0), 0.05, False), ((450, 5400), 0.0005, True)):
        for name, write_scene in (("utm.ply", ply), ("text.ply", text), ("utm.splat", splat)):
            write_scene(name, placed(*place, width))
            for line in (("info", name), ("convert", name, "-o", "near.glb", "--force"), ("render", name, "--orbit", 1, "-o", "v.png", "--force")):
                code, _, error = run(*line)
                check(code == 0, f"{line}: {error}")
                check(("positions are floats, so far from the origin in steps of" in error) == is_lost, f"{place}, {width}, {line}: {error}")


def closed_streams():
    """No file gets the number of a closed standard stream, so no table goes into it."""
    recording = room()
    for closing, status in ((">&-", 1), ("2>&-", 0), ("<&-", 0), (">&- 2>&- <&-", 1)):
        for line in (("eval", recording, "--keep", "20", "--csv", "t.csv"), ("convert", "s.ply", "-o", "c.spz")):
            ended = subprocess.run(["sh", "-c", f'exec "$0" "$@" --force {closing}', TRIM3R, *line], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, check=False)
            check(ended.returncode == status, f"{line[0]} {closing}: {ended.returncode}")
        check(open("t.csv", "rb").read(6) == b"scene,", f"{closing}: the table")
        check(expect_json("info", "c.spz")["scenes"][0]["gaussians"] == COUNT, f"{closing}: the scene")
        os.remove("t.csv")
        os.remove("c.spz")


def files_of_the_kernel():
    """Files that block or have no end are refused at once."""
    for path in ("/proc/kmsg", "/dev/zero", "/dev/tty", "/proc/self/mem", "/proc/self/pagemap"):
        for line in (("info", path), ("build", path, "--context", "0,1", "--keep", "5%", "-o", "n.ply"),
                     ("render", path, "room.mcap", "--view", "0", "-o", "n.png"), ("import", path, "-o", "n.mcap"), ("convert", path, "-o", "n.ply")):
            ended = subprocess.run([TRIM3R, *line], capture_output=True, text=True, timeout=20, check=False)
            check(ended.returncode == 1 and path in ended.stderr, f"{line[0]} {path}: {ended}")


def kinds_that_are_not_read():
    """Every command that takes a scene or a recording names what makes one of such a file."""
    for name, remedy in (("a.ksplat", "splat-transform"), ("a.GLTF", "gltf-transform"), ("a.ckpt", "ns-export"), ("a.las", "point cloud"), ("a.obj", "a mesh"),
                         ("a.npz", "trim3r import PHOTOS --pointmaps FILE.npz")):
        write(name, b"\x07" * 300)
        for line in (("info", name), ("convert", name, "-o", "n.ply"), ("view", name, "-o", "n.html"), ("diff", name, name),
                     ("render", name, "room.mcap", "--view", 0, "-o", "n.png"), ("import", name, "-o", "n.mcap"), ("build", name, "--keep", 10, "-o", "n.ply")):
            expect(1, *line, err=remedy)
    expect(1, "info", "absent.ksplat", err="No such file")
    for name, start, remedy in (("a.jpg", b"\xff\xd8\xff\xe0", "a JPEG picture, not a scene: trim3r scene FOLDER"), ("a.heic", b"0000ftypheic", "a HEIC picture"),
                                ("a.mp4", b"0000ftypisom", "a video, not a scene: ffmpeg"), ("a.png", b"\x89PNG\r\n", "a PNG picture"),
                                ("a.bin", b"\x89MCAP0\r\n", "a recording, not a scene: trim3r scene")):
        write(name, start + b"\x07" * 300)
        for line in (("convert", name, "-o", "n.ply"), ("render", name, "--orbit", 1, "-o", "n.png")):
            expect(1, *line, err=f"{name}: {remedy}")
    ply("scene.pt", rows())
    check(expect_json("info", "scene.pt")["scenes"][0]["gaussians"] == COUNT, "a scene of another suffix")


def two_writers():
    """A recording that another process writes is not written, and stays."""
    with open("two.mcap.part", "wb") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        expect(1, "capture", "--source", "replay:room.mcap", "--quiet", "-o", "two.mcap", err="another process records to it")
    check(not os.path.exists("two.mcap"), "a capture beside another one")
    expect(0, "capture", "--source", "replay:room.mcap", "--quiet", "-o", "two.mcap")
    before = open("two.mcap", "rb").read()
    with open("two.mcap", "rb") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        code, _, error = run("capture", "--source", "replay:room.mcap", "--quiet", "--force", "-o", "two.mcap")
        check(code == 1 and "another process records to it" in error, f"over a recording that grows: {code} {error}")
    check(open("two.mcap", "rb").read() == before, "what another process records")


in_scratch(lenses_of_poses, one_bad_gaussian, floats_far_from_the_origin, closed_streams, files_of_the_kernel,
           kinds_that_are_not_read, two_writers)
