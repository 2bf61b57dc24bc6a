#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""context.py TRIM3R: the frames of a scene, as --context names them: lists, ranges, all, and those that are chosen; and a
warning where they do not belong together."""
import json
import os

from program import check, expect, expect_json, in_scratch, room, run, write


def hash_of(context, *options):
    return expect_json("build", "room.mcap", "--context", context, "--keep", 10, "-o", "s.ply", *options)["hash"]


def context_of(context, *options, name="room.mcap"):
    return expect_json("build", name, "--context", context, "--keep", 10, "-o", "s.ply", *options)["context"]


def lists_and_ranges():
    room()
    check(hash_of("0-2") == hash_of("0,1,2") == hash_of("0:2"), "0-2 is not 0,1,2")
    check(context_of("1:5:2") == [1, 3, 5] and context_of("0:4:3,5") == [0, 3, 5], "steps")
    check(context_of("all") == list(range(6)), "all")
    for text, why in {"3-0": "ends before it begins", "0:5:0": "steps of 0", "0-16": "names too many",
                      "0:4294967295": "names too many"}.items():
        expect(2, "build", "room.mcap", "--context", text, "--keep", 10, "-o", "s.ply", err=why)
    for text in ("0-", "-1", "0,,1", "auto,1", "4294967296"):
        expect(2, "build", "room.mcap", f"--context={text}", "--keep", 10, "-o", "s.ply", err="takes numbers and ranges")
    expect(2, "build", "room.mcap", "--context", "0-2,1", "--keep", 10, "-o", "s.ply", err="names frame 1 twice")
    expect(1, "build", "room.mcap", "--context", "5-7", "--keep", 10, "-o", "s.ply", err="there is no frame 6")
    code, _, message = run("view", "room.mcap", "--compare", "3-5", "--context", "0:2:2", "-o", "v.html")
    check(code == 0 or "without the page" in message, f"view: {message}")


def chosen_frames():
    room("64x64", "long.mcap", frames=24)
    expect(1, "build", "long.mcap", "--context", "all", "--keep", 10, "-o", "s.ply", err="--context auto chooses them")
    for options in ((), ("--depth", "stereo")):
        chosen = context_of("auto", *options, name="long.mcap")
        check(chosen == sorted(set(chosen)) and 2 <= len(chosen) <= 16, f"auto {options}: {chosen}")
        check(chosen == context_of("auto", *options, name="long.mcap"), f"auto {options} chooses other frames again")
        check(chosen[-1] - chosen[0] > 12, f"auto {options} leaves half of the arc unseen: {chosen}")
    listed = ",".join(map(str, context_of("auto")))
    check(hash_of("auto") == hash_of(listed), "auto is not the frames that it names")
    expect(2, "build", "room.mcap", "--context", "auto", "--poses", "estimate", "--keep", 10, "-o", "s.ply",
           err="first trim3r import room.mcap --poses estimate")


def in_other_commands():
    chosen = expect_json("replay", "room.mcap", "--context", "auto")
    check(chosen["context"] == context_of("auto"), f"replay: {chosen['context']}")
    expect(2, "replay", "room.mcap", "--stream", "--context", "auto", err="takes no --context")
    for text in ("all", "auto", "0:5:2"):
        rows = expect_json("eval", "room.mcap", "--context", text, "--target", 1, "--keep", 10)
        check("1" not in json.dumps([row["context"] for row in rows["rows"]]).replace("10", ""), f"eval {text}: the target is used")
    expect(2, "eval", "room.mcap", "--context", "auto", "--target", 1, "--views", 4, "--keep", 10, err="not to all or auto")
    expect(2, "capture", "--source", "replay:room.mcap", "--build", "s.ply", "--context", "all", err="need a recording")


def strangers():
    expect(0, "build", "room.mcap", "--context", "0,2", "--keep", 100, "-o", "whole.ply")
    os.mkdir("place")
    expect(0, "render", "whole.ply", "room.mcap", "--view", 0, "-o", "place/a.png", "--depth", "place/d.png")
    for name, sign in (("same", 1), ("other", -1)): # the second camera looks as the first, or the other way
        frames = [{"file_path": "a.png", "depth_path": "d.png",
                   "transform_matrix": [[way, 0, 0, 0.05 * i], [0, 1, 0, 0], [0, 0, way, 0], [0, 0, 0, 1]]}
                  for i, way in enumerate((1, sign))]
        write("place/transforms.json", json.dumps({"fl_x": 55, "fl_y": 55, "cx": 32, "cy": 32, "frames": frames,
                                                   "integer_depth_scale": 0.001}))
        expect(0, "import", "place", "-o", f"{name}.mcap")
        code, _, message = run("build", f"{name}.mcap", "--context", "0,1", "--keep", 10, "-o", "s.ply")
        check(code == 0 and ("frames 0 and 1 share 0 %" in message) == (name == "other"), f"{name}: {code} {message}")
    check("share" not in run("build", "room.mcap", "--context", "0-5", "--keep", 10, "-o", "s.ply")[2], "the room is one place")


if __name__ == "__main__":
    in_scratch(lists_and_ranges, chosen_frames, in_other_commands, strangers)
