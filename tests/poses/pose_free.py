#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""pose_free.py SCRIPTS: where tools/study/scripts/cameras.py puts the target's camera among estimated ones."""
import os
import sys

sys.path[:0] = [os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."), sys.argv[1]]
from checks import check, done, skip

try:
    import cv2  # of cameras
    import numpy as np
except ImportError as missing:
    skip(str(missing))
import cameras


def camera(random):
    out = np.eye(4)
    out[:3, :3] = cameras.nearest_rotation(random.standard_normal((3, 3)))
    out[:3, 3] = 5 * random.standard_normal(3)
    return out


def moved(similarity, scale, pose):
    out = similarity @ pose
    out[:3, :3] /= scale
    return out


def placed(given, estimated, metric=False):
    return cameras.laid_over(given[:2], estimated[:2], metric)


def alike(what, found, expected):
    check(np.allclose(found, expected, atol=1e-9), f"{what}:\n{found}\nis not\n{expected}")


random = np.random.default_rng(1)
for _ in range(100):
    given, frame, scale = [camera(random) for _ in range(3)], camera(random), random.uniform(0.1, 10)
    similarity = frame.copy()
    similarity[:3, :3] *= scale
    estimated = [moved(similarity, scale, pose) for pose in given]
    alike("an exact estimate, scaled", placed(given, estimated), similarity)
    exact = [frame @ pose for pose in given]
    alike("an exact estimate with lengths", placed(given, exact, metric=True), frame)
    # one camera's error of rotation is halved, that of the distance is shared by both ends
    turn = cv2.Rodrigues(np.array([0.0, 0.1, 0.0]))[0]
    half = cv2.Rodrigues(np.array([0.0, 0.05, 0.0]))[0]
    off = [given[0], given[1].copy()]
    off[1][:3, :3] = turn @ off[1][:3, :3]
    alike("half of a turn", placed(given, off)[:3, :3], half)
    far = [given[0], given[1].copy()]
    far[1][:3, 3] += far[1][:3, 3] - far[0][:3, 3]
    ends = [placed(given, far, metric=True) @ pose for pose in given[:2]]
    alike("ends", ends[0][:3, 3] - far[0][:3, 3], far[1][:3, 3] - ends[1][:3, 3])
same = np.full((2, 2, 3), 9)
check(cameras.psnr(same, same, np.ones((2, 2), bool)) > 99, "nothing off")
half_seen = np.array([[True, False]])
found = cameras.psnr(np.zeros((1, 2, 3)), np.array([[[255.0] * 3, [9.0] * 3]]), half_seen)
alike("what the mask leaves out does not count", found, 0)
done()
