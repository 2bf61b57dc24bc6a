# SPDX-License-Identifier: Apache-2.0
"""trim3r import, info and room for users: outputs, messages, exit statuses, and no partial files.

commands.py TRIM3R DATA
"""

import json
import os
import struct
import sys
import tempfile

from checks import check, done
from png import png
from program import run

data = os.path.abspath(sys.argv[2])


def picture(width, height, bits=8, channels=3, value=lambda x, y: 0):
    return png([b"".join(struct.pack(">H", value(x, y)) if bits == 16 else bytes([value(x, y) % 256] * channels)
                         for x in range(width)) for y in range(height)], bits, channels)


def write(path, content):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb" if isinstance(content, bytes) else "w") as file:
        file.write(content)


def scene(folder, count=3, change=None):
    """Makes a good folder of 40x30 pictures with depth, then applies `change`."""
    frames = []
    for i in range(count):
        write(f"{folder}/c{i}.png", picture(40, 30, value=lambda x, y: x * 5 + i))
        write(f"{folder}/d{i}.png", picture(40, 30, 16, 1, lambda x, y: 1000 + x + y))
        pose = [[1, 0, 0, i * 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        frames.append({"file_path": f"c{i}.png", "depth_path": f"d{i}.png", "transform_matrix": pose})
    top = {"fl_x": 35.0, "fl_y": 35.0, "cx": 20.0, "cy": 15.0, "w": 40, "h": 30, "integer_depth_scale": 0.002,
           "trim3r_triplets": [{"context": [0, 2], "target": 1}], "frames": frames}
    if change:
        change(top)
    write(f"{folder}/transforms.json", json.dumps(top))
    return folder


def refused(name, folder, expected, *options):
    """Expects exit status 1, one line with the reason, and neither a complete nor a partial recording."""
    target = f"{work}/out/{name}.mcap"
    os.makedirs(os.path.dirname(target), exist_ok=True)
    status, out, error = run("import", folder, "-o", target, *options)
    check(status == 1, f"{name}: exit status {status}, not 1")
    check(out == "", f"{name}: something on stdout")
    for text in expected:
        check(text in error, f"{name}: '{error.strip()}' does not say '{text}'")
    check(os.listdir(f"{work}/out") == [], f"{name}: left {os.listdir(f'{work}/out')} behind")


def test_good_folder():
    folder, target = scene(f"{work}/good"), f"{work}/good.mcap"
    status, out, error = run("import", folder, "-o", target, "--json")
    check(status == 0, f"good folder: {error}")
    report = json.loads(out)
    expected = {"frames": 3, "depth_frames": 3, "posed_frames": 3, "triplets": 1, "width": 40, "height": 30,
                "bytes": os.path.getsize(target), "border": [0] * 4, "skipped": 0, "left_out": [], "depth_left_out": [], "remarks": []}
    check(report == expected, f"good folder: {report}")
    status, out, _ = run("info", target, "--json")
    info = json.loads(out)
    check(status == 0 and info["frames"] == 3 and info["width"] == 40 and info["depth_height"] == 30, f"info: {info}")
    check(info["triplets"] == [{"context": [0, 2], "target": 1}], f"info's triplets: {info['triplets']}")
    check(info["clock"] == "synthetic" and info["bits_epoch"] >= 1 and info["note"] == "", "info's clock and epoch")
    check(abs(info["depth_unit"] - 0.002) < 1e-9, "info's depth unit")
    check(info["pairing"]["with_pose"] == 3 and info["pairing"]["with_intrinsics"] == 3, "info's pairing")
    topics = {s["topic"]: s["messages"] for s in info["streams"]}
    check(topics == {t: 3 for t in ("/camera/image", "/camera/depth", "/camera/camera_info", "/camera/pose", "/tf")}, f"streams: {topics}")
    check(info["streams"][0]["last_ns"] == 2 * 10**9 // 30, "stamps 1/30 s apart")
    status, out, _ = run("info", target)
    check(status == 0 and "--context 0,2 --target 1" in out and "3 frames" in out, "info as text")
    # a second run gives the same bytes, over the old file
    with open(target, "rb") as file:
        before = file.read()
    run("import", folder, "-o", target)
    with open(target, "rb") as file:
        check(file.read() == before, "importing twice gives the same file")
    status, out, _ = run("import", folder, "--size", "16x24", "-o", target, "--json")
    check(status == 0 and json.loads(out)["width"] == 16 and json.loads(out)["height"] == 24, "--size")


def test_tum_folder():
    folder = f"{work}/desk"
    write(f"{folder}/rgb/1.png", picture(40, 30))
    write(f"{folder}/depth/1.png", picture(40, 30, 16, 1))
    write(f"{folder}/rgb.txt", "1.0 rgb/1.png\n1.04 rgb/1.png\n9.0 rgb/1.png\n")
    write(f"{folder}/depth.txt", "1.01 depth/1.png\n")
    write(f"{folder}/groundtruth.txt", "1.0 0 0 0 0 0 0 1\n1.05 0 0 1 0 0 0 1\n")
    refused("tum", folder, ["intrinsics unknown", "--intrinsics"])
    target = f"{work}/tum.mcap"
    status, out, error = run("import", folder, "--intrinsics", "35,35,19.5,14.5", "-o", target, "--json")
    check(status == 0, f"TUM: {error}")
    report = json.loads(out)
    check((report["frames"], report["depth_frames"], report["skipped"]) == (2, 1, 1), f"TUM: {report}")
    check(report["left_out"] == ["rgb/1.png: no pose near it in time"], f"TUM: {report}")
    check(report["remarks"] == ["1 of 2 frames have no depth"], f"TUM: {report}")


def test_bad_folders():
    def without(field):
        return lambda top: top.pop(field)

    def frame(**fields):
        return lambda top: top["frames"][1].update(fields)

    where = ["transforms.json"]
    refused("missing_folder", f"{work}/nowhere", ["nowhere: No such file"])
    os.makedirs(f"{work}/nothing")
    refused("empty_folder", f"{work}/nothing", ["neither transforms.json nor rgb.txt"])
    refused("no_focal", scene(f"{work}/b1", change=lambda top: (top.pop("fl_x"), top.pop("fl_y"))),
            where + ["frames[0]: fl_x"])
    refused("no_unit", scene(f"{work}/b2", change=without("integer_depth_scale")), where + ["integer_depth_scale"])
    refused("nan", scene(f"{work}/b3", change=frame(fl_x=float("nan"))),
            ["--strict refuses what would be left out (frames: 1, depth: 0)", "frames[1]: fl_x: not a number"], "--strict")
    refused("skewed", scene(f"{work}/b4", change=frame(transform_matrix=[[1, 0.1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0],
                                                                          [0, 0, 0, 1]])),
            ["--strict refuses what would be left out (frames: 1, depth: 0)", "frames[1]: transform_matrix", "orthonormal"], "--strict")
    refused("size", scene(f"{work}/b7", change=frame(w=41)), ["--strict refuses what would be left out (frames: 1, depth: 0)", "c1.png: w: 41", "40 pixels wide"],
            "--strict")
    folder = scene(f"{work}/b12", change=lambda top: [top.pop(k) for k in ("w", "h", "cx", "cy")])
    write(f"{folder}/c2.png", picture(44, 30))
    refused("sizes_differ", folder, ["frame 2: c2.png: 44x30 pixels, but frame 0 has 40x30; give --size"])
    status, _, error = run("import", folder, "--size", "16x16", "-o", f"{work}/mixed.mcap")
    check(status == 0, f"sizes that differ with --size: {error}")
    refused("tiny_focal", scene(f"{work}/b13", change=lambda top: top.update(fl_x=20)), ["c0.png: fl_x, fl_y"],
            "--size", "8x8")
    good = scene(f"{work}/b14")
    status, _, error = run("import", good, "-o", f"{work}/no/such/place.mcap")
    check(status == 1 and "there is no folder '" in error and "place.mcap" in error, f"unwritable target: {status} {error}")
    status, _, error = run("import", good, "-o", work)
    check(status == 1 and "not a regular file" in error, f"a folder as target: {status} {error}")
    os.mkfifo(f"{work}/pipe")
    status, _, error = run("import", good, "-o", f"{work}/pipe")
    check(status == 1 and "not a regular file" in error, f"a pipe as target: {status} {error}")


def test_usage():
    for arguments in (["import"], ["import", "x"], ["import", "x", "y", "-o", "z"], ["import", "x", "-o", "z", "--no"],
                      ["import", "x", "-o", "z", "--size", "7x7"], ["import", "x", "-o", "z", "--size", "9"],
                      ["import", "x", "-o", "z", "--intrinsics", "1,2,3"],
                      ["import", "x", "-o", "z", "--intrinsics", "0,1,1,1"],
                      ["room"], ["room", "-o", "z", "--frames", "0"], ["room", "-o", "z", "--seed", "x"],
                      ["room", "-o", "z", "--size", "5000x5"], ["info"],
                      ["info", "a", "b", "--view", "1"]):
        status, out, error = run(*arguments)
        check(status == 2 and out == "" and error != "", f"usage: {arguments} gave {status}")
    for command in ("import", "info", "room"):
        status, out, _ = run(command, "--help")
        check(status == 0 and "Examples:" in out, f"{command} --help")


def test_room():
    first, second = f"{work}/room1.mcap", f"{work}/room2.mcap"
    status, out, error = run("room", "-o", first, "--json")
    check(status == 0, f"room: {error}")
    report = json.loads(out)
    expected = {"frames": 6, "depth_frames": 6, "triplets": 3, "width": 256, "height": 256,
                "bytes": os.path.getsize(first)}
    check({k: report[k] for k in expected} == expected, f"room: {report}")
    _, out, _ = run("room", "-o", second, "--json")
    check(json.loads(out)["hash"] == report["hash"], "the room is the same twice")
    with open(first, "rb") as a, open(second, "rb") as b:
        check(a.read() == b.read(), "the room's files are the same")
    _, out, _ = run("room", "--seed", "2", "--size", "32x24", "--frames", "4", "-o", second, "--json")
    other = json.loads(out)
    check(other["hash"] != report["hash"] and other["frames"] == 4 and other["triplets"] == 1, f"room: {other}")
    status, out, _ = run("info", first, "--json")
    info = json.loads(out)
    check(info["triplets"][0] == {"context": [0, 2], "target": 1} and len(info["triplets"]) == 3, "the room's triplets")
    status, _, error = run("room", "-o", f"{work}/no/room.mcap")
    check(status == 1 and "/no'" in error and "room.mcap" in error, "room: unwritable target")


def test_info_refuses():
    write(f"{work}/empty.mcap", b"")
    write(f"{work}/text.mcap", b"this is not a recording at all")
    for name in ("empty.mcap", "text.mcap", "missing.mcap"):
        status, out, error = run("info", f"{work}/{name}")
        check(status == 1 and out == "" and name in error, f"info {name}: {status} {error.strip()}")


def test_stereo_pair():
    """Checks two views: the triplet's context names the non-target one twice."""
    def pair(top):
        top.update(trim3r_triplets=[{"context": [1, 1], "target": 0}])

    target = f"{work}/pair.mcap"
    status, out, error = run("import", scene(f"{work}/pair", 2, pair), "-o", target)
    check(status == 0, f"pair: {error}")
    status, out, error = run("eval", target, "--keep", "50", "--json")
    check(status == 0, f"pair: {error}")
    row = json.loads(out)["rows"][0] if status == 0 else {}
    check((row.get("context"), row.get("target"), row.get("gaussians")) == ("1", "0", 600), f"pair: {row}")


def test_scenes():
    if not os.path.isdir(data):
        print(f"without the real scenes: nothing at {data}")
        return
    for name in sorted(os.listdir(data)):
        if not os.path.exists(f"{data}/{name}/transforms.json"):
            continue
        with open(f"{data}/{name}/transforms.json") as file:
            top = json.load(file)
        status, out, error = run("import", f"{data}/{name}", "--size", "256x256", "-o", f"{work}/s.mcap", "--json")
        check(status == 0, f"{name}: {error}")
        report = json.loads(out) if status == 0 else {}
        expected = {"frames": len(top["frames"]), "depth_frames": sum("depth_path" in f for f in top["frames"]),
                    "triplets": len(top["trim3r_triplets"]), "width": 256, "height": 256}
        check({k: report.get(k) for k in expected} == expected, f"{name}: {report}")


with tempfile.TemporaryDirectory() as work:
    for test in (test_good_folder, test_tum_folder, test_bad_folders, test_usage, test_room, test_info_refuses,
                 test_stereo_pair, test_scenes):
        test()
done()
