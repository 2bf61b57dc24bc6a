# SPDX-License-Identifier: Apache-2.0
"""`info` of every folder that import reads: what it is and what import takes of it, or import's own refusal.

folder_info.py TRIM3R
"""

import json
import os
import shutil
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not there")
    sys.exit(77)

from checks import check, done  # noqa: E402
from folder_makers import (FRAMES, HEIGHT, ROOM, UNIT, WIDTH, colmap, colmap_binary, make_room,  # noqa: E402
                           pictures, pose_files, record3d, seven_scenes, transforms, tum, write)
from program import expect, expect_json, run  # noqa: E402
import ros_bag as ros  # noqa: E402
from ros_bag import Bag, SECOND  # noqa: E402

LENS = ("--intrinsics", "50,50,31.5,23.5")
KINDS = {"nerfstudio": (transforms, "transforms.json"), "colmap": (colmap, "COLMAP"),
         "binary": (lambda path: colmap(path, lists=colmap_binary), "COLMAP"), "scannet": (pose_files, "pose files"),
         "seven": (seven_scenes, "pose files"), "bare": (lambda path: pose_files(path, lens=False), "pose files"), "record3d": (record3d, "Record3D"),
         "exr": (lambda path: record3d(path, as_exr=True), "Record3D"),
         "tum": (tum, "TUM RGB-D")}


def kinds():
    for name, (make, kind) in KINDS.items():
        path = make(name)
        found = expect_json("info", path)
        if not found:
            continue
        check(found["kind"] == kind and found["frames"] == found["posed_frames"] == FRAMES, f"{name}: {found}")
        check((found["width"], found["height"]) == (WIDTH, HEIGHT), f"{name}: {found}")
        depth = 0 if kind == "COLMAP" else FRAMES
        check(found["depth_frames"] == depth, f"{name}: {found['depth_frames']} with depth")
        k = np.array(ROOM["camera_info"][0])
        if name not in ("tum", "bare"):
            check(np.allclose(found["intrinsics"], (k[0, 0], k[1, 1], k[0, 2], k[1, 2]), atol=1e-6), f"{name}: {found}")
            report = json.loads(expect(0, "import", path, "-o", "out.mcap", "--json"))
            check(all(found[key] == report[key] for key in ("frames", "depth_frames", "posed_frames", "width", "height", "triplets",
                                                            "left_out")), f"{name}: {found}, {report}")
        text = expect(0, "info", path)
        check(kind in text and f"{FRAMES} frames" in text and "poses: " in text, f"{name}: {text}")
        check(f"poses:    {FRAMES} of {FRAMES} frames\n" in text or found["posed_frames"] != FRAMES, f"{name}: {text}")


def units():
    check(abs(expect_json("info", "nerfstudio")["depth_unit"] - UNIT) < 1e-12, "the unit of depth")
    check("intrinsics" not in expect_json("info", "bare"), "pose files without a lens")
    found = expect_json("info", "tum")
    check(abs(found["depth_unit"] - 0.0002) < 1e-12 and "intrinsics" not in found, f"TUM's unit, and no lens: {found}")
    check("camera:   none: import needs --intrinsics" in expect(0, "info", "tum"), "TUM's lens")


def pictures_alone():
    pictures("alone")
    found = expect_json("info", "alone")
    check(found["kind"] == "pictures" and found["frames"] == FRAMES and found["posed_frames"] == 0, f"{found}")
    text = expect(0, "info", "alone")
    check("--poses estimate" in text and "--intrinsics" in text, text)
    write("alone/rec.mcap", b"")  # what import wrote there before
    check(expect_json("info", "alone")["frames"] == FRAMES, "a recording beside the pictures")


