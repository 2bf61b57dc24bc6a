# SPDX-License-Identifier: Apache-2.0
"""reading.py TRIM3R OLDER [--write]: counts the instructions in which two programs read the same scenes, recordings, bags
and folders, by valgrind. It ends with 1 where TRIM3R takes over 5 % more than OLDER. --write puts the table into
docs/study/speed.md. Scenes count the reader alone; the others count `trim3r import`, without the start of the program."""
import os
import re
import subprocess
import sys
import tempfile

import numpy as np

import folder_makers
import ros_bag
from checks import check, done
from folder_makers import ROOM, UNIT, colmap, colmap_binary, lens_option, make_room, pose_files, record3d, transforms, tum
from program import TRIM3R, expect, run, write

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "study", "scripts"))
from measured import PAGES, table, write_block  # noqa: E402

folder_makers.WIDTH, folder_makers.HEIGHT, folder_makers.FRAMES = 320, 240, 24
MOST = 1.05
SCENES = ("ply", "compressed.ply", "splat", "spz", "glb", "sog")
READER = "scene_file_read" # of all formats, in both programs


def instructions(program, *command, only=None):
    """Returns the instructions of a command, or those within one function; None if the program refuses it."""
    counted = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *([f"--toggle-collect={only}"] if only else ())]
    ended = subprocess.run([*counted, program, *command], capture_output=True, text=True)
    return int(re.search(r"refs: +([\d,]+)", ended.stderr)[1].replace(",", "")) if ended.returncode == 0 else None


def ply(path):
    """Returns the header of a binary .ply, without its last line, and its numbers."""
    with open(path, "rb") as file:
        header, rows = file.read().split(b"end_header\n", 1)
    return header.decode(), np.frombuffer(rows, "<f4").reshape(-1, header.count(b"property"))


def text_of(path, name):
    header, numbers = ply(path)
    np.savetxt(name, numbers, "%.9g", comments="", header=header.replace("binary_little_endian", "ascii") + "end_header")
    return name


def with_harmonics(path, name):
    """Writes a .ply with harmonics of degree 3, which are random."""
    header, numbers = ply(path)
    rest = np.random.default_rng(0).normal(0, 0.1, (len(numbers), 45)).astype("<f4")
    write(name, header.encode() + b"".join(b"property float f_rest_%d\n" % i for i in range(45)) + b"end_header\n"
          + np.hstack((numbers, rest)).tobytes())
    return name


def bag(path, packed):
    """Writes the room as a bag of ROS 2: its colours as they are or as PNG."""
    out, k = ros_bag.Bag(), ROOM["camera_info"][0]
    sides = folder_makers.WIDTH, folder_makers.HEIGHT
    for i, pose in enumerate(ROOM["pose"]):
        ns = i * ros_bag.SECOND
        rgb = np.array(ROOM["image"][i])
        if packed:
            out.put("/cam/image/compressed", ros_bag.COMPRESSED, ns, ros_bag.compressed(ns, "cam", "png", folder_makers.picture(rgb)))
        else:
            out.put("/cam/image", ros_bag.IMAGE, ns, ros_bag.image(ns, "cam", "rgb8", rgb))
        out.put("/cam/depth", ros_bag.IMAGE, ns, ros_bag.image(ns, "cam", "16UC1", np.array(ROOM["depth"][i], "<u2")))
        out.put("/cam/camera_info", ros_bag.INFO, ns, ros_bag.info(ns, "cam", (k[0, 0], k[1, 1], k[0, 2], k[1, 2]), sides))
        w, x, y, z = folder_makers.quaternion(pose[:3, :3])
        out.put("/cam/pose", ros_bag.POSE, ns, ros_bag.pose(ns, "map", pose[:3, 3], (x, y, z, w)))
    out.write(path)
    return path


def inputs():
    """Yields the name of each input and the command that reads it."""
    expect(0, "build", "room.mcap", "--context", "0,2", "--gaussians", "40000", "-o", "scene.ply")
    for ending in SCENES:
        name = f"scene.{ending}"
        if ending != "ply":
            expect(0, "convert", "scene.ply", "-o", name)
        yield f"`.{ending}`", ("info", name)
    yield "`.ply` with harmonics", ("info", with_harmonics("scene.ply", "harmonics.ply"))
    yield "`.ply` as text", ("info", text_of("scene.ply", "text.ply"))

    def imported(name, *options):
        return ("import", name, *options, "-o", "out.mcap", "--force")

    for packing in ("none", "zstd", "lz4"):
        expect(0, "room", "--size", "320x240", "--frames", 24, "--compression", packing, "-o", f"{packing}.mcap")
        yield f"recording, {packing if packing != 'none' else 'uncompressed'}", imported(f"{packing}.mcap")
    yield "bag, images", imported(bag("images.mcap", False))
    yield "bag, PNG", imported(bag("png.mcap", True))
    yield "folder of nerfstudio", imported(transforms("nerfstudio"))
    yield "folder of COLMAP, text", imported(colmap("colmap", depth="depth/view_{}.png"), "--depth-unit", UNIT)
    yield "folder of COLMAP, binary", imported(colmap("binary", lists=colmap_binary, depth="depth/view_{}.png"), "--depth-unit", UNIT)
    yield "folder of TUM", imported(tum("tum"), *lens_option())
    yield "folder of ScanNet", imported(pose_files("scannet"))
    yield "folder of Record3D", imported(record3d("record3d"))


def main():
    older, rows, slower = os.path.abspath(sys.argv[2]), [], []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        make_room()
        start = {program: instructions(program, "--version") for program in (older, TRIM3R)}
        for name, words in inputs():
            command = [str(word) for word in words]
            only = READER if command[0] == "info" else None
            before, now = (instructions(program, *command, only=only) for program in (older, TRIM3R))
            check(now is not None, f"{name} is refused: {run(*command)}")
            if before is None:
                rows.append((name, "refused", f"{now / 1e6:.1f}", ""))
                continue
            before, now = ((before, now) if only else (before - start[older], now - start[TRIM3R]))
            rows.append((name, f"{before / 1e6:.1f}", f"{now / 1e6:.1f}", f"{now / before:.3f}"))
            slower += [name] if now > MOST * before else []
            print(*rows[-1], flush=True)
        rows.append(("start of the program", *(f"{start[p] / 1e6:.1f}" for p in (older, TRIM3R)), f"{start[TRIM3R] / start[older]:.3f}"))
    lines = list(table(("input", "before, millions", "now, millions", "ratio"), rows))
    print("\n".join(lines))
    if "--write" in sys.argv[3:]:
        write_block(os.path.join(PAGES, "speed.md"), "reading", lines)
    check(not slower, f"over {MOST} times the instructions: {', '.join(slower)}")


main()
done()
