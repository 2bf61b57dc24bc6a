# SPDX-License-Identifier: Apache-2.0
"""Folders from other programs: the room, written as each kind of folder, is imported with the same pictures, depth,
intrinsics and poses. Missing or unused contents are reported.

folders.py TRIM3R
"""

import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not there")
    sys.exit(77)

from checks import check, done  # noqa: E402
from frames import exr, picture, read  # noqa: E402
from program import run  # noqa: E402

WIDTH, HEIGHT, FRAMES = 64, 48, 3
OPENGL = np.diag([1, -1, -1, 1])  # axes of its cameras in ours
UNIT = 0.001


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


def test_nerfstudio():
    report, got = imported(transforms("nerfstudio"))
    same("nerfstudio", got)
    check(report["remarks"] == ["depth_unit_scale_factor: missing; a step of depth is taken as 0.001, nerfstudio's default"],
          f"nerfstudio: {report}")
    report, got = imported(transforms("scaled", depth_unit_scale_factor=UNIT))
    same("nerfstudio with its factor", got)
    check(report["remarks"] == [], f"nerfstudio with its factor: {report}")
    report, got = imported(transforms("both_names", "depth_path", integer_depth_scale=UNIT, depth_unit_scale_factor=UNIT))
    same("both names of the unit", got)

    def other(content):
        for frame in content["frames"]:
            frame["depth_map"] = frame.pop("depth_file_path")
        content["poses_bounds"] = "poses_bounds.npy"

    report, got = imported(transforms("unread", change=other))
    same("unread fields", got, depth=False)
    said = "this field is not read, though its name says depth or pose"
    check(report["remarks"] == [f"poses_bounds: {said}", f"frames[0]: depth_map: {said}",
                                "no frame has depth: build and replay need --depth stereo"], f"unread fields: {report}")
    refused(transforms("two_units", integer_depth_scale=0.5, depth_unit_scale_factor=UNIT), "integer_depth_scale")
    refused(transforms("two_paths", change=lambda c: c["frames"][1].update(depth_path="x.png")), "frames[1]: depth_file_path")
    refused(transforms("bad_unit", depth_unit_scale_factor=200), "depth_unit_scale_factor: not between")
    refused(transforms("no_unit", "depth_path"), "integer_depth_scale: missing")




def colmap_lists():
    """Returns (number, model, sides, parameters) of a camera, and (number, quaternion, translation, camera, name) of
    images, in another order."""
    k = ROOM["camera_info"][0]
    camera = (7, 1, (WIDTH, HEIGHT), (k[0, 0], k[1, 1], k[0, 2] + 0.5, k[1, 2] + 0.5))
    images = []
    for i in (2, 0, 1):
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


def test_colmap():
    for place in ("sparse/0", "sparse", "colmap/sparse/0", "."):
        for lists in (colmap_text, colmap_binary):
            name = f"{lists.__name__} in {place}"
            report, got = imported(colmap(f"{lists.__name__}_{place.replace('/', '_')}", place, lists))
            same(name, got, depth=False)
            check(report.get("remarks", [""])[-1] == "no frame has depth: build and replay need --depth stereo", f"{name}: {report}")
    refused(colmap("unit_unknown", depth="depth/view_{}.png"), "depth/view_0.png: depth, but nothing says", )
    report, got = imported(colmap("with_depth", depth="depth/view_{}.png"), "--depth-unit", str(UNIT))
    same("COLMAP with depth", got)
    path = colmap("without_depth")
    status, _, error = run("import", path, "--depth-unit", "1", "-o", "no.mcap")
    check(status == 1 and "--depth-unit is for pointmaps" in error, f"a unit of nothing: {error}")


def test_several_models():
    path = colmap("several")
    colmap_binary(f"{path}/sparse/3")
    report, got = imported(path)
    same("the first of several models", got, depth=False)
    check("sparse/3 is another model, which is not read; import several/sparse/3 reads it" in report["remarks"], f"{report}")
    same("another model by its own folder", imported(f"{path}/sparse/3")[1], depth=False)


