#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""spread.py TRIM3R: a scene of near detail in far surroundings is drawn as by floats, from within each and from outside,
whatever part of the Gaussians is near."""
import json
import math
import random
import struct
import sys

try:
    import cv2
    import numpy
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

from program import check, expect, in_scratch, write  # noqa: E402

NAMES = "x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3".split()
COUNT, SIDE, FOCAL = 240, 64, 60
ZERO = 0.28209479177387814  # the harmonic of degree 0
LEAST = 40  # dB; a scene whose near or far part is missing has 27 at most


def scattered(share, ratio, places, seed=1):
    """Returns round Gaussians: this share near one or two places, the others in a shell that is `ratio` times as wide."""
    drawn, rows = random.Random(seed), []
    for i in range(COUNT):
        way = numpy.array([drawn.gauss(0, 1) for _ in range(3)])
        is_near = i < share * COUNT
        far = 0.3 + 0.7 * drawn.random() if is_near else ratio * (0.8 + 0.2 * drawn.random())
        place = way / numpy.linalg.norm(way) * far
        place[0] += 0.3 * ratio * (i % places if is_near else 0)
        size = math.log(0.12 if is_near else 0.12 * ratio)
        rows.append([*place, *(drawn.uniform(-1.7, 1.7) for _ in range(3)), 3, size, size, size, 1, 0, 0, 0])
    return numpy.array(rows, numpy.float32)


def ply(path, rows):
    head = "".join(f"property float {name}\n" for name in NAMES)
    write(path, f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n{head}end_header\n".encode() + rows.astype("<f4").tobytes())


def axes_towards(eye, target):
    """Returns right, down and forward as rows."""
    forward = (target - eye) / numpy.linalg.norm(target - eye)
    right = numpy.cross(forward, [0.1, -0.2, 1.0])
    right /= numpy.linalg.norm(right)
    return numpy.array([right, numpy.cross(forward, right), forward])


def wanted(rows, eye, axes):
    """Draws in floats. Returns the colours, the depths, those of the Gaussian that first hides half of what is beyond, and the
    errors that compressed depths allow: the square of the change of depth from the Gaussian's middle, in parts of it."""
    rows = rows.astype(float)
    seen = (rows[:, :3] - eye) @ axes.T
    colour, left = numpy.zeros((SIDE, SIDE, 3)), numpy.ones((SIDE, SIDE))
    depth, slack = numpy.zeros((SIDE, SIDE)), numpy.zeros((SIDE, SIDE))
    down, across = numpy.mgrid[0:SIDE, 0:SIDE]
    middle, most = (SIDE - 1) / 2, 1.3 * SIDE / 2 / FOCAL
    for i in numpy.argsort(seen[:, 2], kind="stable"):
        x, y, z = seen[i]
        if z <= 0 or max(abs(x), abs(y)) > 16 * z:
            continue
        u, v = (min(max(slope, -most), most) for slope in (x / z, y / z))
        change = FOCAL / z * math.exp(rows[i, 7]) * numpy.array([[1, 0, -u], [0, 1, -v]])
        form = numpy.linalg.inv(change @ change.T + 0.3 * numpy.eye(2))
        dx, dy = across - FOCAL * x / z - middle, down - FOCAL * y / z - middle
        falls = form[0, 0] * dx * dx + 2 * form[0, 1] * dx * dy + form[1, 1] * dy * dy
        alpha = numpy.minimum(numpy.exp(-falls / 2) / (1 + math.exp(-rows[i, 6])), 0.99)
        alpha[alpha < 1 / 255] = 0
        colour += (left * alpha)[..., None] * numpy.clip(0.5 + ZERO * rows[i, 3:6], 0, 1)
        slope = form @ change @ [0, 0, math.exp(rows[i, 7]) / z]
        bound = 2 * math.exp(rows[i, 7]) / (z + 2 * math.exp(rows[i, 7]))
        surface = z / (1 - numpy.clip(slope[0] * dx + slope[1] * dy, -bound, bound))
        halves = (left > 0.5) & (left * (1 - alpha) <= 0.5)
        depth[halves] = surface[halves]
        slack[halves] = ((surface - z) ** 2 / z)[halves]
        left *= 1 - alpha
    return numpy.rint(colour * 255), depth, slack


def look(eye, axes, *more):
    matrix = numpy.eye(4)
    matrix[:3, :3], matrix[:3, 3] = (axes * [[1], [-1], [-1]]).T, eye
    write("p.json", json.dumps({"fl_x": FOCAL, "w": SIDE, "h": SIDE, "transform_matrix": matrix.tolist()}))
    expect(0, "render", "s.ply", "--pose", "p.json", *more, "-o", "v.png")
    return cv2.imread("v.png")[..., ::-1].astype(float)


def views():
    cases = [(share, 6000, places) for share in (0.4, 0.5, 0.6, 0.75, 0.9) for places in (1, 2)]
    cases += [(0.5, 100, 1), (0.6, 100, 2), (0.6, 60000, 1), (0.9, 60000, 2)]
    for share, ratio, places in cases:
        rows = scattered(share, ratio, places)
        ply("s.ply", rows)
        for eye, target in (((0.1, 0, 0), (1, 0.2, 0.1)), ((3, 1, 0), (0, 0, 0)), ((0.3 * ratio, 0.1 * ratio, 0), (ratio, 0, 0)),
                            ((0.4 * ratio, 0.2 * ratio, 0), (0, 0, 0)), ((2.5 * ratio, 0.2 * ratio, 0), (0, 0, 0))):
            eye = numpy.array(eye, float)
            axes = axes_towards(eye, numpy.array(target, float))
            error = ((look(eye, axes) - wanted(rows, eye, axes)[0]) ** 2).mean()
            db = 10 * math.log10(255 ** 2 / error) if error else math.inf
            check(db >= LEAST, f"{share:.0%} near, {ratio} times, in {places}: {db:.1f} dB from {eye}")


def depths():
    """A depth picture has the depths of the scene, near and far."""
    ratio = 6000
    rows = scattered(0.6, ratio, 1)
    ply("s.ply", rows)
    for eye, unit in ((numpy.array([1.5, 0, 0]), 0.2), (numpy.array([0.4 * ratio, 0.2 * ratio, 0]), 0.2)):
        axes = axes_towards(eye, numpy.array([ratio / 2, ratio / 4, ratio / 3]))
        look(eye, axes, "--depth", "d.png", "--depth-unit", unit)
        found = cv2.imread("d.png", cv2.IMREAD_UNCHANGED) * unit
        _, depth, slack = wanted(rows, eye, axes)
        shown = depth > 0
        check((depth > 0.3 * ratio).sum() > 100, "few pixels show the shell")
        right = abs(found[shown] - depth[shown]) < 0.001 * depth[shown] + 2 * slack[shown] + unit
        check(right.mean() > 0.97, f"{right.mean():.1%} of the depths are right")


in_scratch(views, depths)
