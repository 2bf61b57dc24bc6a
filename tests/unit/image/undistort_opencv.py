#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""undistort_opencv.py DRIVER: compares undistorted pictures with OpenCV's own maps and interpolation."""
import subprocess
import sys

try:
    import cv2
    import numpy as np
except ImportError as missing:
    print(f"SKIPPED: {missing}")
    sys.exit(77)

LENSES = [
    ("radial-tangential", 1, (640, 480), (520, 518, 321.3, 243.9), (0.12, -0.25, 0.001, -0.0015, 0.09)),
    ("barrel", 1, (256, 256), (190, 191, 127.2, 128.1), (-0.28, 0.09, 0.0004, 0.0002, -0.012)),
    ("fisheye", 2, (256, 256), (140, 139, 128.4, 126.8), (-0.02, 0.008, -0.004, 0.0006, 0)),
    ("wide fisheye", 2, (320, 240), (110, 111, 160, 119), (0.03, -0.01, 0.002, -0.0003, 0)),
]


def picture(width, height):
    y, x = np.mgrid[0:height, 0:width]
    waves = [127 + 60 * np.sin(x / 6 + c) * np.cos(y / 7 - c) + 40 * np.sin((x + y) / 23) for c in range(3)]
    return np.stack(waves, -1).astype(np.uint8)


def main():
    for name, kind, (width, height), (fx, fy, cx, cy), k in LENSES:
        image = picture(width, height)
        intrinsics = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]], np.float64)
        if kind == 2:
            maps = cv2.fisheye.initUndistortRectifyMap(intrinsics, np.array(k[:4]), np.eye(3), intrinsics,
                                                       (width, height), cv2.CV_32FC1)
        else:
            maps = cv2.initUndistortRectifyMap(intrinsics, np.array(k), np.eye(3), intrinsics, (width, height),
                                               cv2.CV_32FC1)
        expected = cv2.remap(image, *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        arguments = [sys.argv[1], *map(str, (width, height, kind, fx, fy, cx, cy, *k))]
        planes = np.ascontiguousarray(image.transpose(2, 0, 1)).tobytes()
        out = subprocess.run(arguments, input=planes, stdout=subprocess.PIPE, check=True).stdout
        got = np.frombuffer(out, np.uint8).reshape(3, height, width).transpose(1, 2, 0)
        inside = (maps[0] > 0) & (maps[1] > 0) & (maps[0] < width - 1) & (maps[1] < height - 1)
        difference = np.abs(got.astype(int) - expected)[inside]
        print(f"{name}: mean {difference.mean():.3f}, most {difference.max()} of 255 on {100 * inside.mean():.0f} %")
        if not (difference.mean() < 0.5 and difference.max() <= 4 and inside.mean() > 0.3):
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
