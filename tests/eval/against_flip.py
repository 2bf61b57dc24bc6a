#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""against_flip.py SCORE_PICTURES: FLIP against its definition (Andersson et al. 2020, 67 pixels a degree), written
plainly with full two-dimensional kernels."""
import json
import sys
import tempfile

from checks import done, near, run
from common import need_numpy

numpy, cv2 = need_numpy()
PPD = 67.0
PI = numpy.pi
TO_XYZ = numpy.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                      [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                      [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = TO_XYZ.sum(1)


def correlate(plane, kernel):
    radius = kernel.shape[0] // 2
    padded = numpy.pad(plane, radius, mode="edge")
    windows = numpy.lib.stride_tricks.sliding_window_view(padded, kernel.shape)
    return numpy.einsum("yxij,ij->yx", windows, kernel)


def opponent(rgb):
    xyz = rgb @ TO_XYZ.T / WHITE
    x, y, z = xyz[..., 0], xyz[..., 1], xyz[..., 2]
    return numpy.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def from_opponent(planes):
    y = (planes[..., 0] + 16) / 116
    xyz = numpy.stack([planes[..., 1] / 500 + y, y, y - planes[..., 2] / 200], -1) * WHITE
    return numpy.clip(xyz @ numpy.linalg.inv(TO_XYZ).T, 0, 1)


def hunt_lab(rgb):
    xyz = rgb @ TO_XYZ.T / WHITE
    f = numpy.where(xyz > (6 / 29) ** 3, numpy.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    light = 116 * f[..., 1] - 16
    chroma = 0.01 * light
    return numpy.stack([light, chroma * 500 * (f[..., 0] - f[..., 1]), chroma * 200 * (f[..., 1] - f[..., 2])], -1)


def hyab(a, b):
    d = a - b
    return numpy.abs(d[..., 0]) + numpy.hypot(d[..., 1], d[..., 2])


def grid(radius):
    return numpy.meshgrid(numpy.arange(-radius, radius + 1.0), numpy.arange(-radius, radius + 1.0))


def contrast_kernel(a1, b1, a2, b2):
    x, y = grid(int(numpy.ceil(3 * numpy.sqrt(0.04 / (2 * PI**2)) * PPD)))
    square = (x**2 + y**2) / PPD**2
    g = a1 * numpy.sqrt(PI / b1) * numpy.exp(-PI**2 * square / b1)
    g += a2 * numpy.sqrt(PI / b2) * numpy.exp(-PI**2 * square / b2)
    return g / g.sum()


def features(luma, points):
    sigma = 0.5 * 0.082 * PPD
    x, y = grid(int(numpy.ceil(3 * sigma)))
    k = (x**2 / sigma**2 - 1 if points else -x) * numpy.exp(-(x**2 + y**2) / (2 * sigma**2))
    k = numpy.where(k < 0, k / -k[k < 0].sum(), k / k[k > 0].sum())
    return numpy.hypot(correlate(luma, k), correlate(luma, k.T))


def flip(target, render):
    kernels = [contrast_kernel(1, 0.0047, 0, 1e-5), contrast_kernel(1, 0.0053, 0, 1e-5),
               contrast_kernel(34.1, 0.04, 13.5, 0.025)]
    labs, edges, points = [], [], []
    for image in (target, render):
        s = image / 255.0
        planes = opponent(numpy.where(s > 0.04045, ((s + 0.055) / 1.055) ** 2.4, s / 12.92))
        luma = (planes[..., 0] + 16) / 116
        edges.append(features(luma, False))
        points.append(features(luma, True))
        labs.append(hunt_lab(from_opponent(numpy.stack([correlate(planes[..., c], kernels[c]) for c in range(3)], -1))))
    largest = hyab(hunt_lab(numpy.array([0.0, 1, 0])), hunt_lab(numpy.array([0, 0, 1.0]))) ** 0.7
    power = hyab(*labs) ** 0.7
    knee = 0.4 * largest
    colour = numpy.where(power < knee, 0.95 * power / knee, 0.95 + 0.05 * (power - knee) / (largest - knee))
    feature = numpy.maximum(abs(edges[0] - edges[1]), abs(points[0] - points[1]))
    return colour ** (1 - numpy.clip((feature / numpy.sqrt(2)) ** 0.5, 0, 1))


random = numpy.random.default_rng(11)
with tempfile.TemporaryDirectory() as folder:
    names = [f"{folder}/{name}.png" for name in ("target", "render", "mask")]
    for height, width in ((48, 56), (9, 31)):
        for kind in range(3):
            target = random.integers(0, 256, (height, width, 3)).astype(numpy.uint8)
            render = random.integers(0, 256, (height, width, 3)).astype(numpy.uint8)
            if kind > 0:
                target = cv2.GaussianBlur(target, (0, 0), 3)
                render = cv2.GaussianBlur(target, (0, 0), 2) if kind == 1 else numpy.roll(target, 1, axis=1)
            mask = random.random((height, width)) < 0.5
            for name, image in zip(names, (target, render, numpy.where(mask, 255, 0).astype(numpy.uint8))):
                cv2.imwrite(name, image)
            # OpenCV writes B, G, R
            error = flip(target[..., ::-1], render[..., ::-1])
            ours = json.loads(run(sys.argv[1], *names[:2]).stdout)["flip"]
            near(ours, error.mean(), 1e-6, f"kind {kind}, {width}x{height}")
            ours = json.loads(run(sys.argv[1], *names).stdout)["flip"]
            near(ours, error[mask].mean(), 1e-6, f"kind {kind}, {width}x{height}, masked")
done()
