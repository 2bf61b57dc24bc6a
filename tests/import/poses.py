# SPDX-License-Identifier: Apache-2.0
"""--poses estimate for users: pictures without poses become a recording with correct poses that later commands keep,
build estimates the poses of its context views, and impossible cases are refused with a reason.

poses.py TRIM3R
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
from frames import matrix, picture, read
from program import run

FRAMES = 4


def good(*arguments):
    status, out, error = run(*arguments, "--json")
    check(status == 0, f"{arguments}: {error}")
    return json.loads(out) if status == 0 else {}


def folder(name, room, depth=True, **top):
    """Writes the room's pictures and lens, without poses."""
    path = f"{work}/{name}"
    os.makedirs(path)
    frames = []
    for i, rgb in enumerate(room["image"]):
        k = room["camera_info"][i]
        frames.append({"file_path": f"{i}.png", "fl_x": k[0, 0], "fl_y": k[1, 1], "cx": k[0, 2] + 0.5, "cy": k[1, 2] + 0.5})
        with open(f"{path}/{i}.png", "wb") as file:
            file.write(picture(rgb))
        if depth:
            frames[-1]["depth_path"] = f"d{i}.png"
            with open(f"{path}/d{i}.png", "wb") as file:
                file.write(picture(room["depth"][i]))
    with open(f"{path}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"frames": frames, "integer_depth_scale": 0.001, **top}, file)
    return path


def relative(poses):
    return [np.linalg.inv(poses[0]) @ p for p in poses]


def degrees(a, b):
    return np.degrees(2 * np.arcsin(np.clip(np.linalg.norm(a[:3, :3] - b[:3, :3]) / np.sqrt(8), 0, 1)))


def close(name, poses, room, turn, share, scale=None):
    """Checks rotations within `turn` degrees, positions within `share` of the distance from the first camera."""
    for i, (got, known) in enumerate(zip(relative(poses), relative(room["pose"]))):
        place = got[:3, 3] * (scale or 1)
        far = np.linalg.norm(known[:3, 3])
        check(degrees(got, known) < turn, f"{name}: rotation of frame {i} is {degrees(got, known):.3f} degrees off")
        off = np.linalg.norm(place - known[:3, 3])
        check(off <= share * far + 1e-7, f"{name}: frame {i} is {off:.4f} off, {far:.3f} away")


def test_import(room):
    path = folder("rgbd", room)
    status, _, error = run("import", path, "-o", f"{work}/no.mcap")
    check(status == 1 and "frames[0]: transform_matrix: missing" in error, f"without --poses: {error}")
    report = good("import", path, "--poses", "estimate", "-o", f"{work}/rgbd.mcap")
    got = read(f"{work}/rgbd.mcap")
    check(np.array_equal(got["pose"][0], np.eye(4)), "the first frame is the origin")
    close("import, depth", got["pose"], room, 0.3, 0.04)
    check([p["frame"] for p in report["poses"]] == list(range(FRAMES)) and
          all(p["by_depth"] and p["matches"] > 100 for p in report["poses"][1:]), f"report: {report}")
    for t in (p[:3, 3] for p in got["pose"]):
        check(np.all(np.ldexp(t, 32) % 1 == 0), "positions are whole steps of 2^-32")
    with open(f"{work}/rgbd.mcap", "rb") as file:
        before = file.read()
    run("import", path, "--poses", "estimate", "-o", f"{work}/rgbd.mcap")
    with open(f"{work}/rgbd.mcap", "rb") as file:
        check(file.read() == before, "estimating twice gives the same file")
    # from colour alone: one camera distance is 1
    good("import", folder("rgb", room, depth=False), "--poses", "estimate", "-o", f"{work}/rgb.mcap")
    got = read(f"{work}/rgb.mcap")
    known, found = relative(room["pose"]), relative(got["pose"])
    gaps = [np.linalg.norm(a[:3, 3] - b[:3, 3]) for i, a in enumerate(found) for b in found[:i]]
    check(min(abs(g - 1) for g in gaps) < 1e-6, f"colour: no distance of 1 among {gaps}")
    scale = np.linalg.norm(known[-1][:3, 3]) / np.linalg.norm(found[-1][:3, 3])
    close("import, colour", got["pose"], room, 1.0, 0.1, scale)
    # TUM RGB-D without its groundtruth.txt
    path = folder("tum", room)
    os.remove(f"{path}/transforms.json")
    for i, depth in enumerate(room["depth"]):
        with open(f"{path}/d{i}.png", "wb") as file:
            file.write(picture(depth * 5))
    for name, prefix in (("rgb", ""), ("depth", "d")):
        with open(f"{path}/{name}.txt", "w", encoding="utf-8") as file:
            file.writelines(f"{i}.0 {prefix}{i}.png\n" for i in range(FRAMES))
    k = room["camera_info"][0]
    numbers = ",".join(repr(float(x)) for x in (k[0, 0], k[1, 1], k[0, 2], k[1, 2]))
    status, _, error = run("import", path, "--intrinsics", numbers, "-o", f"{work}/no.mcap")
    check(status == 1 and "groundtruth.txt" in error, f"TUM without --poses: {error}")
    good("import", path, "--intrinsics", numbers, "--poses", "estimate", "-o", f"{work}/tum.mcap")
    close("TUM", read(f"{work}/tum.mcap")["pose"], room, 0.3, 0.04)
    # pictures alone
    os.remove(f"{work}/rgb/transforms.json")
    good("import", f"{work}/rgb", "--intrinsics", numbers, "--poses", "estimate", "-o", f"{work}/alone.mcap")
    check(np.array_equal(np.stack(read(f"{work}/alone.mcap")["pose"]), np.stack(got["pose"])), "pictures alone")


def test_build(room):
    recording, scene = f"{work}/room.mcap", f"{work}/s.ply"
    report = good("build", recording, "--context", "0,2,3", "--keep", "5%", "--poses", "estimate", "-o", scene)
    check([p["frame"] for p in report["poses"]] == [0, 2, 3], f"build: {report}")
    poses = [matrix(p["rotation"], p["position"]) for p in report["poses"]]
    chosen = {"pose": [room["pose"][i] for i in (0, 2, 3)]}
    check(np.abs(poses[0] - room["pose"][0]).max() < 1e-8, "build: the first view keeps its pose")
    close("build", poses, chosen, 0.3, 0.04)
    again = good("build", recording, "--context", "0,2,3", "--keep", "5%", "--poses", "estimate", "-o", scene)
    check(report["hash"] == again["hash"], "build: the same bits twice")
    given = good("build", recording, "--context", "0,2,3", "--keep", "5%", "-o", scene)
    check(given["hash"] != report["hash"] and "poses" not in given, "build: given poses are others")
    colour = good("build", recording, "--keep", "5%", "--poses", "estimate-colour", "-o", scene)
    check([p["frame"] for p in colour["poses"]] == [0, 1] and not colour["poses"][1]["by_depth"], f"colour: {colour}")
    close("build, colour", [matrix(p["rotation"], p["position"]) for p in colour["poses"]],
          {"pose": room["pose"][:2]}, 0.6, 0.06)
    # a recording imported again, with poses: build makes the same of both
    good("import", recording, "--poses", "estimate", "-o", f"{work}/posed.mcap")
    first, second = read(recording), read(f"{work}/posed.mcap")
    for name in ("image", "depth", "camera_info"):
        check(np.array_equal(np.stack(first[name]), np.stack(second[name])), f"a recording once more: {name}")
    close("a recording once more", second["pose"], room, 0.3, 0.04)
    two = f"{work}/two.mcap"
    good("room", "--frames", "2", "-o", two)
    good("import", two, "--poses", "estimate", "-o", f"{work}/two_posed.mcap")
    here = good("build", two, "--keep", "5%", "--poses", "estimate", "-o", scene)
    there = good("build", f"{work}/two_posed.mcap", "--keep", "5%", "-o", scene)
    check(here["hash"] == there["hash"], "poses in the recording make the bits that poses at the build make")
    info, known = good("info", f"{work}/posed.mcap"), good("info", recording)
    check(all(info[k] == known[k] for k in ("triplets", "clock", "depth_unit", "frames")), f"info: {info}")
    status, _, error = run("import", recording, "--min-confidence", "1", "-o", f"{work}/no.mcap")
    check(status == 2 and "is a recording" in error, f"a recording with pointmaps: {error}")
    status, _, error = run("import", f"{work}/rgb/0.png", "--poses", "estimate", "-o", f"{work}/no.mcap")
    check(status == 1 and "0.png" in error, f"a picture as a recording: {error}")
    # later builds use the poses estimated into a recording
    stored = good("build", f"{work}/rgbd.mcap", "--keep", "5%", "-o", scene)
    check(stored["hash"] == good("build", f"{work}/rgbd.mcap", "--keep", "5%", "-o", scene)["hash"], "stored poses")


def kept_without_pose(name, source, room, left, why):
    """Checks that all frames are there, and all except the left-out one have their poses."""
    target = f"{work}/kept_{left}.mcap"
    report = good("import", source, "--poses", "estimate", "-o", target)
    check((report["frames"], report["posed_frames"]) == (FRAMES, FRAMES - 1), f"{name}: {report}")
    check([why in p.get("why", "") for p in report["poses"]] == [i == left for i in range(FRAMES)], f"{name}: {report}")
    others = {"pose": [p for i, p in enumerate(room["pose"]) if i != left]}
    close(name, read(target)["pose"], others, 0.3, 0.04)
    check(good("info", target)["pairing"]["with_pose"] == FRAMES - 1, f"{name}: info")
    return target


def test_refusals(room):
    status, out, error = run("build", f"{work}/room.mcap", "--keep", "5%", "--poses", "guess", "-o", f"{work}/s.ply")
    check(status == 2 and "estimate-colour" in error, f"usage: {error}")
    other = dict(room, image=list(room["image"]))
    other["image"][2] = np.random.default_rng(1).integers(0, 255, room["image"][2].shape).astype(np.uint8)
    kept = kept_without_pose("another place", folder("other", other), room, 2, "features")
    status, _, error = run("build", kept, "--context", "2,1", "--keep", "5%", "-o", f"{work}/s.ply")
    check(status == 1 and "frame 2 has no pose" in error, f"another place: build: {error}")
    other = dict(room, image=[np.full_like(room["image"][0], 90), *room["image"][1:]])
    kept = kept_without_pose("blank at the start", folder("blank_start", other), room, 0, "only 0 features match")
    os.rename(kept, f"{work}/blank.mcap")
    kept_without_pose("a recording", f"{work}/blank.mcap", room, 0, "only 0 features match")
    given = dict(room, image=room["image"][:2] + [other["image"][0]])
    for name in ("depth", "camera_info", "pose"):
        given[name] = room[name][:3]
    status, out, _ = run("import", folder("short", given), "--poses", "estimate", "-o", f"{work}/short.mcap")
    check(status == 0 and "without a pose: 1 frames" in out and "frame 2 cannot be posed from frame" in out, f"as text: {out}")
    status, _, error = run("build", f"{work}/short.mcap", "--context", "0,2", "--keep", "5%", "--poses", "estimate", "-o",
                           f"{work}/s.ply")
    check(status == 1 and "frame 2 cannot be posed from frame 0: only 0 features" in error, f"build needs all: {error}")
    still = dict(room, image=[room["image"][0]] * FRAMES)
    status, out, error = run("import", folder("still", still, depth=False), "--poses", "estimate", "-o", f"{work}/no.mcap")
    check(status == 1 and "no parallax" in error, f"a camera that stands still: {error}")
    # too many, reported before the first picture is opened: these are no pictures
    os.mkdir(f"{work}/many")
    for i in range(1001):
        with open(f"{work}/many/{i}.png", "wb"):
            pass
    many = "poses of 1001 frames: more than 1000"
    status, out, error = run("import", f"{work}/many", "--poses", "estimate", "--intrinsics", "90,90,48,48", "-o",
                             f"{work}/no.mcap")
    check(status == 1 and many in error, f"too many: {error}")
    small = dict(room, image=[np.full((16, 16, 3), 90, np.uint8)], depth=room["depth"][:1])
    path = folder("many_json", small, depth=False)
    with open(f"{path}/transforms.json", encoding="utf-8") as file:
        text = json.load(file)
    text["frames"] = [dict(text["frames"][0], cx=8, cy=8, transform_matrix=np.eye(4).tolist())] * 1001
    with open(f"{path}/transforms.json", "w", encoding="utf-8") as file:
        json.dump(text, file)
    good("import", path, "-o", f"{work}/many.mcap")
    status, out, error = run("import", f"{work}/many.mcap", "--poses", "estimate", "-o", f"{work}/no.mcap")
    check(status == 1 and many in error, f"too many in a recording: {error}")
    check(not os.path.exists(f"{work}/no.mcap"), "a recording is left behind")


with tempfile.TemporaryDirectory() as work:
    code, _, message = run("room", "--frames", str(FRAMES), "-o", f"{work}/room.mcap")
    check(code == 0, f"room: {message}")
    the_room = read(f"{work}/room.mcap")
    for test in (test_import, test_build, test_refusals):
        test(the_room)
done()
