#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scores of a head in float, on single pictures.

    tools/study/train/validate.py small.safetensors IMAGE...
    tools/study/train/validate.py small.safetensors --keep 10,5 --refine 0,2,4 IMAGE...

Like `trim3r eval --planar --size 256x256`, for comparison with its integers: each picture as one view on a
plane, pruned by the runtime, then adapted, refined and drawn in float32. PSNR in dB over all pixels, means over the
pictures."""
import argparse
import sys

import needs  # noqa: F401

import cv2
import numpy as np
import torch

import head_net
import objective
import samples
import splatting

SIDE = 256


def picture_of(path):
    image = cv2.imread(path, cv2.IMREAD_COLOR)
    if image is None:
        sys.exit(f"validate: {path} cannot be read as an image")
    image = samples.square(image[:, :, ::-1])[0]
    return cv2.resize(np.ascontiguousarray(image), (SIDE, SIDE), interpolation=cv2.INTER_AREA)


def planar_psnr(head, picture, kept, passes):
    """Returns [len(passes)] dB of one picture [SIDE, SIDE, 3] with a share `kept` of its pixels, after each number
    of passes."""
    depth = np.full((SIDE, SIDE), samples.PLANE, np.uint16)
    camera = (SIDE, SIDE, (SIDE - 1) / 2, (SIDE - 1) / 2)
    batch = objective.Batch([samples.prepare(picture, depth, camera, kept)], "cpu")
    splats = splatting.planar_splats(*batch.footprints(head, "cpu"), batch.pixel)
    order = np.arange(len(splats), dtype=np.int32)
    seen = []
    for count in passes:
        refined = splatting.refine(splats, batch.start, order, batch.pictures, batch.counts, count)
        drawn = splatting.draw(refined, batch.start, order, SIDE, SIDE).clamp(0, 1)
        seen.append(objective.decibels(((drawn * 255).round() / 255 - batch.pictures).square().mean((1, 2, 3))))
    return seen


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("head", metavar="HEAD.safetensors")
    parser.add_argument("images", nargs="+", metavar="IMAGE")
    parser.add_argument("--keep", default="100,20,10,5", metavar="LIST", help="percent of the pixels (100,20,10,5)")
    parser.add_argument("--refine", default="0,2,4", metavar="LIST", help="passes of refinement (0,2,4)")
    options = parser.parse_args()
    passes = [int(p) for p in options.refine.split(",")]
    head, name = head_net.load_safetensors(options.head)
    pictures = [picture_of(path) for path in options.images]
    print(f"{name}, {len(pictures)} pictures, dB after {options.refine} passes")
    with torch.no_grad():
        for keep in options.keep.split(","):
            rows = [planar_psnr(head, p, float(keep) / 100, passes) for p in pictures]
            print(f"{keep:>4} %", *(f"{v:.2f}" for v in np.mean(rows, 0)), flush=True)


if __name__ == "__main__":
    main()
