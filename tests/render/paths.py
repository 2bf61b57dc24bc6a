#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""paths.py TRIM3R: `trim3r render` along the cameras of other programs and around a scene, as pictures and as a
video."""
import json
import math
import os
import struct
import subprocess
import sys

try:
    import cv2
    import numpy
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

from program import TRIM3R, check, expect, expect_json, in_scratch, room, run, write  # noqa: E402

SIZE = {"fl_x": 220, "w": 64, "h": 48}


def read(path):
    return cv2.imread(path, cv2.IMREAD_UNCHANGED)


def prepare():
    expect(0, "build", room(), "--keep", 10, "--rim", "off", "-o", "scene.ply")
    write("pose.json", json.dumps({**SIZE, "transform_matrix": numpy.eye(4).tolist()}))
    write("path.txt", "0 0 0 0 0 0 0 1\n1 0 0 0.1 0 0 0 1\n")


def other_cameras():
    """One view as a frame of transforms.json, in Blender's fields, as a path of nerfstudio and as cameras.json."""
    turn = [[0.8, 0, -0.6, 0.1], [0, 1, 0, -0.2], [0.6, 0, 0.8, 0.3], [0, 0, 0, 1]]  # x right, y up, z backward
    frame = {**SIZE, "transform_matrix": turn}
    angle = 2 * math.atan(32 / 220)
    path = {"camera_type": "perspective", "render_width": 64, "render_height": 48, "fps": 12, "crop": None,
            "camera_path": [{"camera_to_world": sum(turn, []), "fov": math.degrees(2 * math.atan(24 / 220)), "aspect": 4 / 3}]}
    splat = [{"id": 0, "img_name": "a", "width": 64, "height": 48, "position": [row[3] for row in turn[:3]],
              "rotation": [[row[0], -row[1], -row[2]] for row in turn[:3]], "fx": 220, "fy": 220}]
    blender = {"camera_angle_x": angle, "frames": [{"file_path": "./train/r_0", "rotation": 0.1, "transform_matrix": turn}]}
    hashes = set()
    for name, cameras, more in (("frame", frame, []), ("path", path, []), ("splat", splat, []), ("blender", blender, ["--size", "64x48"])):
        write(f"{name}.json", json.dumps(cameras))
        for option in ("--pose", "--path"):
            hashes.add(expect_json("render", "scene.ply", option, f"{name}.json", *more, "-o", "c.png")["hash"])
    check(len(hashes) == 1, f"four files of one view: {hashes}")
    expect(1, "render", "scene.ply", "--pose", "blender.json", "-o", "c.png", err="w or h: missing, and no --size")
    step = path["camera_path"][0]
    for cameras, why in (({**path, "camera_type": "equirectangular"}, "camera_type"), ({**path, "camera_path": {}}, "camera_path"),
                         ({**path, "camera_path": []}, "no camera"), ({**path, "camera_path": [{**step, "fov": 180}]}, "fov"),
                         ({**path, "camera_path": [{**step, "camera_to_world": sum(turn, [])[:15]}]}, "16 numbers"),
                         ({**path, "camera_path": [7]}, "not an object"), ({**path, "render_width": "wide"}, "w or h"),
                         ([{**splat[0], "rotation": turn[:2]}], "3 rows"), ([{**splat[0], "position": [0, 0]}], "position"),
                         ([{**splat[0], "fx": None}], "fx"), ([{**splat[0], "rotation": [[1, 0, 0]] * 3}], "orthonormal")):
        write("bad.json", json.dumps(cameras))
        expect(1, "render", "scene.ply", "--path", "bad.json", "-o", "c.png", err=why)
    write("two.json", json.dumps({**path, "camera_path": [step, {**step, "fov": 0}, step]}))
    found = expect_json("render", "scene.ply", "--path", "two.json", "-o", "c.png")
    check(found["views"] == 2 and found["poses_left_out"] == 1, f"a bad step of a path: {found}")
    expect(2, "render", "scene.ply", "--pose", "two.json", "--trajectory", "path.txt", "-o", "c.png", err="takes one")


