#!/usr/bin/env python3
"""Endless made-up pictures with depth, and posed views of made-up rooms: training data that anyone can make again.

    tools/train/procedural.py --out sheet.png [--seed N] [--rooms]

draws a contact sheet. For training:

    source = Procedural(seed)
    image, depth = source.leaves(256, 256)      # uint8 [h, w, 3] RGB, float32 [h, w] metres along the axis
    views = source.room(256, 256, views=3)      # [{"image", "depth", "intrinsics", "pose"}], along a hand-held path
    depth = degrade_depth(rng, depth)           # rng: numpy.random.Generator; 0 = nothing measured
    image = expose(rng, image)

The pictures come from C (procedural.h tells how), compiled when first asked for into $TRIM3R_BUILD, else into
~/.cache/trim3r. The same seed gives the same pictures, on other machines up to what libm rounds otherwise."""
import argparse
import ctypes
import hashlib
import os
import subprocess
import sys
import tempfile

import numpy as np

SOURCES = ("procedural_material.c", "procedural_camera.c", "procedural_leaves.c", "procedural_room.c")
HEADERS = ("procedural.h",)
# No contraction and no fast-math: -march=native must not change what is drawn
FLAGS = ("-std=gnu11", "-O3", "-march=native", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-shared", "-fPIC")

_loaded = {}


def build(folder=None):
    """The compiled generator's path in `folder`; compiled only where sources, flags or machine changed."""
    here = os.path.dirname(os.path.abspath(__file__))
    folder = folder or os.environ.get("TRIM3R_BUILD") or os.path.expanduser("~/.cache/trim3r")
    compiler = os.environ.get("CC", "cc")
    digest = hashlib.sha256(" ".join((compiler, os.uname().nodename) + FLAGS).encode())
    for name in SOURCES + HEADERS:
        with open(os.path.join(here, name), "rb") as file:
            digest.update(file.read())
    library = os.path.join(folder, f"procedural-{digest.hexdigest()[:16]}.so")
    if not os.path.exists(library):
        os.makedirs(folder, exist_ok=True)
        handle, fresh = tempfile.mkstemp(suffix=".so", dir=folder)  # several trainers may build at once
        os.close(handle)
        try:
            subprocess.run([compiler, *FLAGS, "-o", fresh, *(os.path.join(here, s) for s in SOURCES), "-lm"], check=True)
            os.replace(fresh, library)
        finally:
            if os.path.exists(fresh):
                os.unlink(fresh)
    return library


def _library(folder):
    path = build(folder)
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
    """64 bits from integers, the same everywhere."""
    state = 0
    for part in parts:
        state = (state ^ (part & 0xFFFFFFFFFFFFFFFF)) * 0x9E3779B97F4A7C15 & 0xFFFFFFFFFFFFFFFF
        state ^= state >> 32
        state = state * 0xD6E8FEB86659FD93 & 0xFFFFFFFFFFFFFFFF
        state ^= state >> 29
    return state


class Procedural:
    """A stream of pictures. `index` counts what was drawn: set it to go on where a stream stopped."""

    def __init__(self, seed, index=0, build_folder=None):
        self.seed, self.index = seed, index
        self._call, self._atlas = _library(build_folder)

    def _next(self, kind):
        self.index += 1
        return _mix(self.seed, kind, self.index - 1)

    def leaves(self, width, height):
        """(uint8 [height, width, 3] RGB, float32 [height, width] metres along the axis, > 0 everywhere)"""
        image, depth = np.empty((height, width, 3), np.uint8), np.empty((height, width), np.float32)
        status = self._call.procedural_leaves(
            self._atlas, self._next(1), width, height, image.ctypes.data, depth.ctypes.data
        )
        if status:
            raise ValueError(f"procedural: no picture of {width} x {height}: sides are 16 to 2048")
        return image, depth

    def room(self, width, height, views=3):
        """`views` (1 to 16) of one room along a hand-held path: with three, the middle one lies between the others.

        A list of dictionaries: image uint8 [height, width, 3] RGB; depth float32 [height, width] metres along the axis;
        intrinsics float32 [4] fx fy cx cy, pixels; pose float32 [4, 4] camera-to-world, axes x right, y down,
        z forward, metres. Pixel (0, 0) is the centre of the top-left pixel. All views share one exposure."""
        images, depths = np.empty((views, height, width, 3), np.uint8), np.empty((views, height, width), np.float32)
        intrinsics, poses = np.empty((views, 4), np.float32), np.empty((views, 4, 4), np.float32)
        pointers = (a.ctypes.data for a in (images, depths, intrinsics, poses))
        if self._call.procedural_room(self._atlas, self._next(2), width, height, views, *pointers):
            raise ValueError(f"procedural: no room of {views} views, {width} x {height}: 1 to 16 views, sides 16 to 2048")
        return [
            {"image": images[i], "depth": depths[i], "intrinsics": intrinsics[i], "pose": poses[i]}
            for i in range(views)
        ]
