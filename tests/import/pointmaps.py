# SPDX-License-Identifier: Apache-2.0
"""trim3r import of pointmaps that NumPy wrote, made of the built-in room's depth: every step is exact, poses and
intrinsics come from the right source, and wrong files are refused by name.

pointmaps.py TRIM3R
"""

import json
import os
import sys
import tempfile
import zipfile

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not there")
    sys.exit(77)

from checks import check, done  # noqa: E402
from frames import picture, read
from program import run

SIDE, FRAMES = 96, 4




def points(room):
    """Returns pointmaps in the first camera's frame, in float32 like a network's."""
    first, maps = np.linalg.inv(room["pose"][0]), []
    for depth, camera, k in zip(room["depth"], room["pose"], room["camera_info"]):
        z = depth / 1000.0
        v, u = np.mgrid[:z.shape[0], :z.shape[1]]
        local = np.stack([(u - k[0, 2]) / k[0, 0] * z, (v - k[1, 2]) / k[1, 1] * z, z, np.ones_like(z)], -1)
        maps.append((local @ (first @ camera).T)[..., :3].astype(np.float32))
    return np.stack(maps)


def folder(name, room, posed=True, **fields):
    """Writes the room's pictures, with transforms.json unless posed is None; its frames have fields[key][i]."""
    path = f"{work}/{name}"
    os.makedirs(path)
    frames = []
    for i, rgb in enumerate(room["image"]):
        with open(f"{path}/{i}.png", "wb") as file:
            file.write(picture(rgb))
        k = room["camera_info"][i]
        frame = {"file_path": f"{i}.png", "fl_x": k[0, 0], "fl_y": k[1, 1], "cx": k[0, 2] + 0.5, "cy": k[1, 2] + 0.5}
        if posed:
            camera = room["pose"][i] @ np.diag([1, -1, -1, 1])
            frame["transform_matrix"] = camera.tolist()
        frame.update({key: values[i] for key, values in fields.items() if key != "top"})
        frames.append(frame)
    if posed is not None:
        with open(f"{path}/transforms.json", "w", encoding="utf-8") as file:
            json.dump({"frames": frames, **fields.get("top", {})}, file)
    return path


def edit(path, change):
    with open(f"{path}/transforms.json", encoding="utf-8") as file:
        text = json.load(file)
    for i, frame in enumerate(text["frames"]):
        change(i, frame)
    with open(f"{path}/transforms.json", "w", encoding="utf-8") as file:
        json.dump(text, file)


def imported(name, path, *options):
    target = f"{work}/{name}.mcap"
    status, out, error = run("import", path, "-o", target, "--json", *options)
    check(status == 0, f"{name}: {error}")
    return (json.loads(out), read(target)) if status == 0 else ({}, {})


def refused(path, expected, *options):
    target = f"{work}/refused.mcap"
    status, out, error = run("import", path, "-o", target, *options)
    check(status == 1 and out == "", f"{expected}: status {status}")
    for text in expected:
        check(text in error, f"'{error.strip()}' does not say '{text}'")
    check(not os.path.exists(target), f"{expected}: left a recording behind")


def same(name, got, room, pose_limit=1e-6, lens_limit=1e-4):
    for i in range(FRAMES):
        check(np.array_equal(got["depth"][i], room["depth"][i]),
              f"{name}: depth of frame {i}: {np.count_nonzero(got['depth'][i] != room['depth'][i])} steps differ")
        off = np.abs(np.linalg.inv(room["pose"][0]) @ room["pose"][i] -
                     np.linalg.inv(got["pose"][0]) @ got["pose"][i]).max()
        check(off < pose_limit, f"{name}: pose of frame {i} is {off} off")
        off = np.abs(got["camera_info"][i] - room["camera_info"][i]).max()
        check(off < lens_limit, f"{name}: intrinsics of frame {i} are {off} off")


MM = {"top": {"integer_depth_scale": 0.001}}


def test_files_of_frames(room, maps):
    names = [f"{i}.npz" for i in range(FRAMES)]
    path = folder("npz", room, pointmap_path=names, **MM)
    for i, name in enumerate(names):
        (np.savez_compressed if i % 2 else np.savez)(f"{path}/{name}", pts3d=maps[i])
    report, got = imported("npz", path)
    same("npz", got, room)
    check(report.get("pointmaps") == FRAMES and report.get("depth_unit") == 0.001, f"npz: {report}")

    names = [f"{i}.npy" for i in range(FRAMES)]
    confidence = [f"c{i}.npy" for i in range(FRAMES)]
    path = folder("npy", room, pointmap_path=names, confidence_path=confidence, **MM)
    unsure = np.ones(maps.shape[:3], np.float32) * 5
    unsure[:, ::3, ::2] = 1.5
    for i, name in enumerate(names):
        np.save(f"{path}/{name}", maps[i])
        np.save(f"{path}/{confidence[i]}", unsure[i])
    _, got = imported("npy", path)
    same("npy, any confidence", got, room)
    _, got = imported("npy", path, "--min-confidence", "3")
    for i in range(FRAMES):
        check(np.array_equal(got["depth"][i], np.where(unsure[i] < 3, 0, room["depth"][i])), f"confidence: frame {i}")


