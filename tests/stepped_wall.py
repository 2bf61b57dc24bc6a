# SPDX-License-Identifier: Apache-2.0
"""Frames of a smooth wall with a step, for tests of poses and exposure that views disagree about."""
import json
import math
import os


def stepped_wall(made, axis, degrees, exposure=0.0, seed=3, levels=(0, 255)):
    """Writes a frame for each of the angles into the new folder `made`: true cameras lie 0.1 m apart along x, and the recorded
    pose of each is turned by its angle about `axis`, 0 = x. Each picture is brighter than the one before by `exposure`."""
    import cv2
    import numpy

    os.mkdir(made)
    random = numpy.random.default_rng(seed)
    wall = cv2.GaussianBlur(random.integers(0, 255, (500, 500, 3), dtype=numpy.uint8), (0, 0), 5)
    wall = cv2.normalize(wall, None, *levels, cv2.NORM_MINMAX)
    v, u = numpy.mgrid[0:64, 0:96].astype(numpy.float32)
    depth = numpy.where(v < 32, 2, 1.5)
    frames = []
    for i, angle in enumerate(degrees):
        x, y = (u - 47.5) / 90 * depth + 0.1 * i, (v - 31.5) / 90 * depth
        shown = cv2.remap(wall, (200 + 100 * x).astype(numpy.float32), (200 + 100 * y).astype(numpy.float32), cv2.INTER_CUBIC)
        cv2.imwrite(f"{made}/{i}.png", numpy.clip(shown * (1 + exposure) ** i + 0.5, 0, 255).astype(numpy.uint8))
        cv2.imwrite(f"{made}/{i}.depth.png", (1000 * depth).astype(numpy.uint16))
        turn = numpy.zeros(3)
        turn[axis] = math.radians(angle)
        pose = numpy.diag([1.0, -1, -1, 1])
        pose[:3, :3] = cv2.Rodrigues(turn)[0] @ pose[:3, :3]
        pose[0, 3] = 0.1 * i
        frames.append({"file_path": f"{i}.png", "depth_path": f"{i}.depth.png", "transform_matrix": pose.tolist()})
    with open(f"{made}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"fl_x": 90, "fl_y": 90, "cx": 48, "cy": 32, "w": 96, "h": 64, "integer_depth_scale": 0.001,
                   "frames": frames}, file)