def turntables():
    seen = expect_json("render", "scene.ply", "room.mcap", "--view", 1, "-o", "v.png")["hash"]
    found = expect_json("render", "scene.ply", "room.mcap", "--view", 1, "--orbit", 4, "-o", "o.png")
    check(found["views"] == 4 and os.path.exists("o_0003.png"), f"{found}")
    check((read("o_0000.png") == read("v.png")).all(), "a turntable from a view begins elsewhere")
    check(expect_json("render", "scene.ply", "room.mcap", "--view", 1, "--orbit", 1, "-o", "o.png")["hash"] == seen, "one view is the view")
    found = expect_json("render", "scene.ply", "room.mcap", "--view", 1, "--orbit", 3, "--arc", 10, "-o", "arc.png")
    check(found["views"] == 3 and (read("arc_0001.png") == read("v.png")).all(), "a view is not in the middle of its arc")
    near = [numpy.abs(read(f"{name}.png").astype(int) - read("v.png")).mean() for name in ("arc_0000", "arc_0002", "o_0001")]
    check(0 < max(near[:2]) < near[2], f"an arc is no part of a turn: {near}")
    expect(2, "render", "scene.ply", "--pose", "pose.json", "--arc", 10, "-o", "w.png", err="--arc belongs to --orbit")
    expect(2, "render", "scene.ply", "--orbit", 3, "--arc", 361, "-o", "w.png", err="--arc")
    # around and from above, the scene stays in the picture
    alone = expect_json("render", "scene.ply", "--orbit", 3, "--alpha", "a.png", "-o", "t.png")
    check((alone["width"], alone["height"]) == (640, 480), f"{alone}")
    for i in range(3):
        alpha = read(f"a_000{i}.png")
        rim = numpy.concatenate([alpha[0], alpha[-1], alpha[:, 0], alpha[:, -1]])
        check(alpha.max() > 60000 and rim.max() < 30000, f"view {i} of a turntable does not frame the scene: {rim.max()}")
    wide = expect_json("render", "scene.ply", "--orbit", 3, "--fov", 60, "--size", "640x480", "-o", "w.png")
    check(wide["hash"] == alone["hash"], "60 degrees are not the default")
    names = "x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3".split()
    header = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + "".join(f"property float {name}\n" for name in names)
    write("one.ply", header.encode() + b"end_header\n" + struct.pack("<14f", 7, 8, 9, 1, 0, 0, 3, -3, -3, -3, 1, 0, 0, 0))
    code, _, error = run("render", "one.ply", "--orbit", 2, "-o", "w.png")
    check(code == 0 and "shows nothing" not in error and read("w_0001.png").max() > 100, f"a scene of one Gaussian: {error}")
    axes = {up: expect_json("render", "scene.ply", "--orbit", 3, "--up", up, "--size", "64x48", "-o", "w.png")["hash"]
            for up in ("x", "-x", "y", "-y", "z", "-z")}
    check(len(set(axes.values())) == 6, f"axes that point up: {axes}")
    expect(0, "build", room(), "--working", "64x64", "--gaussians", 900, "--backdrop", "on", "-o", "far.ply")
    expect(0, "convert", "far.ply", "--crop=-99,-99,-99,99,99,99", "-o", "near.ply")  # without its backdrop
    for name in ("far", "near"):
        expect(0, "render", f"{name}.ply", "--orbit", 2, "--size", "64x48", "--depth", f"{name}.depth.png", "-o", "w.png")
    check((read("far.depth_0001.png") == read("near.depth_0001.png")).all(), "a backdrop moves the camera of a turntable")
    expect(2, "render", "scene.ply", "--orbit", 3, "--trajectory", "path.txt", "-o", "w.png", err="exclude")
    expect(2, "render", "scene.ply", "--pose", "pose.json", "--up", "z", "-o", "w.png", err="--orbit")
    expect(2, "render", "scene.ply", "--orbit", 0, "-o", "w.png", err="--orbit")
    expect(2, "render", "scene.ply", "--pose", "two.json", "--orbit", 3, "-o", "w.png", err="takes one")


# Stands for ffmpeg: keeps its arguments and what it reads.
ENCODER = """#!/bin/sh
for last; do :; done
echo "$@" > line.txt
cat > raw.rgb
[ -e fail ] && exit 1
printf '\\000\\000\\000\\040ftypisom' > "$last"
"""


def videos():
    os.mkdir("bin")
    write("bin/ffmpeg", ENCODER)
    os.chmod("bin/ffmpeg", 0o755)

    def film(path, *options):
        line = ["render", "scene.ply", "--orbit", "3", "--size", "33x21", *options]
        return subprocess.run([TRIM3R, *line], capture_output=True, text=True, env={**os.environ, "PATH": path})

    with_it = f"{os.getcwd()}/bin:{os.environ['PATH']}"
    expect(0, "render", "scene.ply", "--orbit", 3, "--size", "33x21", "-o", "f.png")
    done = film(with_it, "-o", "f.mp4")
    check(done.returncode == 0 and "3 views" in done.stdout, f"a video: {done}")
    check(open("raw.rgb", "rb").read() == b"".join(read(f"f_000{i}.png")[..., ::-1].tobytes() for i in range(3)), "other pictures than the PNGs")
    line = open("line.txt").read()
    check("-s 33x21 -r 24 " in line and "-f mp4 " in line and "yuv420p" in line, f"ffmpeg {line}")
    check(film(with_it, "-o", "f.webm", "--rate", "12.5").returncode == 0 and "-r 12.5 " in open("line.txt").read(), "--rate")
    check(film(with_it, "-o", "f.mp4").returncode == 0, "a video replaces a video")
    write("notes.mp4", "notes")
    check(film(with_it, "-o", "notes.mp4").returncode == 2 and open("notes.mp4").read() == "notes", "a video over notes")
    write("fail", "")
    for path, why in ((with_it, "ffmpeg failed"), ("/nothing", "not installed; -o NAME.png writes numbered pictures")):
        done = film(path, "-o", "none.mp4")
        check(done.returncode == 1 and why in done.stderr, f"{why}: {done}")
        check(not [name for name in os.listdir(".") if name.startswith("none")], f"{why}: a file is left")
    write("sizes.json", json.dumps([{"width": side, "height": 48, "position": [0, 0, 0], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
                                     "fx": 60, "fy": 60} for side in (64, 65)]))
    expect(2, "render", "scene.ply", "--path", "sizes.json", "-o", "s.mp4", err="differ in size: give --size")
    expect(2, "render", "scene.ply", "--orbit", 3, "--rate", 9, "-o", "s.png", err="--rate belongs to a video")


in_scratch(prepare, other_cameras, turntables, videos)
