# SPDX-License-Identifier: Apache-2.0
"""Lists of poses: every command that reads one leaves out the same bad poses, counts and names them; --strict refuses
them, and so does each command a list without a good one.

pose_lists.py TRIM3R
"""

import json
import os
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not there")
    sys.exit(77)

from checks import check, done  # noqa: E402
from folder_makers import lens_option, make_room, tum  # noqa: E402
from program import expect, run, write  # noqa: E402
import ros_bag as ros  # noqa: E402
from ros_bag import Bag, SECOND  # noqa: E402

UPRIGHT = (0, 0, 0, 1)  # x y z w
NAN, INF = float("nan"), float("inf")
BAD = {"a number that is none": ((NAN, 0, 0), UPRIGHT), "an infinite one": ((0, INF, 0), UPRIGHT),
       "a place too far": ((0, 0, 2e9), UPRIGHT), "a rotation of NaN": ((0, 0, 0), (0, NAN, 0, 1)),
       "no rotation": ((0, 0, 0), (0, 0, 0, 0))}


def tum_line(i, place, turn):
    return f"{i}.0 " + " ".join(map(str, (*place, *turn))) + "\n"


def euroc_line(i, place, turn):
    return f"{i * SECOND}," + ",".join(map(str, (*place, turn[3], *turn[:3]))) + "\n"


class Command:
    """A command that reads a list. `poses`: those of its report that were used, by an option or a key."""

    def __init__(self, name, make, *line):
        self.name, self.make, self.line = name, make, line

    def __call__(self, poses, *options, stamps=range(9)):
        self.make(poses, stamps)
        return run(*self.line, *options, "--json")


def text_of(line, path):
    return lambda poses, stamps: write(path, "# a comment\n" + "".join(line(i, *pose) for i, pose in zip(stamps, poses)))


def bag_of(path):
    def make(poses, stamps):
        bag = Bag()
        for i, pose in zip(stamps, poses):
            bag.put("/pose", ros.POSE, (i + 1) * SECOND, ros.pose((i + 1) * SECOND, "map", *pose))
        bag.write(path)
    return make


def matrices(path):
    """A transforms.json; of a bad pose only the matrix is bad, as JSON has no NaN."""
    def make(poses, _):
        frames = [{"file_path": f"{i}.png",
                   "transform_matrix": (np.eye(4) if all(map(np.isfinite, (*place, *turn))) and any(turn) and max(place) < 1e9
                                        else np.diag([1, 1, 0, 1])).tolist()} for i, (place, turn) in enumerate(poses)]
        write(path, json.dumps({"fl_x": 50, "w": 32, "h": 32, "frames": frames}))
    return make


def commands():
    view = ("--fov", 60, "--size", "32x32", "-o", "v.png")
    live = ("capture", "--source", "replay:room.mcap", "--hash")
    return [Command("render --trajectory, TUM", text_of(tum_line, "t.txt"), "render", "s.ply", "--trajectory", "t.txt", *view),
            Command("render --trajectory, EuRoC", text_of(euroc_line, "e.csv"), "render", "s.ply", "--trajectory", "e.csv", *view),
            Command("render --pose", matrices("p.json"), "render", "s.ply", "--pose", "p.json", "-o", "v.png"),
            Command("capture --poses, TUM", text_of(tum_line, "t.txt"), *live, "--poses", "t.txt"),
            Command("capture --poses, EuRoC", text_of(euroc_line, "e.csv"), *live, "--poses", "e.csv"),
            Command("capture --poses, a bag", bag_of("b.mcap"), *live, "--poses", "b.mcap"),
            Command("import", text_of(tum_line, "tum/groundtruth.txt"), "import", "tum", *lens_option(), "-o", "t.mcap")]


def named(command, what, told):
    """Whether the command names the second pose."""
    if "bag" in command.name:
        return ("pose 1" if what == "a place too far" else "at byte") in told
    return ("frames[1]" if "--pose" in command.line else "line 3") in told


def one_is_left_out(command):
    good = [((0.1 * i, 0, 0), UPRIGHT) for i in range(3)]
    code, out, error = command(good)
    check(code == 0 and "left out" not in error and json.loads(out).get("poses_left_out", 0) == 0, f"{command.name}: {error}")
    for what, bad in BAD.items():
        code, out, error = command([good[0], bad, good[2]])
        told = error if command.line[0] != "import" else "".join(json.loads(out or "{}").get("left_out", []))
        check(code == 0 and "left out: 1" in told, f"{command.name}, {what}: {code}, {told} {error}")
        check(named(command, what, told), f"{command.name}, {what}: {told}")
        check(command.line[0] == "import" or json.loads(out)["poses_left_out"] == 1, f"{command.name}, {what}: {out}")
        code, out, error = command([good[0], bad, good[2]], "--strict")
        check(code == 1 and out == "" and "--strict refuses" in error and named(command, what, error),
              f"{command.name}, {what}, --strict: {code}, {error}")
        code, out, error = command([bad, bad])
        check(code == 1 and out == "", f"{command.name}, all are {what}: {code}, {out}")
    check(command(good, "--strict")[0] == 0, f"{command.name}: --strict takes a good list")


