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
from folder_makers import (FRAMES, HEIGHT, ROOM, UNIT, WIDTH, colmap, colmap_binary, colmap_text, imported,  # noqa: E402
                           lens_option, make_room, matrix_text, pictures, pose_files, record3d, refused, same,
                           seven_scenes, transforms, write)
from frames import exr, picture, read  # noqa: E402
from program import run  # noqa: E402


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
        content["distortion_params"] = [0.1, 0, 0, 0]

    report, got = imported(transforms("unread", change=other))
    same("unread fields", got, depth=False)
    said = "this field is not read, though its name says depth, pose, mask or lens"
    check(report["remarks"] == [f"poses_bounds: {said}", f"distortion_params: {said}", f"frames[0]: depth_map: {said}",
                                "no frame has depth: build and replay need --depth stereo"], f"unread fields: {report}")
    refused(transforms("two_units", integer_depth_scale=0.5, depth_unit_scale_factor=UNIT), "integer_depth_scale")
    report, _ = imported(transforms("two_paths", change=lambda c: c["frames"][1].update(depth_path="x.png")))
    check(report["left_out"] == ["images/frame_00001.png: frames[1]: depth_file_path: there is another depth_path too"],
          f"two depth pictures: {report}")
    refused(transforms("bad_unit", depth_unit_scale_factor=200), "depth_unit_scale_factor: not between")
    refused(transforms("no_unit", "depth_path"), "integer_depth_scale: missing")


def check_inner(name, report, got):
    """Checks that it is the room inside a border of 3, 2, 4 and 1 pixels."""
    part = np.s_[2:HEIGHT - 1, 3:WIDTH - 4]
    check(report["border"] == [3, 2, 4, 1], f"{name}: {report['border']}")
    for what in ("image", "depth"):
        check(np.array_equal(got.get(what, []), [whole[part] for whole in ROOM[what]]), f"{name}: {what}")
    moved = ROOM["camera_info"][0] - [[0, 0, 3], [0, 0, 2], [0, 0, 0]]
    check(np.abs(got["camera_info"][0] - moved).max() < 1e-3, f"{name}: the camera is {got['camera_info'][0]}")


def test_border():
    """A border around all pictures is left out of folders and of recordings, with its depth; the camera follows."""
    transforms("border")
    for i, whole in enumerate(ROOM["image"]):
        framed = np.full_like(whole, 250)
        framed[2:HEIGHT - 1, 3:WIDTH - 4] = whole[2:HEIGHT - 1, 3:WIDTH - 4]
        write(f"border/images/frame_{i:05d}.png", picture(framed))
    check_inner("a folder with a border", *imported("border"))
    status, out, _ = run("import", "border", "-o", "border.mcap")
    check(status == 0 and "3, 2, 4 and 1 pixels on the left, top, right and bottom; --keep-border keeps it" in " ".join(out.split()), out)
    check(max(map(len, out.splitlines())) <= 80, f"wider than 80 columns: {out}")
    report, got = imported("border", "--keep-border")
    check(report["border"] == [0] * 4 and np.array_equal(got["depth"], ROOM["depth"]), "a border that is kept")
    os.rename("border.mcap", "kept.mcap")
    status, out, error = run("import", "kept.mcap", "-o", "inner.mcap", "--json")
    check(status == 0, f"a recording with a border: {error}")
    check_inner("a recording with a border", json.loads(out), read("inner.mcap"))
    report, got = imported("border", "--size", "32x24")
    check(report["border"] == [3, 2, 4, 1] and report["width"] == 32, f"a border and a size: {report}")


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

    for file in ("cameras.txt", "images.txt"):
        imported(changed(f"marked_{file}", file, "# ", "\ufeff# "))  # a byte order mark
    refused(changed("fov", "cameras.txt", "PINHOLE", "FOV"), "cameras.txt: line 2: fewer parameters")
    path = changed("fov", "cameras.txt", "7 PINHOLE 64 48", "7 FOV 64 48 1")
    refused(path, "the camera model FOV is not supported")
    refused(changed("unknown", "cameras.txt", "PINHOLE", "WIDE"), "an unknown camera model")
    refused(changed("no_camera", "cameras.txt", "7 ", "8 "), "view_0.png: camera 7: it is not among the cameras")
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


def test_pose_files():
    report, got = imported(pose_files("scannet"))
    same("pose files", got)
    check(report["remarks"] == [] and report["left_out"] == [], f"pose files: {report}")
    same("pose files and a lens", imported(pose_files("scannet_lens", False, False), *lens_option())[1], depth=False)
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
    refused(path, "color/0.png: pose/0.txt is not finite")


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

    for name, text, why in (("short", "1 0 0 0", "not 16 or 12 numbers"), ("long", "1 " * 17, "more than 16 numbers"),
                            ("word", "1 0 0 x", "a word that is no number"),
                            ("skewed", "1 0.1 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "the rotation is not orthonormal")):
        report, _ = imported(changed(name, "pose/1.txt", text))
        check(report["frames"] == 2 and f"pose/1.txt: {why}" in report["left_out"][0], f"{name}: {report}")
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
    check(report["depth_left_out"][0].startswith(f"{path}/depth/00001.png: PNG: "), f"bad depth: {report}")
    for i in range(FRAMES):
        write(f"{path}/depth/{i:05d}.png", picture(ROOM["image"][0]))
    os.remove("bad_depth.mcap")
    refused(path, "8-bit colour, but depth is a 16-bit grey PNG")
    path = pose_files("no_picture")
    os.remove(f"{path}/color/1.png")
    check(imported(path)[0]["left_out"] == ["pose/1.txt: there is no picture of that name"], "a pose without its picture")


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
    report, _ = imported(record3d("pose_of_6", change=lambda c: c["poses"][1].pop()))
    check(report["left_out"] == ["poses[1]: not 7 finite numbers: qx qy qz qw x y z"], f"a pose of 6 numbers: {report}")
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
    check(report["depth_left_out"][0].startswith(f"{path}/depth/1.exr: OpenEXR: "), f"cut OpenEXR: {report}")
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


TESTS = [test_border, test_record3d, test_exr, test_pictures_without_pose, test_pose_files, test_lost_poses, test_depth_of_another_lens, test_depth_from_beside, test_seven_scenes, test_dense_depth, test_unreadable, test_pose_file_refusals, test_nerfstudio, test_colmap, test_several_models, test_stereo_of_colmap, test_colmap_refusals, test_colmap_itself]

with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    make_room()
    for test in TESTS:
        test()
done()
