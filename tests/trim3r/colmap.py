#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""colmap.py TRIM3R: `build --colmap` checked by an independent reader of COLMAP's text models: points agree with the
pictures to half a pixel and in colour."""
import json
import math
import os
import sys
import tempfile

try:
    import cv2
    import numpy
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

from checks import check, done  # noqa: E402
from program import beyond, expect, expect_json  # noqa: E402
from stepped_wall import stepped_wall  # noqa: E402





def lines_of(path):
    with open(path, encoding="ascii") as file:
        return [line.rstrip("\n") for line in file if not line.startswith("#")]


def read_model(folder):
    """Returns ({image id: (name, R, t, K, points 2D, their points 3D)}, {point id: (xyz, rgb, error, track)})."""
    cameras, images, points = {}, {}, {}
    for line in lines_of(f"{folder}/sparse/0/cameras.txt"):
        number, model, *numbers = line.split()
        width, height, fx, fy, cx, cy = map(float, numbers)
        check(model == "PINHOLE", "cameras are pinhole")
        cameras[int(number)] = (width, height, numpy.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]))
    lines = lines_of(f"{folder}/sparse/0/images.txt")
    check(len(lines) % 2 == 0, "two lines an image")
    for first, second in zip(lines[::2], lines[1::2]):
        number, *pose, camera, name = first.split()
        w, *v = map(float, pose[:4])
        check(abs(w * w + numpy.dot(v, v) - 1) < 1e-12, "a unit quaternion")
        rotation = cv2.Rodrigues(2 * math.atan2(numpy.linalg.norm(v), w) * numpy.array(v) /
                                 max(numpy.linalg.norm(v), 1e-300))[0]
        observed = numpy.array(list(map(float, second.split()))).reshape(-1, 3)
        images[int(number)] = (name, rotation, numpy.array(list(map(float, pose[4:]))), *cameras[int(camera)],
                               observed[:, :2], observed[:, 2].astype(int))
    for line in lines_of(f"{folder}/sparse/0/points3D.txt"):
        number, *rest = line.split()
        track = list(map(int, rest[7:]))
        points[int(number)] = (numpy.array(list(map(float, rest[:3]))), tuple(map(int, rest[3:6])), float(rest[6]),
                               list(zip(track[::2], track[1::2])))
    return images, points


def project(image, xyz):
    """Projects to pixels in COLMAP's convention, with OpenCV."""
    _, rotation, translation, _, _, k = image[:6]
    if not len(xyz):
        return numpy.empty((0, 2))
    return cv2.projectPoints(numpy.array(xyz), rotation, translation, k, None)[0].reshape(-1, 2)


def check_model(folder, sizes, count):
    """Checks what holds for every model; returns the model and the distance of each observation from its point's
    projection."""
    images, points = read_model(folder)
    check(len(points) == count and all(0 <= c <= 255 for p in points.values() for c in p[1]), "a point a Gaussian")
    apart = []
    for number, image in images.items():
        picture = cv2.imread(f"{folder}/images/{image[0]}")
        check(picture is not None and picture.shape[1::-1] == (image[3], image[4]) == sizes, "pictures of that size")
        xy, ids = image[6], image[7]
        check(len(set(ids)) == len(ids), "a point once an image")
        check((xy >= 0).all() and (xy < sizes).all(), "observations lie within the picture")
        apart += list(numpy.linalg.norm(project(image, [points[i][0] for i in ids]) - xy, axis=1))
        for index, point in enumerate(ids):
            check(points[point][3] == [(number, index)] and points[point][2] == 0, "tracks and observations agree")
    check(sum(len(p[3]) for p in points.values()) == len(apart), "and nothing else is observed")
    check(all(p[2] == -1 for p in points.values() if not p[3]), "no error without an observation")
    return images, points, apart


def read_ply(path):
    with open(path, "rb") as file:
        head, body = file.read().split(b"end_header\n", 1)
    names = [line.split()[-1].decode() for line in head.split(b"\n") if line.startswith(b"property")]
    return numpy.frombuffer(body, "<f4").reshape(-1, len(names))[:, :3]




