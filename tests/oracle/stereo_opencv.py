#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stereo_opencv.py DRIVER DATA [--time]: compares matching with OpenCV's StereoSGBM on Middlebury's teddy, by the share
of pixels seen by both views that are off by more than two: as captured, with one picture half as bright, and with
noise. With --time, for a release build on an idle machine, also the ratio of processor times: its median over the
rounds is held to a limit, and its spread is printed.

OpenCV matches with all eight paths and 64 disparities, at its best block size in each case. Its picture is extended by
64 columns to the left, so that it has the same candidates. A pixel without a disparity counts as off."""
import subprocess
import sys
import time
from pathlib import Path

try:
    import cv2
    import numpy as np
except ImportError as missing:
    print(f"SKIPPED: {missing}")
    sys.exit(77)

DISPARITIES = 64
BLOCKS = (1, 3, 5, 7, 9)
# Limit of the ratio to OpenCV's processor time with the same number of paths, without filling, which OpenCV lacks.
# Because other programs disturb both, each round takes the fastest of RUNS runs of one, then of RUNS of the other.
TIMES, ROUNDS, RUNS, SIDE = 1.5, 11, 5, 256


def luma(path):
    b, g, r = np.moveaxis(cv2.imread(str(path)).astype(int), -1, 0)
    return ((77 * r + 150 * g + 29 * b + 128) >> 8).astype(np.uint8)


def truth(scene, name):
    """Returns disparities: focal length 450 pixels, baseline 0.4, depth in millimetres."""
    depth = cv2.imread(str(scene / "depth" / name), cv2.IMREAD_UNCHANGED) * 0.001
    return np.where(depth > 0, 450 * 0.4 / np.maximum(depth, 1e-9), -1)


def planes(left, right):
    """Returns planes for the driver; 0 marks pixels without content, so values start at 1."""
    outside = np.zeros((len(left), DISPARITIES - 1), np.uint8)
    return np.maximum(left, 1), np.concatenate([outside, np.maximum(right, 1)], 1)


def drive(driver, mode, paths, left, right, *more):
    height, width = left.shape
    arguments = [driver, mode, *map(str, (width, height, DISPARITIES, paths, *more))]
    data = np.ascontiguousarray(left).tobytes() + np.ascontiguousarray(right).tobytes()
    return subprocess.run(arguments, input=data, stdout=subprocess.PIPE, check=True).stdout


def ours(driver, paths, left, right):
    first, second = planes(left, right)
    found = drive(driver, "match", paths, first, second)
    disparity = np.frombuffer(found[:2 * left.size], np.uint16).reshape(left.shape)
    return np.where(disparity == 65535, -1, disparity / 128)


def matcher(block, mode, **more):
    return cv2.StereoSGBM_create(0, DISPARITIES, block, 8 * block**2, 32 * block**2, mode=mode, preFilterCap=63, **more)


def opencv(block, left, right):
    outside = np.zeros((len(left), DISPARITIES), np.uint8)
    wide = [np.concatenate([outside, picture], 1) for picture in (left, right)]
    return matcher(block, cv2.STEREO_SGBM_MODE_HH).compute(*wide)[:, DISPARITIES:] / 16


def seen_twice(first, second):
    """Returns the first view's pixels with a true disparity whose match in the second view has the same one."""
    x = np.arange(first.shape[1])[None]
    there = np.round(x - first).astype(int)
    inside = (first > 0) & (there >= 0)
    other = np.take_along_axis(second, np.where(inside, there, 0), 1)
    return inside & (np.abs(other - first) <= 1)


def cases(left, right):
    yield "as taken", left, right
    yield "second half as bright", left, right // 2
    yield "first half as bright", left // 2, right
    for sigma in (3, 6):
        random = np.random.RandomState(sigma)
        noisy = [np.clip(np.round(p + random.randn(*p.shape) * sigma), 0, 255).astype(np.uint8) for p in (left, right)]
        yield f"noise of {sigma} levels", *noisy


def accuracy(driver, scene):
    left, right = luma(scene / "images/im2.png"), luma(scene / "images/im6.png")
    expected = truth(scene, "im2.png")
    judged = seen_twice(expected, truth(scene, "im6.png"))
    failed = 0
    for name, first, second in cases(left, right):
        off = lambda d: 100 * ((np.abs(d - expected) > 2) | (d < 0))[judged].mean()
        theirs = min((off(opencv(block, first, second)), block) for block in BLOCKS)
        mine = [off(ours(driver, paths, first, second)) for paths in (4, 8)]
        print(f"{name}: {mine[0]:.2f} % off with 4 paths, {mine[1]:.2f} % with 8; OpenCV {theirs[0]:.2f} % (block {theirs[1]})")
        failed += max(mine) > theirs[0]
    return failed


def speed(driver, scene):
    left, right = (luma(scene / "images" / name)[50:50 + SIDE, 100:100 + SIDE] for name in ("im2.png", "im6.png"))
    cv2.setNumThreads(1)
    failed = 0
    for paths, mode in ((4, cv2.STEREO_SGBM_MODE_HH4), (8, cv2.STEREO_SGBM_MODE_HH)):
        # both check left against right and remove speckles
        other = matcher(3, mode, disp12MaxDiff=1, uniquenessRatio=10, speckleWindowSize=64, speckleRange=1)
        rounds = []
        for _ in range(ROUNDS):
            matched, filled = map(float, drive(driver, "bench", paths, *planes(left, right), RUNS).split())
            theirs = []
            for _ in range(RUNS):
                start = time.process_time()
                other.compute(left, right)
                theirs.append(1000 * (time.process_time() - start))
            rounds.append((matched, filled, min(theirs), matched / min(theirs)))
        matched, filled, theirs, ratio = np.median(rounds, 0)
        least, most = np.min(rounds, 0)[3], np.max(rounds, 0)[3]
        print(f"{paths} paths, {SIDE} x {SIDE}, {DISPARITIES} disparities: {matched:.1f} ms, with filling {filled:.1f} ms, "
              f"OpenCV {theirs:.1f} ms; ratio {ratio:.2f} ({least:.2f} to {most:.2f}), at most {TIMES}")
        failed += ratio > TIMES
    return failed


def main():
    driver, scene = sys.argv[1], Path(sys.argv[2]) / "middlebury_teddy"
    if not scene.is_dir():
        print(f"SKIPPED: no {scene}")
        return 77
    failed = accuracy(driver, scene)
    if len(sys.argv) > 3 and sys.argv[3] == "--time":
        failed += speed(driver, scene)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
