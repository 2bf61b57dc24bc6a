#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scene_info.py TRIM3R: `info SCENE.ply` against NumPy on the same file: counts, bounds, quantiles and bins of scales, in
world units and in pixels; the picture."""
import re
import sys
import tempfile
import xml.dom.minidom

try:
    import numpy
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

from checks import check, done  # noqa: E402
from program import expect, expect_json  # noqa: E402

SHARES = {"p5": 0.05, "p25": 0.25, "median": 0.5, "p75": 0.75, "p95": 0.95}


def near(a, b, text, bound=2e-3):
    a, b = numpy.asarray(a), numpy.asarray(b)
    check((numpy.abs(a - b) <= bound * numpy.maximum(numpy.abs(b), 1e-9)).all(), f"{text}: {a} and {b}")


def read_ply(path):
    with open(path, "rb") as file:
        head, body = file.read().split(b"end_header\n", 1)
    names = [line.split()[-1].decode() for line in head.split(b"\n") if line.startswith(b"property")]
    return dict(zip(names, numpy.frombuffer(body, "<f4").reshape(-1, len(names)).T.astype(float)))


def scales_of(columns):
    three = numpy.sort(numpy.exp([columns[f"scale_{i}"] for i in range(3)]), axis=0)
    return numpy.sort(numpy.sqrt(three[1] * three[2]))


def check_scene(told, edges, path):
    columns = read_ply(path)
    scales = scales_of(columns)
    check(told["scene"] == path and told["gaussians"] == len(scales), "the count")
    near(told["low"], [columns[c].min() for c in "xyz"], "bounds")
    near(told["high"], [columns[c].max() for c in "xyz"], "bounds")
    near(told["mean_opacity"], (1 / (1 + numpy.exp(-columns["opacity"]))).mean(), "opacity")
    near([told["scale"][n] for n in SHARES], [numpy.quantile(scales, s) for s in SHARES.values()], "quantiles of scales")
    expected, _ = numpy.histogram(numpy.clip(scales, edges[0], numpy.nextafter(edges[-1], 0)), edges)
    counts = numpy.array(told["scale_counts"])
    check(counts.sum() == len(scales), "every Gaussian is in a bin")
    # a value on an edge may fall to either side of it once it is rounded to the scene's integers
    check(numpy.abs(counts - expected).sum() <= 2 + 0.01 * len(scales), f"bins: {counts} and {expected}")
    return scales


def several(folder, room):
    paths = [f"{folder}/{name}.ply" for name in ("all", "pruned", "disc")]
    expect(0, "build", room, "--context", "0,2", "--keep", "100%", "-o", paths[0])
    expect(0, "build", room, "--context", "0,2", "--keep", "5%", "-o", paths[1])
    expect(0, "build", room, "--context", "0,2", "--keep", "5%", "--head", "analytic", "--refine", "0", "-o", paths[2])
    answer = expect_json("info", *paths, room, "--view", "1", "--svg", f"{folder}/s.svg")
    edges = numpy.array(answer["scale_edges"])
    near(edges[1:] / edges[:-1], 2**0.25, "a quarter of an octave", 1e-9)
    scales = [check_scene(t, edges, p) for t, p in zip(answer["scenes"], paths, strict=True)]
    check(edges[0] <= min(numpy.quantile(s, 0.001) for s in scales) * 1.001, "the bins begin below")
    check(edges[-1] >= max(numpy.quantile(s, 0.999) for s in scales) * 0.999, "and end above")
    medians = [s["scale"]["median"] for s in answer["scenes"]]
    check(medians[1] > 2 * medians[0] and medians[2] > 2 * medians[0], f"pruned scenes have wider Gaussians: {medians}")

    # pixels: the room's camera has fx = fy, and the depth is that of a measured plane of the same frame
    factor = answer["pixels_per_unit"]
    for scene in answer["scenes"]:
        near([scene["scale_pixels"][n] for n in SHARES], [scene["scale"][n] * factor for n in SHARES], "in pixels", 1e-9)
    model = f"{folder}/camera"
    expect(0, "build", room, "--context", "1", "--gaussians", "1", "--colmap", model)
    with open(f"{model}/sparse/0/cameras.txt", encoding="ascii") as file:
        fx, fy, cx, cy = map(float, file.read().split("\n")[1].split()[4:])
    with open(f"{model}/sparse/0/images.txt", encoding="ascii") as file:
        w, x, y, z, *translation = map(float, file.read().split("\n")[2].split()[1:8])
    rotation = numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    columns = read_ply(paths[0])
    seen = rotation @ numpy.array([columns[c] for c in "xyz"]) + numpy.array(translation)[:, None]
    u, v = fx * seen[0] / seen[2] + cx, fy * seen[1] / seen[2] + cy
    inside = (seen[2] > 0) & (u >= 0) & (u < 64) & (v >= 0) & (v < 64)
    near(answer["median_depth"], numpy.median(seen[2][inside]), "the median depth")
    near(factor, fx / answer["median_depth"], "pixels of a unit", 1e-9)

    picture = xml.dom.minidom.parse(f"{folder}/s.svg")
    names = [t.firstChild.data for t in picture.getElementsByTagName("text") if t.getAttribute("class") == "name"]
    check([n.split(":")[0] for n in names] == ["all", "pruned", "disc"], f"a panel each: {names}")
    check(all(" px" in n for n in names), "with pixels")
    bars = sum(sum(c > 0 for c in s["scale_counts"]) for s in answer["scenes"])
    check(len(picture.getElementsByTagName("rect")) == bars, "a bar a bin")
    check("prefers-color-scheme" in open(f"{folder}/s.svg", encoding="utf-8").read(), "light and dark")
    text = expect(0, "info", paths[1])
    check(re.search(rf"scale: .*median {medians[1]:.4g}", text) and "pixels" not in text, f"as text: {text}")
    check("up:      not stated; -y in most scenes: y points down" in text, f"no axis that points up: {text}")
    with open(paths[1], "rb") as file:
        head, body = file.read().split(b"end_header\n", 1)
    with open(f"{folder}/z.ply", "wb") as file:
        file.write(head + b"comment Generated by Polycam with Z-axis up\nend_header\n" + body)
    expect(0, "info", f"{folder}/z.ply", out="up:      z\n")
    return paths


with tempfile.TemporaryDirectory() as folder:
    room = f"{folder}/room.mcap"
    expect(0, "room", "--size", "64x64", "-o", room)
    paths = several(folder, room)
    expect(2, "info", paths[0], room, err="--view belong together")
    expect(2, "info", paths[0], "--view", "1", err="--view belong together")
    expect(2, "info", room, "--svg", f"{folder}/x.svg", err="belong to scenes")
    expect(2, "info", *[paths[1]] * 25, err="at most 24")
    expect(1, "info", f"{folder}/absent.ply", err="absent.ply")
    expect(1, "info", paths[0], room, "--view", "99", err="no frame 99")
    expect(1, "info", paths[0], "--svg", f"{folder}/no/x.svg", err="no/x.svg")
    with open(f"{folder}/empty.ply", "wb") as file, open(paths[0], "rb") as whole:
        head = whole.read().split(b"end_header\n")[0]
        file.write(re.sub(rb"element vertex \d+", b"element vertex 0", head) + b"end_header\n")
    expect(1, "info", paths[1], f"{folder}/empty.ply", err="empty.ply")
done()