def same_refusal():
    """What import refuses, info refuses for the same reason."""
    cases = {"rgbd_freiburg3": tum("rgbd_freiburg3"), "size": transforms("size", change=lambda c: c.update(w=WIDTH + 2))}
    os.makedirs("empty")
    os.makedirs("webp")
    write("webp/a.webp", b"x")
    os.makedirs("crashed")
    Bag().write("crashed/part_0.mcap")
    cases.update(empty="empty", webp="webp", crashed="crashed")
    words = {"rgbd_freiburg3": "lies outside the picture", "size": "w: 66", "empty": "no pictures", "webp": "dwebp", "crashed": "ros2 bag reindex"}
    for name, path in cases.items():
        code, out, error = run("info", path)
        check(code == 1 and out == "" and words[name] in error, f"info {name}: {code}, {error}")
        code, _, told = run("import", path, "-o", "out.mcap", *(["--poses", "estimate", *LENS] if name == "empty" else []))
        check(code == 1 and (words[name] in told or name == "empty"), f"import {name}: {told}")
    write("films/film.webp", b"RIFF\1\0\0\0WEBP")
    for command in (("info", "films/film.webp"), ("import", "films/film.webp", "-o", "out.mcap")):
        expect(1, *command, err="dwebp")


def bag_folders():
    os.makedirs("bag")
    for part in range(2):
        bag = Bag()
        ns = (part + 1) * SECOND
        bag.put("/cam/image", ros.IMAGE, ns, ros.image(ns, "cam", "rgb8", ros.colour(part)))
        bag.write(f"bag/part_{part}.mcap")
    write("bag/metadata.yaml", "x:\n  relative_file_paths:\n    - part_0.mcap\n    - part_1.mcap\n")
    found = expect_json("info", "bag")
    check(found["frames"] == 2 and found["streams"][0]["topic"] == "/cam/image" and found["streams"][0]["use"] == "colour", f"{found}")
    expect(2, "info", "s.ply", "bag", err="--view")


def commands_of(path):
    """The commands that read a recording, each with the path in its place; view, the last, where the program has its page."""
    view = ("view", path, "--gaussians", 50, "-o", "out.html")
    commands = (("build", path, "--gaussians", 50, "-o", "out.ply"), ("render", "s.ply", path, "--view", 0, "-o", "out.png"),
                ("replay", path, "--gaussians", 50), ("eval", path, "--gaussians", 50), ("info", "s.ply", path, "--view", 0))
    return commands if "built without the page" in run(*view)[2] else (*commands, view)


def other_commands():
    """Commands that need a recording name the kind of each folder, and the command that converts it."""
    folders = {name: kind for name, (_, kind) in KINDS.items()} | {"alone": "pictures"}
    for path, kind in folders.items():
        options = " --poses estimate" if path == "alone" else ""
        for command in commands_of(path):
            expect(1, *command, err=f"{path}: a folder ({kind}); first make a recording of it: trim3r import {path}{options} -o")
    os.makedirs("unpacked")
    write("unpacked/meta.json", b"{}")
    words = {"empty": "no pictures", "crashed": "ros2 bag reindex", "unpacked": "zipped", "films/film.webp": "dwebp",
             "nothing": "No such file"}
    for path, word in words.items():
        for command in commands_of(path):
            expect(1, *command, err=word)
    for path in ("tum", "unpacked"):
        expect(1, "convert", path, "-o", "out.ply", err=f"{path}: a folder, not a scene file (an unpacked .sog")


def recording_in_a_folder():
    """A folder of rosbag2 is the recording that its files hold."""
    os.makedirs("stored")
    shutil.copy("room.mcap", "stored/part_0.mcap")
    write("stored/metadata.yaml", "x:\n  relative_file_paths:\n    - part_0.mcap\n")
    for command, whole in zip(commands_of("stored"), commands_of("room.mcap")):
        expect(0, *whole)
        expect(0, *command)
    for name in ("ply", "png"):
        expect(0, *commands_of("room.mcap")[0 if name == "ply" else 1][:-1], f"same.{name}")
        with open(f"out.{name}", "rb") as one, open(f"same.{name}", "rb") as other:
            check(one.read() == other.read(), f"out.{name} of the folder and of its file")
    expect(2, "build", "stored", "--gaussians", 50, "-o", "stored/part_0.mcap", err="stored/part_0.mcap")


with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    make_room()
    expect(0, "build", "room.mcap", "--context", "0,1", "--gaussians", 50, "-o", "s.ply")
    for test in (kinds, units, pictures_alone, same_refusal, bag_folders, other_commands, recording_in_a_folder):
        test()
    done()
