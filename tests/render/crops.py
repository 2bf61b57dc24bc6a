#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""crops.py TRIM3R: a part of a picture is drawn like the same pixels of the whole picture, wherever the optical axis is."""
import json
import sys

try:
    import cv2
    import numpy
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

from program import check, expect, in_scratch, room, write  # noqa: E402

WIDTH, HEIGHT, FOCAL = 320, 256, 320
WHOLE = (0, 0, WIDTH, HEIGHT)
CORNERS = ((0, 0, 64, 64), (256, 0, 64, 64), (0, 192, 64, 64), (256, 192, 64, 64), (160, 128, 160, 128), (304, 240, 16, 16))
INSIDE = ((16, 24, 64, 64), (200, 160, 100, 80), (130, 100, 64, 64))  # left, top, width, height
LEAST = 60  # dB


def drawn(scene, left, top, width, height):
    """Returns the pixels of a part of the whole picture."""
    write("part.json", json.dumps({"fl_x": FOCAL, "cx": WIDTH / 2 - left, "cy": HEIGHT / 2 - top, "w": width, "h": height,
                                   "transform_matrix": numpy.diag([1, -1, -1, 1]).tolist()}))
    expect(0, "render", scene, "--pose", "part.json", "-o", "part.png")
    return cv2.imread("part.png").astype(int)


def crops():
    expect(0, "build", room(), "--keep", "10%", "--rim", "off", "-o", "plain.ply")
    with open("plain.ply", "rb") as file:
        write("mip.ply", file.read().replace(b"end_header", b"comment SplatRenderMode: mip\nend_header", 1))
    for scene in ("plain.ply", "mip.ply"):
        whole = drawn(scene, *WHOLE)
        for part in (*CORNERS, *INSIDE):
            left, top, width, height = part
            wanted = whole[top:top + height, left:left + width]
            check(wanted.std() > 1, f"{scene}: {part} has one colour")
            error = ((drawn(scene, *part) - wanted) ** 2).mean()
            db = 10 * numpy.log10(255 ** 2 / error) if error else numpy.inf
            check(db >= (LEAST if part in INSIDE else numpy.inf), f"{scene}: {part} is at {db:.1f} dB")


in_scratch(crops)
