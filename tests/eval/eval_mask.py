#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_mask.py TRIM3R: the mask of `trim3r eval` follows from the recorded depth alone, computed here again. It is the
same for every head, budget, method, source of depth and scene file, and the whole picture where a frame has no depth."""
import json
import os
import sys
import tempfile

from checks import check, done, near, run
from common import need_numpy

numpy, cv2 = need_numpy()
trim3r = os.path.abspath(sys.argv[1])
SIDE, UNIT = 64, 0.001
WALL, BOX = 2.0, 1.3  # depths in metres
TURNS, PLACES = (3.0, 5.0, -4.0), (-0.13, 0.3, 0.17)  # of the cameras: degrees to the right, metres along x
CASE = ["--context", "0,2", "--target", "1"]
random = numpy.random.default_rng(8)
ROWS, COLUMNS = numpy.mgrid[0:SIDE, 0:SIDE]
RAYS = numpy.stack([(COLUMNS - (SIDE - 1) / 2) / SIDE, (ROWS - (SIDE - 1) / 2) / SIDE, numpy.ones((SIDE, SIDE))], axis=-1)
TEXTURE = cv2.GaussianBlur(random.integers(0, 256, (600, 600, 3)).astype(numpy.float32), (0, 0), 3)
TEXTURE = cv2.normalize(TEXTURE, None, 0, 255, cv2.NORM_MINMAX)


def pose_of(frame):
    """Returns rotation (camera to world, z forward) and centre."""
    angle = numpy.radians(TURNS[frame])
    c, s = numpy.cos(angle), numpy.sin(angle)
    return numpy.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]), numpy.array([PLACES[frame], 0, 0])


def drawn(frame):
    """Returns the colours and the depth, in steps, of a wall behind a box; some pixels have no depth."""
    rotation, centre = pose_of(frame)
    rays = RAYS @ rotation.T
    hits = {z: centre + rays * (z / rays[..., 2:]) for z in (WALL, BOX)}
    front = (numpy.abs(hits[BOX][..., :2]) < 0.2).all(axis=-1)[..., None]
    points = numpy.where(front, hits[BOX], hits[WALL])
    u, v = (((points[..., i] + points[..., 2] * 0.9 + 1) * 150).astype(numpy.float32) for i in (0, 1))
    colours = cv2.remap(TEXTURE, u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
    steps = numpy.rint(((points - centre) @ rotation)[..., 2] / UNIT).astype(numpy.uint16)
    steps[10 + 12 * frame:20 + 12 * frame, 30:50] = 0
    return colours.round().astype(numpy.uint8), steps


def recorded(name, without=(), lens=()):
    """Records the three frames; those in `without` have no depth."""
    os.mkdir(name)
    frames = []
    for i in range(3):
        rotation, centre = pose_of(i)
        pose = numpy.eye(4)
        pose[:3, :3], pose[:3, 3] = rotation @ numpy.diag([1, -1, -1]), centre
        cv2.imwrite(f"{name}/{i}.png", drawn(i)[0])
        cv2.imwrite(f"{name}/{i}.depth.png", drawn(i)[1])
        frames.append({"file_path": f"{i}.png", "transform_matrix": pose.tolist()})
        frames[-1].update({} if i in without else {"depth_path": f"{i}.depth.png"})
    with open(f"{name}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"fl_x": SIDE, "fl_y": SIDE, "cx": SIDE / 2, "cy": SIDE / 2, "w": SIDE, "h": SIDE,
                   "integer_depth_scale": UNIT, "frames": frames, "trim3r_triplets": [{"context": [0, 2], "target": 1}],
                   **dict(lens)}, file)
    run(trim3r, "import", name, "-o", f"{name}.mcap")
    return f"{name}.mcap"


def seen(target, contexts):
    """Computes the mask of a frame: pixels whose depth a context frame measured too, within 5 %, at the nearest pixel or
    beside it."""
    depths = [drawn(i)[1] * UNIT for i in range(3)]
    rotation, centre = pose_of(target)
    points = RAYS * depths[target][..., None] @ rotation.T + centre
    mask = numpy.zeros((SIDE, SIDE), bool)
    for frame in contexts:
        rotation, centre = pose_of(frame)
        own = (points - centre) @ rotation
        z = own[..., 2]
        u, v = (numpy.rint(own[..., i] / z * SIDE + (SIDE - 1) / 2).astype(int) for i in (0, 1))
        inside = (u >= 0) & (v >= 0) & (u < SIDE) & (v < SIDE)
        padded = numpy.pad(depths[frame], 1)
        for down in range(3):
            for across in range(3):
                other = padded[v.clip(0, SIDE - 1) + down, u.clip(0, SIDE - 1) + across]
                mask |= inside & (other > 0) & (numpy.abs(other - z) <= z / 20)
    return mask & (depths[target] > 0)


def evaluate(recording, folder, *options):
    """Returns the rows, the mask, and the target with the renders."""
    rows = json.loads(run(trim3r, "eval", recording, *CASE, *options, "--images", folder, "--json").stdout)["rows"]
    names = ("1/target.png", *(row["picture"] for row in rows))
    target, *renders = (cv2.imread(f"{folder}/{name}").astype(float) for name in names)
    return rows, cv2.imread(f"{folder}/1/mask.png", cv2.IMREAD_GRAYSCALE), target, renders


def decibels(a, b, mask):
    return 10 * numpy.log10(255**2 / ((a - b) ** 2)[mask].mean())


def by_depth_alone():
    room, expected = recorded("room"), seen(1, (0, 2))
    check(0.3 < expected.mean() < 0.9, f"the mask is neither empty nor everything: {expected.mean()}")
    run(trim3r, "build", room, "--context", "0,2", "--keep", "100", "--head", "none", "--refine", "0", "-o", "all.ply")
    run(trim3r, "build", room, "--context", "0,2", "--gaussians", "9", "-o", "few.ply")
    for i, options in enumerate((["--keep", "100,2", "--heads", "none,analytic,tiny,small"],
                                 ["--keep", "10", "--methods", "trim3r,random,eagles,random+finetune"],
                                 ["--keep", "10", "--depth", "stereo"], ["--keep", "10", "--fill", "4", "--bridge", "9"],
                                 ["--keep", "10", "--prune", "all.ply"], ["--scene", "all.ply"], ["--scene", "few.ply"])):
        rows, mask, target, renders = evaluate(room, f"pictures{i}", *options)
        check(numpy.array_equal(mask, numpy.where(expected, 255, 0)), f"{options}: {(mask != 255 * expected).sum()} pixels")
        for row, render in zip(rows, renders, strict=True):
            near(row["psnr"], decibels(target, render, expected), 2e-4, f"{options}: psnr")
            near(row["psnr_all"], decibels(target, render, expected | True), 2e-4, f"{options}: psnr_all")
            check(row["psnr_seen"] == row["psnr"], f"{options}: {row}")
    rows, _, _, _ = evaluate(room, "context", "--keep", "10")
    own = []
    for frame in (0, 2):
        run(trim3r, "build", room, "--context", "0,2", "--keep", "10", "-o", "ten.ply", "--force")
        run(trim3r, "render", "ten.ply", room, "--view", frame, "-o", f"view{frame}.png")
        own.append(decibels(drawn(frame)[0].astype(float), cv2.imread(f"view{frame}.png").astype(float), drawn(frame)[1] > 0))
    near(rows[0]["context_psnr"], numpy.mean(own), 0.02, "context views count where they have depth")


def without_depth():
    """One missing depth makes the mask of every view the whole picture, as far as the lens reaches."""
    for i, (without, options) in enumerate((((1,), ["--keep", "10"]), ((2,), ["--keep", "10", "--depth", "stereo"]),
                                            ((0, 1, 2), ["--keep", "10", "--depth", "stereo"]),
                                            ((0, 1, 2), ["--scene", "few.ply"]))):
        rows, mask, _, _ = evaluate(recorded(f"less{i}", without), f"whole{i}", *options)
        check((mask == 255).all(), f"without depth of {without}: {(mask == 0).sum()} pixels do not count")
        for row in rows:
            check(row["psnr_seen"] is None, f"{row}")
            check(all(row[name] == row[f"{name}_all"] for name in ("psnr", "ssim", "perceptual")), f"{row}")
    stressed = json.loads(run(trim3r, "stress", "less0.mcap", "--rows", "noise", "--strengths", "1", "--captures", "0",
                              "--keep", "10", "--json").stdout)["rows"]
    check([r["status"] for r in stressed] == ["measured"] * 2, f"stress without the target's depth: {stressed}")
    near(stressed[0]["psnr"], evaluate("less0.mcap", "again", "--keep", "10")[0][0]["psnr"], 1e-3, "stress has the same mask")
    lens = {"camera_model": "OPENCV", "k1": 0.2, "k2": 0, "p1": 0, "p2": 0}
    for without in ((), (1,)):
        name = f"lens{len(without)}"
        _, mask, target, _ = evaluate(recorded(name, without, lens), f"{name}_pictures", "--keep", "10")
        shown = cv2.imread(f"{name}_pictures/1/shown.png", cv2.IMREAD_GRAYSCALE)
        check(0 < (shown == 0).mean() < 0.5 and not target[shown == 0].any(), "the lens does not reach every pixel")
        check(not mask[shown == 0].any(), "pixels beyond the lens count in no mask")
        check(not without or numpy.array_equal(mask, shown), "all others count without depth")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    by_depth_alone()
    without_depth()
done()