def retained_pixels(recording, folder, sizes, context):
    """Unmoved points are the retained pixels: their observations are pixel centres, and have the pixels' colours."""
    model, ply = f"{folder}/pixels", f"{folder}/pixels.ply"
    answer = expect_json("build", recording, "--context", context, "--keep", "20%", "--head", "none", "--refine", "0",
                            "--exposure", "off", "--rim", "off", "--colmap", model, "-o", ply)
    check(answer["colmap"] == model, "JSON tells the folder")
    images, points, apart = check_model(model, sizes, answer["gaussians"])
    check(max(apart) < 0.01, f"reprojected within a hundredth of a pixel: {max(apart)}")
    check([i[0] for i in images.values()] == [f"frame_{int(c):06d}.png" for c in context.split(",")], "names of frames")
    scene = read_ply(ply)
    check(numpy.abs(scene - numpy.array([p[0] for p in points.values()])).max() < 1e-3, "the scene's own means")
    centre, colour, seen = 0, 0, 0
    for image in images.values():
        picture = cv2.imread(f"{model}/images/{image[0]}")[..., ::-1].astype(int)
        for (x, y), point in zip(image[6], image[7]):
            pixel = picture[int(y), int(x)]
            seen += 1
            centre += max(abs(x % 1 - 0.5), abs(y % 1 - 0.5)) < 0.02
            colour += max(abs(pixel - points[point][1])) <= 1
    check(seen > 0.98 * len(points), f"{seen} of {len(points)} are observed")
    check(centre > 0.999 * seen, f"{seen - centre} of {seen} observations are not pixel centres")
    check(colour > 0.999 * seen, f"{seen - colour} of {seen} points have other colours than their pixels")
    return images, points


def other_views(folder, images, points):
    """Checks that a point of one view appears in the other with its colour: the poses fit together."""
    for number, image in images.items():
        own = [p for p in points.values() if p[3] and p[3][0][0] != number]
        picture = cv2.imread(f"{folder}/pixels/images/{image[0]}")[..., ::-1].astype(float)
        xy = project(image, [p[0] for p in own])
        far = numpy.array([(image[1] @ p[0] + image[2])[2] for p in own]) > 0
        inside = far & (xy >= 1).all(axis=1) & (xy < numpy.array([image[3], image[4]]) - 1).all(axis=1)
        check(inside.sum() > 50, "views overlap")
        # pixel (i, j) covers i..i+1 here, so OpenCV's coordinates are smaller by half a pixel
        at = (xy[inside] - 0.5).astype(numpy.float32)
        shown = cv2.remap(picture, at[:, :1].reshape(-1, 1), at[:, 1:].reshape(-1, 1), cv2.INTER_LINEAR)[:, 0]
        error = numpy.abs(shown - numpy.array([p[1] for p in own])[inside]).mean(axis=1)
        check(numpy.median(error) < 12, f"image {number}: colours differ by {numpy.median(error)} in the median")


def adapted(recording, folder, sizes):
    model, ply = f"{folder}/adapted", f"{folder}/adapted.ply"
    build = ["build", recording, "--context", "0,2", "--keep", "20%", "--backdrop", "on"]
    answer = expect_json(*build, "--colmap", model)
    check("scene" not in answer, "no scene file was asked for")
    expect_json(*build, "-o", ply)
    check(beyond(ply) > 54, f"no whole backdrop and rim: {beyond(ply)}")
    _, points, apart = check_model(model, sizes, answer["gaussians"] - beyond(ply))  # these are no points
    check(max(apart) < 0.01 and len(apart) > 0.9 * len(points), "reprojected")


def local(recording, folder, sizes):
    """With --local: the same, relative to the first camera's centre."""
    model = f"{folder}/local"
    count = json.loads(expect(0, "build", recording, "--context", "0,1", "--gaussians", "500", "--local", "--rim", "off", "--colmap", model,
                           "--json"))["gaussians"]
    images, _, apart = check_model(model, sizes, count)
    check(max(apart) < 0.01, "reprojected")
    check(numpy.abs(images[1][2]).max() == 0, "the first camera stands at the origin")


