#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Endless made-up pictures with depth, and posed views of made-up rooms: training data that anyone can make again.

    tools/study/train/procedural.py --out sheet.png [--seed N] [--rooms]

draws a contact sheet. For training:

    source = Procedural(seed)
    image, depth = source.leaves(256, 256)      # uint8 [h, w, 3] RGB, float32 [h, w] metres along the axis
    views = source.room(256, 256, views=3)      # [{"image", "depth", "intrinsics", "pose"}], along a hand-held path
    depth = degrade_depth(rng, depth)           # rng: numpy.random.Generator; 0 = nothing measured
    image = expose(rng, image)

The pictures come from C (procedural.h tells how), compiled when first asked for into the build folder named, else
$TRIM3R_BUILD, else ~/.cache/trim3r. The same seed gives the same pictures, on other machines up to what libm rounds
otherwise."""
import argparse
import ctypes
import os
import struct
import zlib

import numpy as np

import native

PARTS = ("material", "camera", "leaves", "furniture", "light", "poster", "view", "path", "room")
SOURCES = tuple(f"procedural_{part}.c" for part in PARTS)
HEADERS = ("procedural.h", "procedural_scene.h")
# no contraction and no fast-math: -march=native must not change the pictures
FLAGS = ("-std=gnu11", "-O3", "-march=native", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math")

_loaded = {}


def build(folder=None, flags=FLAGS):
    """Compiles the generator; returns its path in `folder`."""
    sources, headers = ([os.path.join(native.HERE, name) for name in names] for names in (SOURCES, HEADERS))
    return native.build("procedural", sources, flags, headers, folder)


def _library(folder, flags):
    path = build(folder, flags)
    if path not in _loaded:
        library = ctypes.CDLL(path)
        library.procedural_atlas.restype = ctypes.c_void_p
        pointer, number, seed = ctypes.c_void_p, ctypes.c_int, ctypes.c_uint64
        library.procedural_leaves.argtypes = [pointer, seed, number, number, pointer, pointer]
        library.procedural_room.argtypes = [pointer, seed, number, number, number] + [pointer] * 4
        atlas = library.procedural_atlas()
        if not atlas:
            raise MemoryError("procedural: no memory for the texture tiles")
        _loaded[path] = library, atlas
    return _loaded[path]


def _mix(*parts):
    """Mixes integers to 64 bits, the same on all machines."""
    state = 0
    for part in parts:
        state = (state ^ (part & 0xFFFFFFFFFFFFFFFF)) * 0x9E3779B97F4A7C15 & 0xFFFFFFFFFFFFFFFF
        state ^= state >> 32
        state = state * 0xD6E8FEB86659FD93 & 0xFFFFFFFFFFFFFFFF
        state ^= state >> 29
    return state


class Procedural:
    """A stream of pictures. `index` counts the pictures drawn; set it to resume a stream."""

    def __init__(self, seed, index=0, build_folder=None, flags=FLAGS):
        self.seed, self.index = seed, index
        self._call, self._atlas = _library(build_folder, flags)

    def _next(self, kind):
        self.index += 1
        return _mix(self.seed, kind, self.index - 1)

    def leaves(self, width, height):
        """Returns (uint8 [height, width, 3] RGB, float32 [height, width] metres along the axis, > 0 everywhere)."""
        image, depth = np.empty((height, width, 3), np.uint8), np.empty((height, width), np.float32)
        status = self._call.procedural_leaves(
            self._atlas, self._next(1), width, height, image.ctypes.data, depth.ctypes.data
        )
        if status:
            raise ValueError(f"procedural: no picture of {width} x {height}: sides are 16 to 2048")
        return image, depth

    def room(self, width, height, views=3):
        """Returns `views` (1 to 16) views of one room along a hand-held path; of three, the middle one lies between the
        others.

        The result is a list of dictionaries: image uint8 [height, width, 3] RGB; depth float32 [height, width] metres
        along the axis; intrinsics float32 [4] fx fy cx cy, pixels; pose float32 [4, 4] camera-to-world, axes x right, y
        down, z forward, metres. Pixel (0, 0) is the centre of the top-left pixel. All views share one exposure."""
        images, depths = np.empty((views, height, width, 3), np.uint8), np.empty((views, height, width), np.float32)
        intrinsics, poses = np.empty((views, 4), np.float32), np.empty((views, 4, 4), np.float32)
        pointers = (a.ctypes.data for a in (images, depths, intrinsics, poses))
        if self._call.procedural_room(self._atlas, self._next(2), width, height, views, *pointers):
            asked = f"{views} views, {width} x {height}"
            raise ValueError(f"procedural: no room of {asked}: 1 to 16 views, sides 16 to 2048")
        return [
            {"image": images[i], "depth": depths[i], "intrinsics": intrinsics[i], "pose": poses[i]}
            for i in range(views)
        ]


def _rng(rng):
    return rng if isinstance(rng, np.random.Generator) else np.random.default_rng(rng)


def _smooth(field, width):
    """Returns box means of 2 width + 1 samples, twice each way, borders repeated."""
    for axis in (0, 1, 0, 1):
        padded = np.pad(field, [(width + 1, width) if a == axis else (0, 0) for a in (0, 1)], mode="edge")
        sums = np.cumsum(padded, axis, dtype=np.float64)
        field = np.diff(np.stack((np.roll(sums, 2 * width + 1, axis), sums)), axis=0)[0] / (2 * width + 1)
        field = field[2 * width + 1 :] if axis == 0 else field[:, 2 * width + 1 :]
    return field.astype(np.float32)


def _blobs(rng, shape, share):
    """Returns a mask of irregular patches that covers about `share` of the picture."""
    width = int(rng.integers(2, max(3, min(shape) // 16)))
    field = _smooth(rng.standard_normal(shape, dtype=np.float32), width)
    return field < np.quantile(field, share)


def depth_edges(depth, ratio=0.03):
    """Returns the pixels next to a jump of depth by more than `ratio` of the depth."""
    edge = np.zeros(depth.shape, bool)
    for axis in (0, 1):
        near, far = (depth[1:], depth[:-1]) if axis == 0 else (depth[:, 1:], depth[:, :-1])
        jump = np.abs(near - far) > ratio * np.minimum(near, far)
        (edge[1:] if axis == 0 else edge[:, 1:])[jump] = True
        (edge[:-1] if axis == 0 else edge[:, :-1])[jump] = True
    return edge


def depth_lattice(rng, shape):
    """Returns a mask of the pixels that another camera's depth samples fall on: a coarser lattice, turned and
    stretched."""
    height, width = shape
    step, angle = rng.uniform(1.2, 4.0), rng.uniform(-0.2, 0.2)
    aspect, bend = rng.uniform(0.9, 1.1), rng.uniform(-0.02, 0.02)
    reach = int(np.hypot(height, width) / step / min(aspect, 1.0)) // 2 + 2
    v, u = np.mgrid[-reach : reach + 1, -reach : reach + 1] * step
    bent = u * (1 + bend * v / height)
    x = np.cos(angle) * bent - np.sin(angle) * aspect * v + width / 2 + rng.uniform(0, step)
    y = np.sin(angle) * bent + np.cos(angle) * aspect * v + height / 2 + rng.uniform(0, step)
    x, y = np.rint(x).astype(int), np.rint(y).astype(int)
    inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
    seen = np.zeros(shape, bool)
    seen[y[inside], x[inside]] = True
    return seen


def degrade_depth(rng, depth, holes=True, noise=True):
    """Returns `depth` as a depth sensor might have measured it: float32 metres, 0 without a measurement. `depth` is
    unchanged.

    rng: a numpy Generator, or a seed for one. Noise: a deviation of 0.05 to 0.5 % of a metre at 1 m, growing with the
    square of depth, smooth over a few pixels; then rounding to steps that grow likewise (of disparity) or of a
    millimetre. Holes, each kind on some pictures only: the lattice of a coarser sensor projected into the camera,
    borders without overlap, patches (gloss, black), depth edges, and depths beyond the sensor's range."""
    rng, made = _rng(rng), np.array(depth, np.float32)
    shape = made.shape
    edges = depth_edges(made)
    if noise and rng.random() < 0.8:
        per_metre = 10 ** rng.uniform(-3.3, -2.3)
        grain = rng.standard_normal(shape, dtype=np.float32)
        if rng.random() < 0.6:
            soft = _smooth(grain, 1)
            grain = 0.5 * grain + 0.5 * soft / max(float(soft.std()), 1e-6)
        made += np.float32(per_metre) * made * made * grain
        if rng.random() < 0.5:  # disparity in fractions of a pixel: f x baseline of 20 to 80 pixel metres, eighths
            scale = np.float32(8 * rng.uniform(20, 80))
            made = scale / np.maximum(np.rint(scale / np.maximum(made, np.float32(0.01))), 1)
        made = np.rint(np.maximum(made, 0.001) * 1000) / np.float32(1000)
    if holes:
        height, width = shape
        gone = np.zeros(shape, bool)
        if rng.random() < 0.4:
            gone |= ~depth_lattice(rng, shape)
        if rng.random() < 0.35:
            sides = rng.integers(0, np.maximum(np.array([height, height, width, width]) // 6, 1) + 1)
            sides = sides * (rng.random(4) < 0.6)
            gone[: sides[0]] = gone[height - sides[1] :] = True
            gone[:, : sides[2]] = gone[:, width - sides[3] :] = True
        if rng.random() < 0.5:
            gone |= _blobs(rng, shape, rng.uniform(0.01, 0.3))
        if rng.random() < 0.5:
            reach = int(rng.integers(0, 3))
            wide = edges
            for _ in range(reach):
                grown = wide.copy()
                grown[1:] |= wide[:-1]
                grown[:-1] |= wide[1:]
                grown[:, 1:] |= wide[:, :-1]
                grown[:, :-1] |= wide[:, 1:]
                wide = grown
            gone |= wide & (rng.random(shape) < rng.uniform(0.5, 1.0))
        if rng.random() < 0.2:
            gone |= made > np.quantile(made, rng.uniform(0.7, 0.99))
        if rng.random() < 0.2:
            gone |= rng.random(shape) < rng.uniform(0.0, 0.1)
        if gone.mean() < 0.95:  # a frame without depth is useless for training
            made[gone] = 0
    return made.astype(np.float32, copy=False)


def expose(rng, image):
    """Returns the picture at another exposure: gain within 0.7 stops, white balance within a few per cent, a slight
    change of contrast; computed in linear light. uint8 to uint8, `image` is not changed."""
    rng = _rng(rng)
    gain = 2 ** float(np.clip(0.3 * rng.standard_normal(), -0.7, 0.7))
    gains, gamma = gain * (1 + 0.03 * rng.standard_normal(3)), 2 ** (0.06 * rng.standard_normal())
    levels = np.arange(256) / 255
    linear = np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)
    made = np.empty_like(image)
    for c in range(3):
        x = np.clip(linear * gains[c], 0, 1) ** gamma
        curve = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
        made[..., c] = np.rint(255 * curve).astype(np.uint8)[image[..., c]]
    return made


def _depth_picture(depth):
    """Returns a picture of depth: near is light, 0 is dark blue."""
    seen = depth > 0
    near = np.where(seen, 1 / np.maximum(depth, 1e-6), 0)
    grey = (255 * near / max(float(near.max()), 1e-9)).astype(np.uint8)
    return np.where(seen[..., None], grey[..., None], np.array([0, 0, 80], np.uint8)).astype(np.uint8)


def contact_sheet(seed, rooms=False, size=256, columns=6, rows=4):
    """Returns a contact sheet. Leaves: one picture per cell. Rooms: rows of three views, the middle one's depth,
    that depth degraded, and the middle view at another exposure."""
    source, rng, cells = Procedural(seed), np.random.default_rng(seed), []
    while len(cells) < rows * columns:
        if rooms:
            views = source.room(size, size, 3)
            depth = views[1]["depth"]
            cells += [v["image"] for v in views] + [_depth_picture(depth)]
            cells += [_depth_picture(degrade_depth(rng, depth)), expose(rng, views[1]["image"])]
        else:
            cells.append(source.leaves(size, size)[0])
    return np.vstack([np.hstack(cells[i : i + columns]) for i in range(0, rows * columns, columns)])


def write_png(path, image):
    """Writes uint8 [height, width, 3] RGB as a PNG, without a library."""
    height, width, _ = image.shape
    rows = np.hstack((np.zeros((height, 1), np.uint8), image.reshape(height, width * 3))).tobytes()

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b"")
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + b"".join(chunks))


def main():
    parser = argparse.ArgumentParser(description="Draw a contact sheet of the made-up training pictures.")
    parser.add_argument("--out", required=True, metavar="SHEET.png", help="the PNG to write")
    parser.add_argument("--seed", type=int, default=1, help="another seed, other pictures (default 1)")
    parser.add_argument("--rooms", action="store_true", help="three views, depth, worse depth, other exposure")
    options = parser.parse_args()
    write_png(options.out, contact_sheet(options.seed, options.rooms))


if __name__ == "__main__":
    main()
