#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""against_scorer.py SCORE_PICTURES SCORE.PY: psnr, ssim and sharp of random picture pairs, with masks and without,
against the independent scorer: 0.02 dB, 0.001."""
import json
import sys
import tempfile

from checks import check, done, near, run, skip
from common import load_scorer, need_numpy

numpy, cv2 = need_numpy()
scorer = load_scorer(sys.argv[2])
if scorer is None:
    skip(f"no scorer at {sys.argv[2]}")
random = numpy.random.default_rng(5)


def pair(kind, height, width):
    noise = random.integers(0, 256, (height, width, 3)).astype(numpy.uint8)
    if kind == "noise":
        return noise, random.integers(0, 256, (height, width, 3)).astype(numpy.uint8)
    smooth = cv2.GaussianBlur(noise, (0, 0), 2.5)
    smooth = cv2.normalize(smooth, None, 0, 255, cv2.NORM_MINMAX)
    if kind == "equal":
        return smooth, smooth.copy()
    if kind == "dark":
        return smooth, numpy.zeros_like(smooth)
    error = random.normal(0, 6, smooth.shape)
    return smooth, numpy.clip(cv2.GaussianBlur(smooth, (0, 0), 1.2) + error, 0, 255).astype(numpy.uint8)


with tempfile.TemporaryDirectory() as folder:
    names = [f"{folder}/{name}.png" for name in ("target", "render", "mask")]
    for height, width in ((64, 64), (37, 91), (12, 11), (5, 7), (2, 3)):
        for kind in ("noise", "blurred", "equal", "dark"):
            for masked in (False, True):
                target, render = pair(kind, height, width)
                mask = (random.random((height, width)) < 0.6) | (numpy.indices((height, width)).sum(0) == 0)
                cv2.imwrite(names[0], target)
                cv2.imwrite(names[1], render)
                cv2.imwrite(names[2], numpy.where(mask, 255, 0).astype(numpy.uint8))
                ours = json.loads(run(sys.argv[1], *names[:3 if masked else 2]).stdout)
                theirs = scorer.score(target.astype(float), render.astype(float), mask if masked else mask | True)
                what = f"{kind} {width}x{height}{' masked' if masked else ''}"
                near(ours["psnr"], theirs["psnr"], 0.02, f"psnr, {what}")
                near(ours["ssim"], theirs["ssim"], 0.001, f"ssim, {what}")
                near(ours["sharp"], theirs["sharp"], 0.001, f"sharp, {what}")
                check(0 <= ours["flip"] <= 1, f"flip, {what}: {ours['flip']}")
done()