def test_pictures_without_pose():
    """Checks that pictures missing in the lists are named."""
    path = colmap("passed_over")
    for name in ("view_10.png", "view_9.png", "notes.txt"):
        write(f"{path}/images/{name}", picture(ROOM["image"][0]))
    report, got = imported(path)
    same("passed over", got, depth=False)
    check(report["left_out"] == [f"images/view_{i}.png: the model has no pose of it" for i in (9, 10)], f"{report}")
    path = record3d("cut_short", change=lambda c: (c["poses"].pop(), c["perFrameIntrinsicCoeffs"].pop()))
    os.remove(f"{path}/rgbd/0.depth")
    report, _ = imported(path)
    check((report["frames"], report["skipped"]) == (2, 1), f"cut short: {report}")
    check(report["left_out"] == ["rgbd/2.png: there is no pose of it"], f"cut short: {report}")
    check(report["remarks"] == ["1 of 2 frames have no depth"], f"cut short: {report}")


def test_stereo_of_colmap():
    """Checks that build without depth names the missing depth, and makes a scene by stereo."""
    path = colmap("stereo")
    imported(path)
    arguments = ("build", "stereo.mcap", "--context", "0,1", "--gaussians", "50", "-o", "stereo.ply")
    status, _, error = run(*arguments)
    check(status == 1 and "--depth stereo" in error, f"without stereo: {error}")
    status, _, error = run(*arguments, "--depth", "stereo")
    check(status == 0, f"with stereo: {error}")


def test_colmap_refusals():
    def changed(name, file, old, new):
        path = colmap(name)
        with open(f"{path}/sparse/0/{file}", encoding="utf-8") as text:
            content = text.read()
        check(old in content, f"{name}: nothing to change")
        write(f"{path}/sparse/0/{file}", content.replace(old, new, 1))
        return path

    refused(changed("fov", "cameras.txt", "PINHOLE", "FOV"), "cameras.txt: line 2: fewer parameters")
    path = changed("fov", "cameras.txt", "7 PINHOLE 64 48", "7 FOV 64 48 1")
    refused(path, "the camera model FOV is not supported")
    refused(changed("unknown", "cameras.txt", "PINHOLE", "WIDE"), "an unknown camera model")
    refused(changed("no_camera", "cameras.txt", "7 ", "8 "), "camera 7 of view_0.png: it is not among the cameras")
    refused(changed("sides", "cameras.txt", " 64 48 ", " 65 48 "), "w: 65, but the picture is 64 pixels wide")
    path = colmap("cut", lists=colmap_binary)
    with open(f"{path}/sparse/0/images.bin", "rb") as file:
        data = file.read()
    write(f"{path}/sparse/0/images.bin", data[:-30])
    refused(path, "images.bin: image 3 of 3: the file ends in it")
    status, _, error = run("import", colmap("given"), "--intrinsics", "9,9,9,9", "-o", "no.mcap")
    check(status == 1 and "the model has its own intrinsics" in error, f"intrinsics twice: {error}")


def test_colmap_itself():
    """Checks COLMAP's output for this text, if it is installed."""
    if shutil.which("colmap") is None:
        print("without COLMAP's own files: colmap is not there")
        return
    path = colmap("itself")
    os.makedirs(f"{path}/sparse/1")
    for form, number in (("BIN", 1), ("TXT", 0)):
        subprocess.run(["colmap", "model_converter", "--input_path", f"{path}/sparse/{1 - number}", "--output_path",
                        f"{path}/sparse/{number}", "--output_type", form], check=True, capture_output=True)
        same(f"COLMAP's own {form}", imported(f"{path}/sparse/{number}")[1], depth=False)




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


def test_pose_files():
    report, got = imported(pose_files("scannet"))
    same("pose files", got)
    check(report["remarks"] == [] and report["left_out"] == [], f"pose files: {report}")
    k = ROOM["camera_info"][0]
    lens = f"{k[0, 0]},{k[1, 1]},{k[0, 2]},{k[1, 2]}"
    same("pose files and a lens", imported(pose_files("scannet_lens", False, False), "--intrinsics", lens)[1], depth=False)
    refused(pose_files("scannet_blind", lens=False), "no intrinsic/intrinsic_color.txt; give --intrinsics")
    path = pose_files("scannet_unit")
    report, got = imported(path, "--depth-unit", "0.25")
    check(json.loads(run("info", f"{path}.mcap", "--json")[1])["depth_unit"] == 0.25, "pose files: --depth-unit")


