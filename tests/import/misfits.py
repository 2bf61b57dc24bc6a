# SPDX-License-Identifier: Apache-2.0
"""Folders with a fault, of every kind that import reads: geometry that does not fit is refused with the remedy, one bad
frame is left out by name, and what is not read is named with the command that converts it.

misfits.py TRIM3R
"""

import json
import os
import shutil
import struct
import sys
import tempfile
import zlib

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not there")
    sys.exit(77)

from checks import check, done  # noqa: E402
from folder_makers import (FRAMES, HEIGHT, ROOM, UNIT, WIDTH, colmap, imported, lens_option, make_room,  # noqa: E402
                           matrix_text, pictures, pose_files, record3d, refused, same, seven_scenes, transforms, tum,
                           write)
from frames import picture as png  # noqa: E402
from png import png as rgba  # noqa: E402
from program import expect, expect_json, run  # noqa: E402
import ros_bag as ros  # noqa: E402
from ros_bag import SECOND  # noqa: E402


class Reader:
    """A kind of folder: how it is written, where its pictures and depth are, and the options that it needs."""

    def __init__(self, make, picture, depth, *options):
        self.make, self.picture, self.depth, self.options = make, picture, depth, options


def readers():
    return {"nerfstudio": Reader(transforms, "images/frame_{:05d}.png", "depth/{:05d}.png"),
            "colmap": Reader(lambda path: colmap(path, depth="depth/view_{}.png"), "images/view_{}.png",
                             "depth/view_{}.png", "--depth-unit", str(UNIT)),
            "tum": Reader(tum, "rgb/{}.png", "depth/{}.png", *lens_option(), "--depth-unit", str(UNIT / 5)),
            "scannet": Reader(pose_files, "color/{}.png", "depth/{}.png"),
            "seven": Reader(seven_scenes, "frame-{:06d}.color.png", "frame-{:06d}.depth.png"),
            "record3d": Reader(record3d, "rgbd/{}.png", "rgbd/{}.depth")}


def edit(path, change):
    """Changes the JSON of a folder."""
    with open(path, encoding="utf-8") as file:
        content = json.load(file)
    change(content)
    write(path, json.dumps(content))


def replace(path, old, new):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    check(old in text, f"{path}: there is no {old!r}")
    write(path, text.replace(old, new, 1))


def strict_refuses(path, *options):
    """Checks that --strict refuses what was just imported, and removes the recording."""
    os.remove(f"{path}.mcap")
    refused(path, "--strict refuses what would be left out", "--strict", *options)


# --- one bad frame ---------------------------------------------------------------------------------------------------


def one_is_left_out(name, path, picture, why, *options):
    report, got = imported(path, *options)
    if not report:
        return
    told = [line for line in report["left_out"] if picture in line and why in line]
    check(report["frames"] == FRAMES - 1 and told and report["skipped"] == len(report["left_out"]), f"{name}: {report}")
    check(np.array_equal(got["image"], [ROOM["image"][i] for i in (0, 2)]), f"{name}: other pictures")
    strict_refuses(path, *options)


def test_bad_pictures():
    whole = png(ROOM["image"][1])
    for kind, content, why in (("cut", whole[:900], "PNG: "), ("empty", b"", "empty"), ("text", b"no picture", "neither PNG nor JPEG"),
                               ("webp", b"RIFF\0\0\0\0WEBPVP8 ", "dwebp IN.webp -o OUT.png"),
                               ("small", png(ROOM["image"][1][:1, :1]), "1x1 pixels are too few")):
        for name, reader in readers().items():
            path = reader.make(f"{kind}_{name}")
            write(f"{path}/{reader.picture.format(1)}", content)
            one_is_left_out(f"{name}, {kind}", path, reader.picture.format(1), why, *reader.options)