def elsewhere(recording, folder, sizes):
    """Gaussians made elsewhere have no source view."""
    ply, model = f"{folder}/theirs.ply", f"{folder}/pruned"
    expect(0, "build", recording, "--context", "0,2", "--gaussians", "400", "-o", ply)
    expect(0, "build", recording, "--context", "0,2", "--prune", ply, "--method", "eagles", "--gaussians", "100", "--colmap", model)
    _, points, apart = check_model(model, sizes, 100)
    check(not apart and len(points) == 100, "nothing is observed")
    model = f"{folder}/rival"
    expect(0, "build", recording, "--context", "0,2", "--method", "random", "--gaussians", "100", "--colmap", model)
    _, _, apart = check_model(model, sizes, 100)
    check(len(apart) > 90, "a rival's points are observed")


def lens_recording(folder):
    """Makes two frames through a lens with distortion, rolled and far from the origin."""
    made = f"{folder}/lens"
    os.mkdir(made)
    random = numpy.random.default_rng(2)
    frames = []
    for i in range(2):
        picture = cv2.GaussianBlur(random.integers(0, 255, (48, 64, 3), dtype=numpy.uint8), (0, 0), 2)
        cv2.imwrite(f"{made}/{i}.png", picture)
        cv2.imwrite(f"{made}/{i}.depth.png", numpy.full((48, 64), 1500 + 40 * i, dtype=numpy.uint16))
        pose = numpy.eye(4)
        pose[:3, :3] = cv2.Rodrigues(numpy.array([2.0, 1.0 + i / 10, -1.5]))[0]
        pose[:3, 3] = (100 + i / 10, -20, 7)
        frames.append({"file_path": f"{i}.png", "depth_path": f"{i}.depth.png", "transform_matrix": pose.tolist()})
    with open(f"{made}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"fl_x": 60, "fl_y": 62, "cx": 31, "cy": 25, "w": 64, "h": 48, "k1": 0.1, "k2": -0.02,
                   "integer_depth_scale": 0.001, "frames": frames}, file)
    expect(0, "import", made, "-o", f"{made}.mcap")
    return f"{made}.mcap"


def moved_recording(folder):
    """Makes two frames of a smooth wall with a step, the second's pose rolled by half a degree."""
    made = f"{folder}/moved"
    stepped_wall(made, axis=2, degrees=(0, 0.5))
    expect(0, "import", made, "-o", f"{made}.mcap")
    return f"{made}.mcap"


def aligned(recording, folder):
    """Checks that the model has the corrected poses where a build corrects them, and that the report says by how
    much."""
    told = expect_json("build", recording, "--context", "0,1", "--keep", "5%", "-o", f"{folder}/a.ply")["aligned"]
    turned = sum(view["degrees"] for view in told)
    check(0.3 < turned < 0.7, f"corrected by {turned} of half a degree")
    text = expect(0, "build", recording, "--context", "0,1", "--keep", "5%", "-o", f"{folder}/a.ply", "--force")
    check(f"pose of frame 1 corrected by {told[1]['degrees']:.2f} degrees" in text, "told")
    still = json.loads(expect(0, "build", recording, "--context", "0,1", "--keep", "5%", "--align", "off", "-o", f"{folder}/b.ply",
                           "--json"))["aligned"]
    check(all(view["degrees"] == view["distance"] == 0 for view in still), "as given without --align")


with tempfile.TemporaryDirectory() as folder:
    room, lens = f"{folder}/room.mcap", lens_recording(folder)
    expect(0, "room", "--size", "96x64", "-o", room)
    os.mkdir(f"{folder}/a")
    other_views(f"{folder}/a", *retained_pixels(room, f"{folder}/a", (96, 64), "0,2"))
    os.mkdir(f"{folder}/b")
    retained_pixels(lens, f"{folder}/b", (64, 48), "1,0")
    adapted(room, folder, (96, 64))
    moved = moved_recording(folder)
    os.mkdir(f"{folder}/c")
    aligned(moved, f"{folder}/c")
    retained_pixels(moved, f"{folder}/c", (96, 64), "0,1")
    local(lens, folder, (64, 48))
    elsewhere(room, folder, (96, 64))
    budget = ("build", room, "--keep", "10%")
    expect(1, *budget, "--colmap", f"{folder}/a/pixels", err="not empty")
    expect(2, *budget, "--colmap", room, err=room)
    expect(1, *budget, "--colmap", lens, err="not a folder")
    expect(1, *budget, "--colmap", f"{folder}/no/such", err="no/such")
    expect(2, *budget, err="-o SCENE.ply is missing")
done()