def test_lost_poses():
    path = pose_files("lost")
    write(f"{path}/pose/1.txt", "-inf -inf -inf -inf\n" * 4)
    report, got = imported(path)
    check(report["frames"] == 2 and report["left_out"] == ["color/1.png: pose/1.txt is not finite: the pose was lost"],
          f"a lost pose: {report}")
    check(np.array_equal(got["image"], [ROOM["image"][i] for i in (0, 2)]), "a lost pose: other pictures")
    status, out, _ = run("import", path, "-o", "lost.mcap")
    check("left out: color/1.png: pose/1.txt" in out, f"a lost pose as text: {out}")
    for i in (0, 2):
        write(f"{path}/pose/{i}.txt", "nan " * 16)
    os.remove("lost.mcap")
    refused(path, "lost/pose: no pose is finite")


def test_depth_of_another_lens():
    """Depth of half the size, with a lens 1.25 times as wide: a plane keeps its distance, and an edge its place."""
    path = pose_files("wide")
    k = ROOM["camera_info"][0]
    width, height = WIDTH // 2, HEIGHT // 2
    full = np.eye(4)
    full[0, 0], full[1, 1] = k[0, 0] / 2 / 1.25, k[1, 1] / 2 / 1.25
    full[0, 2], full[1, 2] = (k[0, 2] + 0.5) / 2 - 0.5, (k[1, 2] + 0.5) / 2 - 0.5
    write(f"{path}/intrinsic/intrinsic_depth.txt", matrix_text(full))
    depth = np.full((height, width), 2000, np.uint16)
    depth[:, width // 2 + 4:] = 3000  # the edge is 4 pixels from the middle: 10 of colour's
    for i in range(FRAMES):
        write(f"{path}/depth/{i}.png", picture(depth))
    _, got = imported(path)
    seen = got["depth"][0]
    check(set(np.unique(seen)) == {2000, 3000}, f"another lens: {np.unique(seen)}")
    edge = np.argmax(seen == 3000, axis=1) * WIDTH / seen.shape[1]
    check(abs(edge - (WIDTH / 2 + 10)).max() <= WIDTH / seen.shape[1], f"another lens: the edge is at {edge}")


def test_pose_file_refusals():
    def changed(name, file, content):
        return write(f"{pose_files(name)}/{file}", content) and name

    refused(changed("short", "pose/1.txt", "1 0 0 0"), "pose/1.txt: not 16 or 12 numbers")
    refused(changed("long", "pose/1.txt", "1 " * 17), "pose/1.txt: more than 16 numbers")
    refused(changed("word", "pose/1.txt", "1 0 0 x"), "pose/1.txt: a word that is no number")
    refused(changed("skewed", "pose/1.txt", "1 0.1 0 0 0 1 0 0 0 0 1 0 0 0 0 1"), "pose/1.txt: ")
    refused(changed("no_lens", "intrinsic/intrinsic_color.txt", "0 0 0 0 0 0 0 0 1"), "not a camera matrix")
    refused(changed("mirror", "intrinsic/extrinsic_depth.txt", "-1 0 0 0 0 1 0 0 0 0 1 0"), "extrinsic_depth.txt: the rotation mirrors")
    path = changed("apart", "intrinsic/extrinsic_depth.txt", "1 0 0 1 0 1 0 0 0 0 1 0")
    os.remove(f"{path}/intrinsic/intrinsic_depth.txt")
    refused(path, "depth's has no intrinsic_depth.txt")


def test_depth_from_beside():
    """A depth camera 4 cm to the right of the colour camera, both one step in front of the device: a plane at 2 m
    moves by its disparity."""
    path = pose_files("beside")
    k = ROOM["camera_info"][0]
    colour, beside = np.eye(4), np.eye(4)
    colour[2, 3] = beside[2, 3] = 0.01
    beside[0, 3] = 0.04
    write(f"{path}/intrinsic/extrinsic_color.txt", matrix_text(colour))
    write(f"{path}/intrinsic/extrinsic_depth.txt", matrix_text(beside))
    depth = np.full((HEIGHT, WIDTH), 2000, np.uint16)
    depth[:, :WIDTH // 2] = 4000
    for i in range(FRAMES):
        write(f"{path}/depth/{i}.png", picture(depth))
    seen = imported(path)[1]["depth"][0]
    check(set(np.unique(seen)) == {0, 2000, 4000}, f"beside: {np.unique(seen)}")
    # the middle of the depth picture is to the right of the middle of the colour picture
    edge = np.argmax(seen == 2000, axis=1)
    want = WIDTH / 2 + k[0, 0] * 0.04 / 2
    check(abs(edge - want).max() <= 1, f"beside: the edge is at {edge}, not {want}")


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


def test_seven_scenes():
    _, got = imported(seven_scenes("seven"))
    holes = np.array(ROOM["depth"])
    holes[:, 0, :5] = 0
    check(np.array_equal(got["depth"], holes), "7-Scenes: depth")
    same("7-Scenes", got | {"depth": ROOM["depth"]})
    refused(seven_scenes("seven_blind", False), "no camera-intrinsics.txt; give --intrinsics fx,fy,cx,cy, which are 585,585,320,240")
    write("sequences/camera-intrinsics.txt", matrix_text(np.array(ROOM["camera_info"][0])))
    same("a sequence below its lens", imported(seven_scenes("sequences/seq-01", False))[1] | {"depth": ROOM["depth"]})




def dense(path, ending="geometric", change=lambda data: data):
    """Writes depth like COLMAP's patch_match_stereo, in the room's lengths."""
    path = colmap(path, "sparse", colmap_binary)
    for i in range(FRAMES):
        metres = (ROOM["depth"][i] * UNIT).astype("<f4")
        write(f"{path}/stereo/depth_maps/view_{i}.png.{ending}.bin", change(b"%d&%d&1&" % (WIDTH, HEIGHT) + metres.tobytes()))
    return path


def test_dense_depth():
    for ending in ("geometric", "photometric"):
        report, got = imported(dense(ending, ending), "--depth-unit", str(UNIT))
        same(f"dense maps, {ending}", got)
        check(report["depth_frames"] == FRAMES, f"dense maps: {report}")
    path = dense("own_unit")
    _, got = imported(path)
    unit = json.loads(run("info", f"{path}.mcap", "--json")[1])["depth_unit"]
    off = np.abs(np.array(got["depth"]) * unit - np.array(ROOM["depth"]) * UNIT)
    check(off.max() <= unit, f"dense maps in steps of {unit}: off by {off.max()}")
    path = colmap("above")
    os.makedirs(f"{path}/dense/stereo/depth_maps")
    check("dense holds depth maps of undistorted pictures; import above/dense reads them" in imported(path)[0]["remarks"], "dense below")
    for name, change, why in (("head", lambda d: b"x" + d, "does not begin with width&height&1&"),
                              ("channels", lambda d: d.replace(b"&1&", b"&3&", 1), "does not begin with"),
                              ("huge", lambda d: b"99999999999&" + d, "does not begin with"),
                              ("cut", lambda d: d[:-1], "fewer bytes"), ("long", lambda d: d + b"x", "more bytes"),
                              ("empty", lambda d: b"", "does not begin with")):
        refused(dense(f"dense_{name}", change=change), f"view_0.png.geometric.bin: ")
        refused(f"dense_{name}", why)




def test_unreadable():
    """One unreadable picture is named and left out, with its triplets; if only the depth is unreadable, only that is
    left out. All unreadable: refused."""
    triplets = [{"context": [0, 2], "target": 1}, {"context": [0, 1], "target": 2}]
    jpeg = b"\xff\xd8\xff\xe0\0\x10JFIF\0\1\1\0\0\1\0\1\0\0"
    for name, content, why in (("cut", picture(ROOM["image"][1])[:900], "PNG: "), ("jpeg", jpeg, "JPEG: "), ("none", None, "No such file")):
        path = transforms(f"bad_{name}", trim3r_triplets=triplets + [{"context": [0, 2], "target": 0}])
        bad = f"{path}/images/frame_00001.png"
        os.remove(bad) if content is None else write(bad, content)
        report, got = imported(path)
        check((report["frames"], report["triplets"], report["skipped"]) == (2, 1, 1), f"{name}: {report}")
        check(report["left_out"][0].startswith(f"{bad}: {why}"), f"{name}: {report}")
        check("2 triplets are left out with frames of theirs" in report["remarks"], f"{name}: {report}")
        check(np.array_equal(got["image"], [ROOM["image"][i] for i in (0, 2)]), f"{name}: other pictures")
        told = json.loads(run("info", f"{path}.mcap", "--json")[1])["triplets"]
        check([t["context"] + [t["target"]] for t in told] == [[0, 1, 0]], f"{name}: {told}")
    for i in (0, 2):
        os.remove(f"bad_none/images/frame_{i:05d}.png")
    os.remove("bad_none.mcap")
    refused("bad_none", "frame_00000.png: No such file")
    path = transforms("bad_depth")
    write(f"{path}/depth/00001.png", picture(ROOM["depth"][1])[:900])
    report, got = imported(path)
    check((report["frames"], report["depth_frames"]) == (3, 2), f"bad depth: {report}")
    check(any(r.startswith(f"depth is left out: {path}/depth/00001.png: PNG: ") for r in report["remarks"]), f"bad depth: {report}")
    for i in range(FRAMES):
        write(f"{path}/depth/{i:05d}.png", picture(ROOM["image"][0]))
    os.remove("bad_depth.mcap")
    refused(path, "8-bit colour, but depth is a 16-bit grey PNG")
    path = pose_files("no_picture")
    os.remove(f"{path}/color/1.png")
    check(imported(path)[0]["left_out"] == ["pose/1.txt: there is no picture of that name"], "a pose without its picture")




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


def test_record3d():
    report, got = imported(record3d("record3d"))
    same("Record3D", got)
    check(report["remarks"] == [], f"Record3D: {report}")
    same("Record3D with K alone", imported(record3d("k_alone", change=lambda c: c.pop("perFrameIntrinsicCoeffs")))[1])
    report, got = imported(record3d("packed", packed=True))
    same("Record3D packed", got, depth=False)
    said = report["remarks"][0]
    check(f"depth of {FRAMES} frames is left out" in said and "packed with LZFSE, which is not read" in said, f"packed: {report}")
    report, got = imported(record3d("steps"), "--depth-unit", "0.002")
    check(np.array_equal(got["depth"], [steps_of(depth * UNIT, 0.002) for depth in ROOM["depth"]]), "Record3D: --depth-unit")
    refused(record3d("cut_depth", change=lambda c: c.update(dw=WIDTH + 1)), "rgbd/0.depth: fewer bytes")
    refused(record3d("no_sides", change=lambda c: c.pop("dw")), "dw, dh: missing")
    refused(record3d("k_of_8", change=lambda c: c["K"].pop()), "K: not 9 finite numbers")
    refused(record3d("pose_of_6", change=lambda c: c["poses"][1].pop()), "poses[1]: not 7 finite numbers")
    report, _ = imported(record3d("more_poses", change=lambda c: c["poses"].append(c["poses"][0])))
    check(report["left_out"] == ["more_poses/rgbd/3.jpg: No such file or directory"], f"more poses: {report}")




def steps_of(lengths, unit):
    """Rounds floats of 32 bits to steps: halves to even; other than positive lengths become 0."""
    steps = np.rint(lengths.astype(np.float32).astype(float) / unit)
    return np.where((steps >= 1) & (steps <= 65535), steps, 0).astype(np.uint16)


def metres_of(depth, kind="<f4"):
    """Writes missing depth as NaN, infinity, 0 or a negative number in turn."""
    metres = (depth * UNIT).astype(kind)
    gaps = np.argwhere(depth == 0)
    for i, (y, x) in enumerate(gaps):
        metres[y, x] = (np.nan, np.inf, 0, -1, 300)[i % 5]
    return metres


def with_exr(path, place="depth/{:05d}", kind="<f4"):
    """Replaces the folder's depth pictures by OpenEXR."""
    for i, depth in enumerate(ROOM["depth"]):
        os.remove(f"{path}/{place.format(i)}.png")
        write(f"{path}/{place.format(i)}.exr", exr(metres_of(depth, kind)))
    return path


def to_exr(content):
    for frame in content["frames"]:
        frame["depth_file_path"] = frame["depth_file_path"].replace(".png", ".exr")


def without_exr():
    """Checks that a build without the library names the package to install, and reads everything except depth."""
    report, got = imported(record3d("no_library", True))
    same("Record3D without OpenEXR", got, depth=False)
    check("Debian: libopenexr-dev" in report["remarks"][0], f"without OpenEXR: {report}")
    refused(with_exr(transforms("nerfstudio_no_library", change=to_exr)), "Debian: libopenexr-dev")


def test_exr():
    report, got = imported(record3d("exr", True))
    if any("does not read OpenEXR" in said for said in report["remarks"]):
        return without_exr()
    same("Record3D's OpenEXR", got)
    check(report["remarks"] == [], f"Record3D's OpenEXR: {report}")
    report, got = imported(with_exr(transforms("nerfstudio_exr", change=to_exr)))
    same("nerfstudio's OpenEXR", got)
    check(report["remarks"] == ["depth_unit_scale_factor: missing; depth in OpenEXR is taken as metres"], f"{report}")
    report, got = imported(with_exr(transforms("exr_factor", change=to_exr, depth_unit_scale_factor=1)))
    same("OpenEXR with a factor of 1", got)
    report, got = imported("exr_factor", "--depth-unit", "0.004")
    check(np.array_equal(got["depth"], [steps_of(depth * UNIT, 0.004) for depth in ROOM["depth"]]), "OpenEXR: --depth-unit")
    refused(with_exr(transforms("exr_far", change=to_exr, depth_unit_scale_factor=100)), "no length in it is from 1 to 65535 steps")
    same("ScanNet with OpenEXR", imported(with_exr(pose_files("scannet_exr"), "depth/{}"))[1])
    same("7-Scenes with OpenEXR", imported(with_exr(seven_scenes("seven_exr"), "frame-{:06d}.depth"))[1])
    path = with_exr(colmap("colmap_exr", depth="depth/view_{}.png"), "depth/view_{}")
    same("COLMAP with OpenEXR", imported(path, "--depth-unit", str(UNIT))[1])
    report, got = imported(with_exr(pose_files("exr_half"), "depth/{}", "<f2"))
    check(np.array_equal(got["depth"], [steps_of(metres_of(d, "<f2"), UNIT) for d in ROOM["depth"]]), "OpenEXR of half")
    path = with_exr(pose_files("exr_cut"), "depth/{}")
    with open(f"{path}/depth/1.exr", "r+b") as file:
        file.truncate(2000)
    report, _ = imported(path)
    check(any(r.startswith(f"depth is left out: {path}/depth/1.exr: OpenEXR: ") for r in report["remarks"]), f"cut OpenEXR: {report}")
    exr_of_opencv()


def exr_of_opencv():
    """Checks another program's output, packed by ZIP."""
    os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
    try:
        import cv2
    except ImportError:
        print("without OpenCV's own files: cv2 is not there")
        return
    path = pose_files("exr_of_opencv")
    for i, depth in enumerate(ROOM["depth"]):
        os.remove(f"{path}/depth/{i}.png")
        check(cv2.imwrite(f"{path}/depth/{i}.exr", metres_of(depth)), "OpenCV writes OpenEXR")
    same("OpenCV's OpenEXR", imported(path)[1])


TESTS = [test_record3d, test_exr, test_pictures_without_pose, test_pose_files, test_lost_poses, test_depth_of_another_lens, test_depth_from_beside, test_seven_scenes, test_dense_depth, test_unreadable, test_pose_file_refusals, test_nerfstudio, test_colmap, test_several_models, test_stereo_of_colmap, test_colmap_refusals, test_colmap_itself]

with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    code, _, message = run("room", "--frames", str(FRAMES), "--size", f"{WIDTH}x{HEIGHT}", "-o", "room.mcap")
    check(code == 0, f"room: {message}")
    ROOM = read("room.mcap")
    for test in TESTS:
        test()
done()
