# SPDX-License-Identifier: Apache-2.0
"""The room written as each kind of folder, and what import makes of one."""

import json
import os
import struct

import numpy as np
from checks import check
from frames import exr, picture, read
from program import run

WIDTH, HEIGHT, FRAMES = 64, 48, 3
OPENGL = np.diag([1, -1, -1, 1])  # axes of its cameras in ours
UNIT = 0.001
ROOM = {}  # the frames of the room, by topic


def make_room():
    """Fills ROOM."""
    status, _, error = run("room", "--frames", str(FRAMES), "--size", f"{WIDTH}x{HEIGHT}", "-o", "room.mcap")
    check(status == 0, f"room: {error}")
    ROOM.update(read("room.mcap"))


def write(path, content):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb" if isinstance(content, bytes) else "w") as file:
        file.write(content)
    return path


def quaternion(r):
    """Returns the quaternion w x y z of a rotation, by its largest component."""
    squares = np.array([1 + r[0, 0] + r[1, 1] + r[2, 2], 1 + r[0, 0] - r[1, 1] - r[2, 2],
                        1 - r[0, 0] + r[1, 1] - r[2, 2], 1 - r[0, 0] - r[1, 1] + r[2, 2]])
    products = np.array([[squares[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
                         [r[2, 1] - r[1, 2], squares[1], r[1, 0] + r[0, 1], r[0, 2] + r[2, 0]],
                         [r[0, 2] - r[2, 0], r[1, 0] + r[0, 1], squares[2], r[2, 1] + r[1, 2]],
                         [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[2, 1] + r[1, 2], squares[3]]])
    row = products[np.argmax(squares)]
    return row / np.linalg.norm(row)


def pictures(path, colour="{}.png", depth=None):
    for i in range(FRAMES):
        write(f"{path}/{colour.format(i)}", picture(ROOM["image"][i]))
        if depth:
            write(f"{path}/{depth.format(i)}", picture(ROOM["depth"][i]))


def imported(path, *options):
    """Imports the folder; returns the report and the recording."""
    target = f"{path}.mcap"
    status, out, error = run("import", path, "-o", target, "--json", *options)
    check(status == 0, f"{path} {options}: {error}")
    return (json.loads(out), read(target)) if status == 0 else ({}, {})


def refused(path, why, *options):
    status, out, error = run("import", path, "-o", f"{path}.mcap", *options)
    check(status == 1 and out == "" and why in error, f"{path}: {status}, {error.strip()!r} does not say {why!r}")
    check(not os.path.exists(f"{path}.mcap"), f"{path}: a recording is left behind")


def same(name, got, depth=True):
    """Checks that it is the room: poses and intrinsics up to the rounding of the file and of fixed point."""
    for what in ("image", "depth") if depth else ("image",):
        check(np.array_equal(got.get(what, []), ROOM[what]), f"{name}: {what}")
    check(depth or "depth" not in got, f"{name}: there is depth")
    for what, most in (("pose", 1e-6), ("camera_info", 1e-3)):
        off = np.abs(np.stack(got[what]) - np.stack(ROOM[what])).max() if what in got else np.inf
        check(off < most, f"{name}: {what} is off by {off}")


def transforms(path, depth_key="depth_file_path", change=None, **top):
    """Writes the file as nerfstudio does."""
    pictures(path, "images/frame_{:05d}.png", "depth/{:05d}.png")
    k = ROOM["camera_info"][0]
    frames = [{"file_path": f"images/frame_{i:05d}.png", depth_key: f"depth/{i:05d}.png", "colmap_im_id": i + 1,
               "transform_matrix": (pose @ OPENGL).tolist()} for i, pose in enumerate(ROOM["pose"])]
    content = {"camera_model": "OPENCV", "fl_x": k[0, 0], "fl_y": k[1, 1], "cx": k[0, 2] + 0.5, "cy": k[1, 2] + 0.5,
               "w": WIDTH, "h": HEIGHT, "k1": 0, "k2": 0, "p1": 0, "p2": 0, "applied_transform": np.eye(4)[:3].tolist(),
               "ply_file_path": "sparse_pc.ply", **top, "frames": frames}
    if change:
        change(content)
    write(f"{path}/transforms.json", json.dumps(content))
    return path


def colmap_lists():
    """Returns (number, model, sides, parameters) of a camera, and (number, quaternion, translation, camera, name) of
    images, in another order."""
    k = ROOM["camera_info"][0]
    camera = (7, 1, (WIDTH, HEIGHT), (k[0, 0], k[1, 1], k[0, 2] + 0.5, k[1, 2] + 0.5))
    images = []
    for i in (*range(2, FRAMES), 0, 1):
        inverse = np.linalg.inv(ROOM["pose"][i])
        images.append((i + 5, quaternion(inverse[:3, :3]), inverse[:3, 3], 7, f"view_{i}.png"))
    return camera, images


def colmap_text(path):
    (number, _, sides, parameters), images = colmap_lists()
    write(f"{path}/cameras.txt", f"# Camera list\n{number} PINHOLE {sides[0]} {sides[1]} "
          + " ".join(f"{p:.17g}" for p in parameters) + "\n")
    lines = ["# Image list with two lines of data per image:"]
    for number, q, t, camera, name in images:
        lines.append(f"{number} " + " ".join(f"{v:.17g}" for v in (*q, *t)) + f" {camera} {name}")
        lines.append("1.5 2.5 -1 30.25 40 12" if number % 2 else "")  # points, or none
    write(f"{path}/images.txt", "\n".join(lines) + "\n")
    write(f"{path}/points3D.txt", "# no points\n")


def colmap_binary(path):
    (number, model, sides, parameters), images = colmap_lists()
    write(f"{path}/cameras.bin", struct.pack("<QIiQQ4d", 1, number, model, *sides, *parameters))
    data = struct.pack("<Q", len(images))
    for number, q, t, camera, name in images:
        points = [(1.5, 2.5, -1)] * (number % 3)
        data += struct.pack("<I7dI", number, *q, *t, camera) + name.encode() + b"\0" + struct.pack("<Q", len(points))
        data += b"".join(struct.pack("<ddq", *p) for p in points)
    write(f"{path}/images.bin", data)


def colmap(path, place="sparse/0", lists=colmap_text, depth=None):
    pictures(path, "images/view_{}.png", depth)
    lists(f"{path}/{place}")
    return path


def matrix_text(m):
    return "\n".join(" ".join(f"{v:.17g}" for v in row) for row in m) + "\n"


def pose_files(path, depth=True, lens=True):
    """Writes the files like ScanNet's exporter."""
    pictures(path, "color/{}.png", "depth/{}.png" if depth else None)
    for i, pose in enumerate(ROOM["pose"]):
        write(f"{path}/pose/{i}.txt", matrix_text(pose))
    full = np.eye(4)
    full[:3, :3] = ROOM["camera_info"][0]
    if lens:
        write(f"{path}/intrinsic/intrinsic_color.txt", matrix_text(full))
        write(f"{path}/intrinsic/intrinsic_depth.txt", matrix_text(full))
        write(f"{path}/intrinsic/extrinsic_color.txt", matrix_text(np.eye(4)))
    return path


def seven_scenes(path, lens=True):
    """Writes a sequence like 7-Scenes: one folder, with 65535 for missing depth."""
    pictures(path, "frame-{:06d}.color.png")
    for i, pose in enumerate(ROOM["pose"]):
        depth = np.array(ROOM["depth"][i])
        depth[depth == 0] = 65535
        depth[0, :5] = 65535
        write(f"{path}/frame-{i:06d}.depth.png", picture(depth))
        write(f"{path}/frame-{i:06d}.pose.txt", matrix_text(pose))
    if lens:
        write(f"{path}/camera-intrinsics.txt", matrix_text(np.array(ROOM["camera_info"][0])))
    return path


def record3d(path, as_exr=False, packed=False, change=None):
    """Writes a Record3D export; the depth of an .r3d as after `lzfse -decode`, or packed."""
    pictures(path, "rgb/{}.png" if as_exr else "rgbd/{}.png")
    k = np.array(ROOM["camera_info"][0])
    k[:2, 2] += 0.5
    poses = []
    for i, pose in enumerate(ROOM["pose"]):
        w, x, y, z = quaternion((pose @ OPENGL)[:3, :3])
        poses.append([x, y, z, w, *pose[:3, 3]])
        metres = (ROOM["depth"][i] * UNIT).astype("<f4")
        metres[ROOM["depth"][i] == 0] = np.nan
        raw = b"bvx2" + bytes(99) if packed else metres.tobytes()
        write(f"{path}/depth/{i}.exr" if as_exr else f"{path}/rgbd/{i}.depth", exr(metres) if as_exr else raw)
    content = {"w": WIDTH, "h": HEIGHT, "dw": WIDTH, "dh": HEIGHT, "fps": 60, "K": k.T.flatten().tolist(), "poses": poses,
               "perFrameIntrinsicCoeffs": [[k[0, 0], k[1, 1], k[0, 2], k[1, 2]]] * FRAMES}
    if change:
        change(content)
    write(f"{path}/{'metadata.json' if as_exr else 'metadata'}", json.dumps(content))
    return path


def tum(path):
    """Writes the lists of TUM RGB-D, with depth in its own steps."""
    pictures(path, "rgb/{}.png")
    lines = {"rgb": "", "depth": "", "groundtruth": ""}
    for i, pose in enumerate(ROOM["pose"]):
        write(f"{path}/depth/{i}.png", picture((ROOM["depth"][i] * 5).astype(np.uint16)))
        w, x, y, z = quaternion(pose[:3, :3])
        lines["rgb"] += f"{i}.0 rgb/{i}.png\n"
        lines["depth"] += f"{i}.0 depth/{i}.png\n"
        lines["groundtruth"] += f"{i}.0 " + " ".join(f"{v:.17g}" for v in (*pose[:3, 3], x, y, z, w)) + "\n"
    for name, text in lines.items():
        write(f"{path}/{name}.txt", text)
    return path


def lens_option():
    k = ROOM["camera_info"][0]
    return "--intrinsics", f"{k[0, 0]},{k[1, 1]},{k[0, 2]},{k[1, 2]}"