def test_one_file(room, maps):
    relative = np.stack([np.linalg.inv(room["pose"][0]) @ p for p in room["pose"]])
    k = np.stack(room["camera_info"])
    bare, unit = folder("bare", room, posed=None), ("--depth-unit", "0.001")
    # DUSt3R: focals as a column, poses to the points' frame
    np.savez(f"{work}/dust3r.npz", pts3d=maps, conf=np.ones(maps.shape[:3], np.float32),
             poses=relative.astype(np.float32), focals=k[:, 0, :1].astype(np.float32))
    _, got = imported("dust3r", bare, "--pointmaps", f"{work}/dust3r.npz", *unit)
    same("dust3r", got, room, lens_limit=0.501)
    check(abs(got["camera_info"][0][0, 2] - SIDE / 2) < 1e-9, "dust3r: the principal point is where it has it")
    # VGGT: a batch of one, the inverse of the poses
    np.savez(f"{work}/vggt.npz", world_points=maps[None], world_points_conf=np.ones((1, *maps.shape[:3]), np.float32),
             extrinsic=np.linalg.inv(relative)[None, :, :3].astype(np.float32), intrinsic=k[None].astype(np.float32))
    _, got = imported("vggt", bare, "--pointmaps", f"{work}/vggt.npz", *unit)
    same("vggt", got, room)
    # poses from the points: with the picture's intrinsics, replacing those of a wrong folder
    np.savez(f"{work}/points.npz", pts3d=maps)
    numbers = ",".join(repr(float(x)) for x in (k[0, 0, 0], k[0, 1, 1], k[0, 0, 2], k[0, 1, 2]))
    report, got = imported("points", bare, "--pointmaps", f"{work}/points.npz", "--intrinsics", numbers, *unit)
    same("points", got, room, 1e-5)
    check(0 <= report.get("resection_pixels", 9) < 0.01, f"points: {report}")
    _, got = imported("posed", folder("posed", room, **MM), "--pointmaps", f"{work}/points.npz")
    same("posed", got, room)
    wrong = dict(room, pose=[room["pose"][1]] * FRAMES)
    _, got = imported("wrong", folder("wrong", wrong, **MM), "--pointmaps", f"{work}/points.npz", "--poses", "estimate")
    same("wrong poses estimated", got, room, 1e-5)
    # outliers do not move a pose that comes from points
    noisy = maps.copy()
    noisy[:, 10:40, 10:50] += 3
    np.savez(f"{work}/noisy.npz", pts3d=noisy)
    _, got = imported("noisy", bare, "--pointmaps", f"{work}/noisy.npz", "--intrinsics", numbers, *unit)
    for i in range(FRAMES):
        off = np.abs(relative[i] - np.linalg.inv(got["pose"][0]) @ got["pose"][i]).max()
        check(off < 1e-3, f"noisy: pose of frame {i} is {off} off")
    # the chosen unit: a power of two for which the median is 4096 to 8192 steps
    report, got = imported("unit", bare, "--pointmaps", f"{work}/vggt.npz")
    unit = report.get("depth_unit", 0)
    median = np.median(np.stack(got["depth"]))
    check(unit > 0 and np.log2(unit) % 1 == 0 and 4000 < median <= 8250, f"unit: {unit}, median {median}")
    for i in range(FRAMES):
        off = np.abs(got["depth"][i] * unit - room["depth"][i] / 1000.0).max()
        check(off <= unit * 0.51, f"unit: depth of frame {i} is {off} off")
    # a map of another size than the picture
    half = maps[:, 1::2, 1::2]
    np.savez(f"{work}/half.npz", pts3d=half, poses=relative)
    _, got = imported("half", bare, "--pointmaps", f"{work}/half.npz", "--intrinsics", numbers, "--depth-unit", "0.001")
    check(got["depth"][2].shape == (SIDE // 2, SIDE // 2), "half: the map's size is kept")
    _, got = imported("half", bare, "--pointmaps", f"{work}/half.npz", "--intrinsics", numbers, "--depth-unit", "0.001",
                      "--size", "24x24")
    check(got["depth"][2].shape == (24, 24), "half: resized")


def test_one_world(room, maps):
    """Frames 0 and 1 have pointmaps, 2 and 3 only the folder's poses."""
    def some(name, **arrays):
        path = folder(name, room, pointmap_path=[f"{i}.npz" for i in range(FRAMES)], **MM)
        edit(path, lambda i, frame: frame.pop("pointmap_path") if i >= 2 else None)
        for i in range(2):
            np.savez(f"{path}/{i}.npz", pts3d=maps[i], **{key: values[i] for key, values in arrays.items()})
        return path

    path = some("some")
    refused(path, ["2.png: no pointmap to estimate its pose from"], "--poses", "estimate")
    for options in ((path,), (folder("colour", room), "--pointmaps", f"{work}/points.npz")):
        refused(options[0], ["estimate-colour does not go with pointmaps"], *options[1:], "--poses", "estimate-colour")
    _, got = imported("some", path)
    check(all(np.abs(got["pose"][i] - room["pose"][i]).max() < 1e-6 for i in range(FRAMES)), "some: poses are the folder's")
    # poses of the points' frame next to the folder's: another world, unless they agree
    relative = [np.linalg.inv(room["pose"][0]) @ p for p in room["pose"]]
    check(np.abs(room["pose"][0] - np.eye(4)).max() > 0.01, "the room's first pose is not the origin")
    refused(some("other", poses=relative), ["2.png: its pose is the folder's", "of 0.png is in its points' frame"])
    path = some("agreed", poses=[p.astype(np.float32) for p in room["pose"]])
    for i in range(2):
        world = np.c_[maps[i].reshape(-1, 3), np.ones(maps[i][..., 0].size)] @ room["pose"][0].T
        np.savez(f"{path}/{i}.npz", pts3d=world[:, :3].reshape(maps[i].shape).astype(np.float32),
                 poses=room["pose"][i].astype(np.float32))
    _, got = imported("agreed", path)
    check(all(np.abs(got["pose"][i] - room["pose"][i]).max() < 1e-6 for i in range(FRAMES)), "agreed: poses")


def test_options_of_pointmaps_alone(room, _):
    path = folder("no_maps", room, **MM)
    refused(path, ["no_maps", "--min-confidence is for pointmaps"], "--min-confidence", "3")
    refused(path, ["no_maps", "--depth-unit is for pointmaps"], "--depth-unit", "5")
    refused(path, ["no_maps", "--depth-unit is for pointmaps"], "--depth-unit", "5", "--poses", "estimate")
    for option, value, code, words in (("--min-confidence", "3", 2, "is a recording"),
                                       ("--depth-unit", "5", 1, "states its own depth unit")):
        target = f"{work}/refused.mcap"
        status, _, error = run("import", f"{work}/room.mcap", "--poses", "estimate", option, value, "-o", target)
        check(status == code and words in error, f"{option} with a recording: {status}, {error}")
        check(not os.path.exists(target), f"{option} with a recording: left one behind")


def test_larger_pictures(room, maps):
    """Intrinsics refer to the pictures; the maps have half their sides. Cropped to the maps' size, everything is the
    room's."""
    k = room["camera_info"][0]
    large = dict(room, image=[rgb.repeat(2, 0).repeat(2, 1) for rgb in room["image"]],
                 camera_info=[np.diag([2, 2, 1]) @ k + [[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]] for k in room["camera_info"]])
    numbers = ",".join(repr(float(x)) for x in (2 * k[0, 0], 2 * k[1, 1], 2 * k[0, 2] + 0.5, 2 * k[1, 2] + 0.5))
    size, unit = ("--size", f"{SIDE}x{SIDE}"), ("--depth-unit", "0.001")
    np.savez(f"{work}/points.npz", pts3d=maps)
    bare = folder("large", large, posed=None)
    _, got = imported("large", bare, "--pointmaps", f"{work}/points.npz", "--intrinsics", numbers, *size, *unit)
    same("large", got, room, 1e-5)
    path = folder("large_json", large, posed=False, **MM)
    _, got = imported("large_json", path, "--pointmaps", f"{work}/points.npz", *size)
    same("large, transforms.json without w", got, room, 1e-5)
    edit(path, lambda _, frame: frame.update(w=2 * SIDE, h=2 * SIDE,
                                             camera_angle_x=2 * np.arctan(SIDE / frame.pop("fl_x")),
                                             camera_angle_y=2 * np.arctan(SIDE / frame.pop("fl_y"))))
    _, got = imported("large_angle", path, "--pointmaps", f"{work}/points.npz", *size)
    same("large, by field of view", got, room, 1e-5)
    os.remove(f"{path}/2.png")
    refused(path, ["2.png: No such file"], "--pointmaps", f"{work}/points.npz")


def test_refusals(room, maps):
    path = folder("bad", room, **MM)
    file = f"{work}/bad.npz"

    def bad(expected, *options, **arrays):
        np.savez(file, **arrays)
        refused(path, ["bad.npz", *expected], "--pointmaps", file, *options)

    def changed(value, at=(1, 20, 30, 2)):
        out = maps.copy()
        out[at] = value
        return out

    bad(["array pts3d: [1, 20, 30, 2] is not a number"], pts3d=changed(np.nan))
    bad(["array pts3d: [1, 20, 30, 2] is infinite"], pts3d=changed(-np.inf))
    bad(["array conf: [0, 1, 2] is not a number"], pts3d=maps,
        conf=np.where(np.arange(maps[..., 0].size).reshape(maps.shape[:3]) == SIDE + 2, np.nan, 1).astype(np.float32))
    bad(["array conf of 4x96x95", "4 views of 96x96"], pts3d=maps, conf=np.ones((4, 96, 95), np.float32))
    bad(["3 pointmaps", "has 4 frames"], pts3d=maps[:3])
    bad(["array pts3d of 4x96x96x2", "last dimension is not 3"], pts3d=maps[..., :2])
    bad(["array pts3d of 96x96", "not so many dimensions"], pts3d=maps[0, ..., 0])
    bad(["array pts3d", "float64, but points are float32"], pts3d=maps.astype(np.float64))
    bad(["array pts3d", "descr is neither"], pts3d=maps.astype(np.float16))
    bad(["array pts3d", "descr is neither"], pts3d=maps.astype(">f4"))
    bad(["array pts3d", "fortran_order"], pts3d=np.asfortranarray(maps))
    bad(["no array pts3d"], depth=maps)
    bad(["array poses of 3x4x4", "not as many"], pts3d=maps, poses=np.stack([np.eye(4)] * 3))
    bad(["array poses", "orthonormal"], pts3d=maps, poses=np.stack([np.eye(4) * [2, 1, 1, 1]] * 4))
    bad(["array intrinsics", "focal length"], pts3d=maps, intrinsics=np.zeros((4, 3, 3)))
    bad(["array pts3d", "descr"], pts3d=np.array([{"a": 1}], dtype=object))
    np.savez(file, pts3d=maps[:, :, :64])
    refused(path, ["pointmap of 64x96 pixels", "96x96"], "--pointmaps", file)
    np.savez(file, pts3d=maps, conf=np.ones(maps.shape[:3], np.float32))
    refused(path, ["no point", "confident enough"], "--pointmaps", file, "--min-confidence", "2")
    np.savez(file, pts3d=np.random.default_rng(1).normal(size=maps.shape).astype(np.float32))
    refused(path, ["do not lie on the pixels' rays"], "--pointmaps", file, "--poses", "estimate")
    # truncated, changed, foreign
    np.savez(file, pts3d=maps)
    with open(file, "rb") as f:
        whole = f.read()
    for keep in (0, 10, len(whole) // 2, len(whole) - 30):
        with open(file, "wb") as f:
            f.write(whole[:keep])
        refused(path, ["bad.npz: "], "--pointmaps", file)
    with open(file, "wb") as f:
        f.write(whole[:5000] + bytes([whole[5000] ^ 1]) + whole[5001:])
    refused(path, ["array pts3d: CRC error"], "--pointmaps", file)
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("pts3d.npy", b"not an array")
    refused(path, ["array pts3d: not a NumPy array"], "--pointmaps", file)
    refused(path, ["0.png: neither .npz nor .npy"], "--pointmaps", f"{path}/0.png")
    refused(path, ["nowhere.npz: No such file"], "--pointmaps", f"{work}/nowhere.npz")
    array = f"{work}/one.npy"
    np.save(array, maps[0])
    with open(array, "rb") as f:
        whole = f.read()
    for content, expected in ((whole[:-4], "cut off"), (whole + b"\0", "bytes of numbers"), (whole[:60], "cut off in its")):
        with open(array, "wb") as f:
            f.write(content)
        refused(path, ["one.npy: ", expected], "--pointmaps", array)
    refused(folder("both", room, depth_path=["0.png"] * FRAMES, pointmap_path=["0.npy"] * FRAMES, **MM),
            ["frames[0]: pointmap_path: there is a depth_path too"])


with tempfile.TemporaryDirectory() as work:
    code, _, message = run("room", "--size", f"{SIDE}x{SIDE}", "--frames", str(FRAMES), "-o", f"{work}/room.mcap")
    check(code == 0, f"room: {message}")
    the_room = read(f"{work}/room.mcap")
    for test in (test_files_of_frames, test_one_file, test_one_world, test_options_of_pointmaps_alone, test_larger_pictures,
                 test_refusals):
        test(the_room, points(the_room))
done()