def test_bad_poses():
    def skew(content):
        content["frames"][1]["transform_matrix"][0][1] += 0.3

    kinds = readers()
    path = transforms("skew_nerfstudio", change=skew)
    one_is_left_out("a matrix", path, "frame_00001.png", "orthonormal")
    path = transforms("none_nerfstudio", change=lambda c: c["frames"][1].pop("transform_matrix"))
    one_is_left_out("no matrix", path, "frame_00001.png", "transform_matrix: missing")
    path = transforms("nan_nerfstudio", change=lambda c: c["frames"][1]["transform_matrix"].__setitem__(0, [float("nan"), 0, 0, float("inf")]))
    one_is_left_out("NaN", path, "frame_00001.png", "transform_matrix: ")
    for name, file in (("scannet", "pose/1.txt"), ("seven", "frame-000001.pose.txt")):
        path = kinds[name].make(f"skew_{name}")
        write(f"{path}/{file}", matrix_text(np.diag([1, 1, 1.3, 1])))
        one_is_left_out(name, path, kinds[name].picture.format(1), f"{file}: ")
    path = kinds["colmap"].make("nan_colmap")
    with open(f"{path}/sparse/0/images.txt", encoding="utf-8") as file:
        lines = file.read().split("\n")
    for i, line in enumerate(lines):
        if line.endswith("view_1.png"):
            lines[i] = " ".join([*line.split(" ")[:1], "nan", *line.split(" ")[2:]])
    write(f"{path}/sparse/0/images.txt", "\n".join(lines))
    one_is_left_out("COLMAP", path, "view_1.png", "its pose: ", *kinds["colmap"].options)
    path = kinds["tum"].make("nan_tum")
    with open(f"{path}/groundtruth.txt", encoding="utf-8") as file:
        lines = file.read().split("\n")
    write(f"{path}/groundtruth.txt", "\n".join([lines[0], "1.0 " + "nan " * 7, lines[2]]))
    one_is_left_out("TUM", path, "groundtruth.txt", "lines left out: 1; the first: line 2", *kinds["tum"].options)
    path = record3d("zero_record3d", change=lambda c: c["poses"].__setitem__(1, [0] * 7))
    one_is_left_out("Record3D", path, "poses[1]", "the quaternion's norm")


def test_bad_cameras():
    path = colmap("fov_colmap")
    replace(f"{path}/sparse/0/cameras.txt", "7 PINHOLE", "8 FOV 64 48 50 50 32 24 0.9\n9 WIDE 1\n7 PINHOLE")
    replace(f"{path}/sparse/0/images.txt", " 7 view_1.png", " 8 view_1.png")
    one_is_left_out("one image of FOV", path, "view_1.png", "the camera model FOV is not supported; colmap image_undistorter")
    path = colmap("wide_colmap")
    replace(f"{path}/sparse/0/cameras.txt", "7 PINHOLE", "9 WIDE 1\n7 PINHOLE")
    replace(f"{path}/sparse/0/images.txt", " 7 view_1.png", " 9 view_1.png")
    one_is_left_out("one image of an unknown camera", path, "view_1.png", "camera 9: an unknown camera model")
    path = transforms("prism", change=lambda c: c["frames"][1].update(camera_model="THIN_PRISM"))
    one_is_left_out("one frame of an unknown camera", path, "frame_00001.png", "camera_model: not one of")
    path = transforms("sides", change=lambda c: c["frames"][1].update(w=63))
    one_is_left_out("one frame of another size", path, "frame_00001.png", "w: 63, but the picture is 64 pixels wide")
    path = record3d("lens", change=lambda c: c["perFrameIntrinsicCoeffs"].__setitem__(1, [1, 2]))
    one_is_left_out("one lens of two numbers", path, "perFrameIntrinsicCoeffs[1]", "not 4 finite numbers")


def test_all_bad():
    """Checks that nothing is written if no frame is left."""
    for name, reader in readers().items():
        path = reader.make(f"all_{name}")
        for i in range(FRAMES):
            write(f"{path}/{reader.picture.format(i)}", b"")
        refused(path, f"{reader.picture.format(0)}: the file is empty", *reader.options)


# --- geometry --------------------------------------------------------------------------------------------------------