def repeated_stamps(command):
    """Of different poses of one time the first is kept; equal ones are no loss."""
    here, there = ((0, 0, 0), UPRIGHT), ((0.5, 0, 0), UPRIGHT)
    twice = (0, 1, 1, 2)
    hashes = set()
    for poses, stamps, losses in (([here] * 3, (0, 1, 2), 0), ([here] * 4, twice, 0), ([here, here, there, here], twice, 1)):
        code, out, error = command(poses, stamps=stamps)
        report = json.loads(out or "{}")
        message = error if command.line[0] != "import" else "".join(report.get("left_out", []))
        check(code == 0 and ("left out: 1; " in message and ".000000 is there twice" in message) == (losses == 1),
              f"{command.name}, {losses} repeated stamps: {code} {message}")
        hashes.add(report.get("frames_hash") or report["bytes"])
    check(len(hashes) == 1, f"{command.name}: not the first of two poses of a time: {hashes}")
    code, out, error = command([here, here, there, here], "--strict", stamps=twice)
    check(code == 1 and out == "" and "there twice" in error, f"{command.name}, a repeated stamp, --strict: {code} {error}")


def rotations_of_any_length(command):
    turned = (0.0, 0.6, 0.0, 0.8)
    out = []
    for length in (1, 2, 0.25):
        code, text, error = command([((0.1, 0, 0), tuple(length * q for q in turned))] * 3)
        check(code == 0 and "left out" not in error, f"{command.name}, norm {length}: {error}")
        report = json.loads(text or "{}")
        out.append(report.get("hash") or report.get("frames_hash") or report["bytes"])
    check(len(set(out)) == 1, f"{command.name}: a rotation is its direction: {out}")


def lists_agree():
    """A path is the same in all lists, and rows of matrices are no poses."""
    turned = ((0.2, 0.1, 0), (0.0, 0.28, 0.0, 0.96))
    hashes = {command.name: json.loads(command([turned])[1])["hash"] for command in commands()[:2]}
    check(len(set(hashes.values())) == 1, f"TUM and EuRoC: {hashes}")
    write("e.csv", "#timestamp, p_RS_R_x, ...\n" + euroc_line(1, *turned).strip() + ",0.1,0.2,0.3\n")
    faster = json.loads(run(*commands()[1].line, "--json")[1])["hash"]
    check(faster in hashes.values(), "velocities after the pose")
    for words in ("{0},0 0,1 0,0 0,0 0,0 0,0 0,0 1,0\n", "{0},0 0.1 0 0 0 0 0 1\n"):  # decimal commas are no table of EuRoC
        write("t.txt", "".join(words.format(i) for i in range(3)))
        for line in (commands()[0].line, commands()[3].line):
            code, _, error = run(*line)
            check(code == 1 and "line 1: more than eight numbers" in error, f"{line[0]}: decimal commas: {error}")
    write("kitti.txt", "1 0 0 0.5 0 1 0 0 0 0 1 0\n" * 3)
    for line in (commands()[0].line, commands()[3].line):
        code, _, error = run(*[{"t.txt": "kitti.txt"}.get(word, word) for word in line])
        check(code == 1 and "line 1: more than eight numbers" in error, f"{line[0]}: a matrix: {error}")
    expect(1, *commands()[3].line, "--pose-topic", "/pose", err="--pose-topic names a topic of a bag")


def byte_order_marks(command, path):
    """A list that an editor of Windows saved begins with a byte order mark, before a comment or a pose."""
    for comment in ("", "# a comment\n"):
        poses = [tum_line(i, (0.1 * i, 0, 0), UPRIGHT) for i in range(3)]
        found = []
        for mark in ("", "\ufeff"):
            write(path, (mark + comment + "".join(poses)).encode())
            code, out, error = run(*command.line, "--strict", "--json")
            check(code == 0 and "left out" not in error, f"{command.name}, {mark!r}{comment}: {error}")
            report = json.loads(out or "{}")
            found.append(report.get("hash", report.get("posed_frames")))
        check(found[0] is not None and found[0] == found[1], f"{command.name}: {found}")


def bags_of_poses_in_parts():
    os.makedirs("parts", exist_ok=True)
    for part in range(2):
        bag = Bag()
        for i in range(2):
            ns = (2 * part + i + 1) * SECOND
            bag.put("/pose", ros.POSE, ns, ros.pose(ns, "map", (i, 0, 0)))
        bag.write(f"parts/p_{part}.mcap")
    write("parts/metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths:\n    - p_0.mcap\n    - p_1.mcap\n")
    expect(0, "capture", "--source", "replay:room.mcap", "--hash", "--poses", "parts", "--json")


with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    make_room()
    tum("tum")
    expect(0, "build", "room.mcap", "--context", "0,1", "--gaussians", 50, "-o", "s.ply")
    for each in commands():
        one_is_left_out(each)
        if each.name != "render --pose":
            rotations_of_any_length(each)
        if each.line[0] != "render":
            repeated_stamps(each)
    lists_agree()
    byte_order_marks(commands()[0], "t.txt")
    byte_order_marks(commands()[6], "tum/groundtruth.txt")
    bags_of_poses_in_parts()
    done()