def other_aspect(path, reader, frames):
    for i in frames:
        part = ROOM["depth"][i][: HEIGHT // 4 * 3]
        raw = reader.depth.endswith(".depth")
        write(f"{path}/{reader.depth.format(i)}", (part * UNIT).astype("<f4").tobytes() if raw else png(part))
    if os.path.exists(f"{path}/intrinsic/intrinsic_depth.txt"):
        os.remove(f"{path}/intrinsic/intrinsic_depth.txt")


def test_depth_of_another_aspect():
    why = f"{WIDTH}x{HEIGHT // 4 * 3} pixels of depth cannot show the view of a picture of {WIDTH}x{HEIGHT}"
    for name, reader in readers().items():
        path = reader.make(f"aspect_{name}")
        other_aspect(path, reader, range(FRAMES))
        if name == "record3d":
            edit(f"{path}/metadata", lambda c: c.update(dh=HEIGHT // 4 * 3))
        refused(path, why, *reader.options)
        refused(path, "crop the depth to that view, or give its lens", *reader.options, "--size", "32x24")
        if name == "record3d":
            continue
        path = reader.make(f"one_aspect_{name}")
        other_aspect(path, reader, [1])
        report, _ = imported(path, *reader.options)
        told = report.get("depth_left_out", [])
        check(len(told) == 1 and why in told[0] and report["frames"] == 3 and report["depth_frames"] == 2, f"{name}: {report}")
        strict_refuses(path, *reader.options)


def test_intrinsics_of_another_size():
    path = record3d("turned", change=lambda c: c.update(w=HEIGHT, h=WIDTH))
    refused(path, f"w, h: the intrinsics are for {HEIGHT}x{WIDTH} pixels, but the picture has {WIDTH}x{HEIGHT}")
    path = record3d("half", change=lambda c: (c.update(w=2 * WIDTH, h=2 * HEIGHT, K=[2 * v for v in c["K"]]),
                                              c.pop("perFrameIntrinsicCoeffs")))
    same("intrinsics of twice the size", imported(path)[1])
    why = f"lies outside the picture of {WIDTH}x{HEIGHT} pixels"
    refused(tum("centre_tum"), why, "--intrinsics", "500,500,319.5,239.5")
    path = pose_files("centre_scannet")
    write(f"{path}/intrinsic/intrinsic_color.txt", "1170 0 647 0  0 1170 483 0  0 0 1 0  0 0 0 1")
    refused(path, why)
    path = transforms("centre_nerfstudio", change=lambda c: (c.pop("w"), c.pop("h"), c.update(cx=640)))
    refused(path, why)
    edit(f"{path}/transforms.json", lambda c: c.update(w=WIDTH, h=HEIGHT))
    check(imported(path)[1]["camera_info"][0][0, 2] == 639.5, "an axis outside, with the size that it is for")


STORED = {2: lambda d: d[:, ::-1], 3: lambda d: d[::-1, ::-1], 4: lambda d: d[::-1], 5: lambda d: d.swapaxes(0, 1),
          6: lambda d: np.rot90(d), 7: lambda d: np.rot90(d, 2).swapaxes(0, 1), 8: lambda d: np.rot90(d, -1)}


def with_exif(data, orientation, order=">"):
    """Returns a PNG with a chunk of EXIF."""
    tiff = (b"MM\0*" if order == ">" else b"II*\0") + struct.pack(f"{order}IHHHIHHI", 8, 1, 0x112, 3, 1, orientation, 0, 0)
    chunk = b"eXIf" + tiff
    head = 8 + 25  # the signature and IHDR
    return data[:head] + struct.pack(">I", len(tiff)) + chunk + struct.pack(">I", zlib.crc32(chunk)) + data[head:]


def mark(path, reader, orientation, order=">"):
    for i in range(FRAMES):
        stored = np.ascontiguousarray(STORED[orientation](ROOM["image"][i]))
        write(f"{path}/{reader.picture.format(i)}", with_exif(png(stored), orientation, order))
    return path


def pointmaps():
    """Writes a plane as seen by each of the pictures' cameras."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    plane = np.stack([(x - WIDTH / 2 + 0.5) / 50, (y - HEIGHT / 2 + 0.5) / 50, np.ones((HEIGHT, WIDTH))], 2)
    np.savez("plane.npz", pts3d=np.stack([plane] * FRAMES).astype("f4"), poses=np.stack([np.eye(4)] * FRAMES).astype("f4"),
             focals=np.full(FRAMES, 50, "f4"))
    return "plane.npz"


def test_orientation():
    kinds = readers()
    for name in ("nerfstudio", "record3d"):  # they say the size, which decides
        for orientation in (5, 6, 7, 8):
            path = mark(kinds[name].make(f"exif{orientation}_{name}"), kinds[name], orientation, "<>"[orientation % 2])
            same(f"{name}, orientation {orientation}", imported(path)[1])
        refused(mark(kinds[name].make(f"exif3_{name}"), kinds[name], 3), "mogrify -auto-orient turns the pixels")
    for name in ("tum", "scannet", "seven"):
        for orientation in (2, 6):
            path = mark(kinds[name].make(f"exif{orientation}_{name}"), kinds[name], orientation)
            refused(path, f"EXIF turns the picture (orientation {orientation})", *kinds[name].options)
    path = colmap("exif_colmap")  # COLMAP sees the pixels as they are stored
    for i in range(FRAMES):
        write(f"{path}/images/view_{i}.png", with_exif(png(ROOM["image"][i]), 3))
    same("COLMAP", imported(path)[1], depth=False)
    path = transforms("exif_stored")  # the size is that of the stored pixels
    for i in range(FRAMES):
        write(f"{path}/images/frame_{i:05d}.png", with_exif(png(ROOM["image"][i]), 6))
    same("the size of the stored pixels", imported(path)[1])
    for orientation in (4, 6):
        reader = Reader(None, "{}.png", None)
        pictures(f"exif_alone{orientation}")
        report, got = imported(mark(f"exif_alone{orientation}", reader, orientation), "--pointmaps", pointmaps())
        check(np.array_equal(got.get("image", []), ROOM["image"]), f"pictures alone, orientation {orientation}: {report}")
    for orientation in (0, 1, 9):  # none, upright, nonsense
        path = transforms(f"exif_{orientation}")
        write(f"{path}/images/frame_00001.png", with_exif(png(ROOM["image"][1]), orientation))
        same(f"orientation {orientation}", imported(path)[1])


# --- invalid pixels --------------------------------------------------------------------------------------------------


def with_alpha(pixels, alpha):
    return rgba([row.tobytes() for row in np.concatenate([pixels, alpha[:, :, None]], 2)], channels=4)


def hidden(what):
    """The room with the upper left corner invalid."""
    out = [np.array(each) for each in ROOM[what]]
    for each in out:
        each[:20, :30] = 0
    return out


def one_is_left_out_again(name, path, reader, why):
    report, _ = imported(path, *reader.options)
    check(report.get("frames") == FRAMES - 1 and any(why in line for line in report["left_out"]), f"{name}: {report}")


def test_alpha():
    alpha = np.full((HEIGHT, WIDTH), 255, np.uint8)
    alpha[:20, :30] = 0
    alpha[20:, 30:] = 128  # half is visible
    for name, reader in readers().items():
        path = reader.make(f"alpha_{name}")
        for i in range(FRAMES):
            write(f"{path}/{reader.picture.format(i)}", with_alpha(ROOM["image"][i], alpha))
        _, got = imported(path, *reader.options)
        for what, factor in (("image", 1), ("depth", 5 if name == "tum" else 1)):
            due = np.array(hidden(what)) * factor
            check(np.array_equal(got.get(what, []), due), f"{name}: {what} of transparent pixels")
        write(f"{path}/{reader.picture.format(1)}", with_alpha(ROOM["image"][1], np.zeros_like(alpha)))
        one_is_left_out_again(name, path, reader, "alpha or the mask leaves no pixel of it")
        write(f"{path}/{reader.picture.format(0)}", with_alpha(ROOM["image"][0], np.full_like(alpha, 255)))
        _, got = imported(path, *reader.options)
        check(np.array_equal(got["image"][0], ROOM["image"][0]) and got["depth"][0].any(), f"{name}: an opaque picture")


def test_masks():
    mask = np.full((HEIGHT, WIDTH, 3), 255, np.uint8)
    mask[:20, :30] = 0

    def masked(content):
        for frame in content["frames"]:
            frame["mask_path"] = "masks/m.png"

    for name, part in (("whole", mask), ("half", mask[::2, ::2])):
        path = transforms(f"mask_{name}", change=masked)
        write(f"{path}/masks/m.png", png(np.ascontiguousarray(part)))
        report, got = imported(path)
        for what in ("image", "depth"):
            check(np.array_equal(got.get(what, []), hidden(what)), f"a mask, {name}: {what}")
        check(not any("mask" in line for line in report["remarks"]), f"a mask that is read: {report}")
    clear = np.dstack((np.full_like(mask, 255), mask[:, :, 0]))  # white, and black by alpha
    write(f"{path}/masks/m.png", rgba([row.tobytes() for row in clear], 8, 4))
    os.remove(f"{path}.mcap")
    _, got = imported(path)
    for what in ("image", "depth"):
        check(np.array_equal(got.get(what, []), hidden(what)), f"a transparent mask: {what}")
    write(f"{path}/masks/m.png", png(mask[:10]))
    refused_again(path, "a mask of 64x10 pixels, but the picture has 64x48")
    path = transforms("mask_gone", change=lambda c: c["frames"][1].update(mask_path="masks/gone.png"))
    one_is_left_out("a mask that is not there", path, "masks/gone.png", "No such file")
    kinds = readers()
    for name in ("colmap", "tum", "scannet"):
        path = kinds[name].make(f"masks_{name}")
        os.makedirs(f"{path}/masks")
        report, _ = imported(path, *kinds[name].options)
        told = "masks: this folder is not read; mask_path of a frame in transforms.json is"
        check(told in report.get("remarks", []), f"{name}: masks: {report}")


def refused_again(path, why, *options):
    os.remove(f"{path}.mcap")
    refused(path, why, *options)


def test_confidence_and_scale():
    path = record3d("conf")
    write(f"{path}/rgbd/0.conf", bytes(WIDTH * HEIGHT))
    report, got = imported(path)
    same("confidence", got)
    check(any("confidence of depth (.conf) is not read" in line for line in report["remarks"]), f"confidence: {report}")
    path = transforms("confidence", change=lambda c: c["frames"][0].update(depth_confidence_path="c.png"))
    report, _ = imported(path)
    check(any("depth_confidence_path: this field is not read" in line for line in report["remarks"]), f"confidence: {report}")
    path = pose_files("confidence_folder")
    os.makedirs(f"{path}/confidence")
    check("confidence: this folder is not read" in imported(path)[0]["remarks"], "a folder of confidence")
    path = transforms("scaled", applied_scale=0.25, depth_unit_scale_factor=UNIT)
    report, _ = imported(path)
    unit = json.loads(run("info", f"{path}.mcap", "--json")[1])["depth_unit"]
    check(abs(unit - UNIT / 4) < 1e-12 and any("applied_scale: " in line for line in report["remarks"]), f"applied_scale: {unit}")
    report, _ = imported(transforms("scaled_ngp", "depth_path", applied_scale=0.25, integer_depth_scale=UNIT))
    unit = json.loads(run("info", "scaled_ngp.mcap", "--json")[1])["depth_unit"]
    check(abs(unit - UNIT) < 1e-12, f"applied_scale beside instant-ngp's depth: {unit}")
    refused(transforms("scaled_bad", applied_scale=-1), "applied_scale: not positive")


# --- limits ----------------------------------------------------------------------------------------------------------


def test_large_pictures():
    wide = np.zeros((16, 4200, 3), np.uint8)
    wide[:, :, 0] = np.arange(4200) // 20
    kinds = {"large_tum": lambda path: tum(path), "large_seven": seven_scenes, "large_nerfstudio": transforms}
    for name, make in kinds.items():
        path = make(name)
        reader = readers()[name[6:]]
        for i in range(FRAMES):
            write(f"{path}/{reader.picture.format(i)}", png(wide))
            os.remove(f"{path}/{reader.depth.format(i)}")
        options = ("--intrinsics", "4000,4000,2099.5,7.5") if name == "large_tum" else ()
        if name == "large_tum":
            os.remove(f"{path}/depth.txt")
        elif name == "large_nerfstudio":
            edit(f"{path}/transforms.json", lambda c: (c.update(w=4200, h=16, fl_x=4000, fl_y=4000, cx=2100, cy=8),
                                                       [frame.pop("depth_file_path") for frame in c["frames"]]))
        else:
            write(f"{path}/camera-intrinsics.txt", "4000 0 2099.5  0 4000 7.5  0 0 1")
        found = json.loads(run("info", path, "--json")[1] or "{}")
        check((found.get("width"), found.get("height")) == (4200, 16), f"{name}: info: {found}")
        refused(path, "4200x16 pixels; sides of up to 4096 are supported, larger ones with --size", *options)
        _, got = imported(path, "--size", "2100x8", *options)
        if got:
            check(np.abs(got["camera_info"][0] - [[2000, 0, 1049.5], [0, 2000, 3.5], [0, 0, 1]]).max() < 1e-3, f"{name}: camera")
            check(np.abs(got["image"][0][4, :, 0].astype(int) - np.arange(2100) // 10).max() <= 1, f"{name}: picture")


def test_large_pictures_of_bags():
    """info shows what a bag holds whose pictures only import --size reads."""
    wide = np.full((16, 4200, 3), 90, np.uint8)
    for name, kind, message in (("raw", ros.IMAGE, ros.image(SECOND, "cam", "rgb8", wide)),
                                ("png", ros.COMPRESSED, ros.compressed(SECOND, "cam", "png", png(wide)))):
        bag = ros.Bag()
        bag.put("/camera/image", kind, SECOND, message)
        bag.put("/camera/camera_info", ros.INFO, SECOND, ros.info(SECOND, "cam", size=(4200, 16)))
        bag.write(f"{name}.mcap")
        found = json.loads(run("info", f"{name}.mcap", "--json")[1] or "{}")
        check([found.get(key) for key in ("width", "height", "unreadable_frames")] == [4200, 16, 0], f"{name}: {found}")
        expect(0, "info", f"{name}.mcap", out="import needs --size WxH")
        expect(1, "import", f"{name}.mcap", "-o", "large.mcap", err="4200x16 pixels")
        expect(0, "import", f"{name}.mcap", "--size", "2100x8", "-o", "large.mcap")


def test_repeated_stamps():
    """Two pictures, or two different poses, of one time: the first counts, and the others are left out and named."""
    for name in ("rgb.txt", "groundtruth.txt", "depth.txt"):
        path = tum(f"twice_{name[:-4]}")
        with open(f"{path}/{name}") as file:
            lines = file.read().splitlines()
        first, other = [line for line in lines if not line.startswith("#")][:2]
        stamp = first.split()[0]
        again = " ".join([stamp, *other.split()[1:]])
        write(f"{path}/{name}", "\n".join([*lines, again, *([first] if name == "groundtruth.txt" else [])]) + "\n")
        report, got = imported(path, *lens_option())
        check(np.array_equal(got["image"], ROOM["image"]) and len(got["depth"]) == FRAMES, f"twice in {name}: frames")
        check(np.abs(np.stack(got["pose"]) - np.stack(ROOM["pose"])).max() < 1e-6, f"twice in {name}: poses")
        check(any(f"{name}: lines left out: 1" in line and f"{float(stamp):.6f} is there twice" in line for line in report["left_out"]),
              f"twice in {name}: {report['left_out']}")
        os.remove(f"{path}.mcap")
        refused(path, "is there twice", *lens_option(), "--strict")


def test_sizes_of_bags():
    """--size makes the same of a bag as of a folder."""
    transforms("in_a_folder")
    shutil.copy("room.mcap", "in_a_bag")
    for size in ("40x24", "16x64", "128x96"):
        _, folder = imported("in_a_folder", "--size", size)
        _, bag = imported("in_a_bag", "--size", size)
        for what in ("image", "depth"):
            check(np.array_equal(folder[what], bag[what]), f"{size}: {what}")
        for what in ("pose", "camera_info"):
            off = np.abs(np.stack(folder[what]) - np.stack(bag[what])).max()
            check(off < 1e-3, f"{size}: {what} is off by {off}")
    os.remove("in_a_bag.mcap")
    refused("in_a_bag", "too narrow to crop", "--size", "8x4096")


def test_reduced_pictures():
    half = [np.ascontiguousarray(each[::2, ::2]) for each in ROOM["image"]]
    for name, make, picture in (("colmap", colmap, "view_{}.png"), ("nerfstudio", transforms, "frame_{:05d}.png"),
                                ("binary", lambda p: colmap(p, "sparse"), "view_{}.png")):
        for n in (2, 4):
            path = make(f"reduced{n}_{name}")
            os.rename(f"{path}/images", f"{path}/images_{n}")
            for i in range(FRAMES):
                write(f"{path}/images_{n}/{picture.format(i)}", png(half[i]))
            report, got = imported(path)
            k = got["camera_info"][0] if got else np.eye(3)
            want = np.array(ROOM["camera_info"][0]) / 2
            want[:2, 2] -= 0.25  # the corner stays, not the first centre
            check(np.abs(k[:2] - want[:2]).max() < 1e-3, f"{name}: intrinsics of images_{n}: {k}")
            check(np.array_equal(got.get("image", []), half), f"{name}: images_{n}")
            told = f"images_{n} is read, with intrinsics scaled to its pictures"
            check(told in report.get("remarks", []), f"{name}: {report}")
    path = transforms("reduced_unsized", change=lambda c: (c.pop("w"), c.pop("h")))
    os.rename(f"{path}/images", f"{path}/images_2")
    refused(path, "w or h is missing: the size that the intrinsics are for")


def test_many_coefficients():
    """Checks that a lens that no recording holds becomes a pinhole of the same matrix."""
    rational = dict(k1=0.3, k2=-0.1, k4=0.35, k5=-0.12, k6=0.01)
    path = transforms("rational", change=lambda c: c.update(rational))
    results = [("k4 to k6 in transforms.json", imported(path)[1])]
    path = colmap("rational_colmap")
    k = ROOM["camera_info"][0]
    centre = f"{k[0, 0]:.17g} {k[1, 1]:.17g} {k[0, 2] + 0.5:.17g} {k[1, 2] + 0.5:.17g}"
    write(f"{path}/sparse/0/cameras.txt", f"7 FULL_OPENCV {WIDTH} {HEIGHT} {centre} 0.3 -0.1 0 0 0 0.35 -0.12 0.01\n")
    results.append(("FULL_OPENCV", imported(path)[1]))
    path = pose_files("steep", lens=False)
    results.append(("k1 of 200", imported(path, "--intrinsics", f"9000,9000,{k[0, 2]},{k[1, 2]},200,0,0,0,0")[1]))
    path = pose_files("typed", lens=False)
    lens = f"{k[0, 0]:.17g},{k[1, 1]:.17g},{k[0, 2]:.17g},{k[1, 2]:.17g},0.3,-0.1,0,0,0,0.35,-0.12,0.01"
    results.append(("twelve numbers", imported(path, "--intrinsics", lens)[1]))
    expect(2, "import", path, "--intrinsics", lens[:-5], "-o", "r.mcap", err="--intrinsics")
    expect(2, "import", "room.mcap", "--intrinsics", lens, "-o", "r.mcap", err="its CameraInfo alone")
    expect(2, "capture", "--source", "replay:room.mcap", "--hash", "--intrinsics", lens, err="no recording holds k4,k5,k6")
    for name, got in results:
        told = json.loads(run("info", {"k4": "rational", "FU": "rational_colmap", "k1": "steep", "tw": "typed"}[name[:2]] + ".mcap", "--json")[1])
        check(told.get("distortion", "none") == "none", f"{name}: {told}")
        off = np.abs(np.array(got.get("image", [0]), int) - np.array(ROOM["image"], int))
        check(0 < np.median(off) + off.max() and np.percentile(off, 80) < 40, f"{name}: off by {np.percentile(off, 80)}")
    check(np.array_equal(results[0][1]["image"], results[1][1]["image"]), "k4 to k6: two readers, one picture")
    check(np.array_equal(results[0][1]["image"], results[3][1]["image"]), "k4 to k6 of a file and of the command line")
    refused(transforms("folded", change=lambda c: c.update(k1=-200)), "distortion: the coefficients fold")


def test_depth_units():
    path = tum("unit_tum")
    for options, unit in (((), UNIT / 5), (("--depth-unit", "0.004"), 0.004)):
        report, got = imported(path, *lens_option(), *options)
        check(np.array_equal(got.get("depth", []), np.array(ROOM["depth"]) * 5), f"TUM {options}: {report}")
        check(abs(json.loads(run("info", f"{path}.mcap", "--json")[1])["depth_unit"] - unit) < 1e-12, f"TUM {options}: unit")
    for name, key in (("unit_ngp", "depth_path"), ("unit_nerfstudio", "depth_file_path")):
        report, got = imported(transforms(name, key), "--depth-unit", "0.002")
        check(abs(json.loads(run("info", f"{name}.mcap", "--json")[1])["depth_unit"] - 0.002) < 1e-12, f"{name}: {report}")
        check(not any("taken as" in line for line in report["remarks"]), f"{name}: {report}")


def test_foreign_files():
    heic = (("heic", "heif-convert"),) if expect_json("doctor")["heif"] is None else ()
    for ending, command in (*heic, ("WEBP", "dwebp"), ("tiff", "convert IN"), ("mp4", "ffmpeg -i IN"), ("MOV", "ffmpeg")):
        os.makedirs(f"only_{ending}")
        write(f"only_{ending}/a.{ending}", b"x")
        refused(f"only_{ending}", command)
        refused(f"only_{ending}", f"a.{ending}: ", "--pointmaps", pointmaps())
    pictures("mixed")
    write("mixed/9.webp", b"RIFF\1\0\0\0WEBP")
    report, _ = imported("mixed", "--pointmaps", pointmaps())
    check(report.get("frames") == FRAMES and "9.webp: WebP is not read; dwebp" in report["left_out"][0], f"mixed: {report}")
    for name, data, command in (("v.mp4", b"\0\0\0\x18ftypisom", "ffmpeg"), ("v.mkv", b"\x1a\x45\xdf\xa3" + bytes(9), "ffmpeg"),
                                *(("p.heic", b"\0\0\0\x18ftypheic", command) for _, command in heic), ("p.webp", b"RIFF\1\0\0\0WEBP", "dwebp")):
        os.makedirs("foreign", exist_ok=True)
        write(f"foreign/{name}", data)
        refused(f"foreign/{name}", command)


TESTS = [test_bad_pictures, test_bad_poses, test_bad_cameras, test_all_bad, test_depth_of_another_aspect,
         test_intrinsics_of_another_size, test_orientation, test_alpha, test_masks, test_confidence_and_scale,
         test_large_pictures, test_large_pictures_of_bags, test_repeated_stamps, test_sizes_of_bags, test_reduced_pictures, test_many_coefficients, test_depth_units, test_foreign_files]

with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    make_room()
    for test in TESTS:
        test()
done()
