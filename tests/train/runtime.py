#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The training's float copies against the runtime: footprints of given outputs; a picture drawn by the shipped head,
plain and after each pass of refinement.

    runtime.py TRAIN_FOLDER BUILD_FOLDER"""
import ctypes
import glob
import os
import sys
import unittest

try:
    import numpy as np
    import torch
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

TRAIN, BUILD = map(os.path.abspath, sys.argv[1:3])
os.environ["TRIM3R_BUILD"] = BUILD
sys.path.insert(0, TRAIN)
try:
    import samples  # noqa: E402
except ImportError as error:  # OpenCV
    print(f"SKIPPED: {error}")
    sys.exit(77)
import head_net  # noqa: E402
import native  # noqa: E402
import splatting  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
HEADS = os.path.join(TRAIN, "..", "..", "..", "quant", "heads")
SCALES = np.array([2.0**14, 2.0**14, 2.0**13, 2.0**13, 2.0**14, 2.0**15, 2.0**13, 2.0**13, 2.0**13])
SIDE, KEPT, PICTURES, PASSES = 128, 0.1, 3, 4
APART_MOST = 0.05  # dB; measured 0.02


class _Settings(ctypes.Structure):
    _fields_ = [
        (name, ctypes.c_uint32)
        for name in ("gaussians", "allocate", "gamma_q8", "clusters", "batches", "seed", "refine")
    ]


def tie():
    inside = os.path.join(native.RUNTIME, "head", "head_learned.c")

    def all_of(*pattern):
        return sorted(glob.glob(os.path.join(native.RUNTIME, *pattern), recursive=True))

    sources = [s for s in all_of("**", "*.c") if s != inside]
    sources += [os.path.join(HERE, "runtime_tie.c"), os.path.join(HEADS, "small.c")]
    headers = all_of("**", "*.h")
    includes = (native.RUNTIME, os.path.join(native.RUNTIME, "include"), HEADS)
    flags = ("-std=c11", "-O2", *("-I" + folder for folder in includes))
    library = ctypes.CDLL(native.build("runtime_tie", sources, flags, [inside, *headers]))
    library.tie_draw.restype = ctypes.c_int32
    return library


def psnr(a, b):
    return -10 * np.log10(((a.astype(float) - b.astype(float)) ** 2).mean() / 255**2)


class Runtime(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.library = tie()

    def test_footprints(self):
        """Draws outputs over their whole range; spreads of at most 4 spacings, to which the training limits them."""
        rng, count = np.random.default_rng(1), 4000
        outputs = rng.integers(-32768, 32768, (count, 9)).astype(np.int16)
        outputs[:, 2:4] = rng.integers(-4 * 8192, 2 * 8192 + 1, (count, 2))
        spacing = np.exp2(rng.uniform(0, 4, count) * (rng.random(count) < 0.9))
        spacing_q12 = np.round(spacing * 4096).astype(np.uint32)
        own = rng.integers(0, 256, (3, count)).astype(np.uint8)
        made = np.empty((count, 9), np.int32)
        self.library.tie_footprints(
            ctypes.c_uint32(count), ctypes.c_void_p(outputs.ctypes.data), ctypes.c_void_p(spacing_q12.ctypes.data),
            ctypes.c_void_p(own.ctypes.data), ctypes.c_void_p(made.ctypes.data),
        )  # fmt: skip
        offset, factor, opacity, colour = (
            t.numpy().astype(float)
            for t in splatting.footprints(
                torch.from_numpy(outputs / SCALES).float(),
                torch.from_numpy(spacing_q12 / 4096).float(),
                torch.from_numpy(own.T / 255).float(),
            )
        )
        l11, l21, l22 = np.maximum(factor[:, 0], 580 / 4096), factor[:, 1], np.maximum(factor[:, 2], 580 / 4096)
        covariance = np.stack((l11 * l11, l11 * l21, l21 * l21 + l22 * l22), 1)
        size = np.maximum(l11, np.hypot(l21, l22))[:, None]
        self.assertLess(np.abs(made[:, 0:2] / 4096 - offset).max(), 1e-3)
        # a step of the factor and of the covariance is 2^-12, and the error of 2^x is at most 2^-14
        self.assertLess((np.abs(made[:, 2:5] / 4096 - covariance) / (size * size + 4 * size)).max(), 3e-4)
        shown = outputs[:, 5] > 328  # the training keeps opacity above 0.01, the runtime above 0
        self.assertLess(np.abs(made[shown, 5] / 32768 - opacity[shown]).max(), 2e-4)
        self.assertLess(made[~shown, 5].max() / 32768, 0.0101)
        self.assertLess(np.abs(made[:, 6:] / (255 * 128) - colour).max(), 1e-5)

    def runtime_draws(self, image, camera, gaussians, refine):
        settings = _Settings(gaussians, samples.ALLOCATIONS["density"], round(0.7 * 256), 300, 4, 1, refine)
        drawn, camera = np.empty_like(image), np.asarray(camera, np.float64)
        status = self.library.tie_draw(
            ctypes.c_uint32(SIDE), ctypes.c_uint32(SIDE), ctypes.c_void_p(image.ctypes.data),
            ctypes.c_void_p(camera.ctypes.data), ctypes.byref(settings), ctypes.c_void_p(drawn.ctypes.data),
        )  # fmt: skip
        self.assertEqual(status, 0)
        return drawn

    def test_pictures(self):
        """The same picture on a plane, analysed by the runtime for both; from there float32 against integers, with
        the head rounded like the integers."""
        head, _ = head_net.load_safetensors(os.path.join(HEADS, "small.safetensors"))
        head.mode = "quantized"  # otherwise the integers' noise, up to 0.3 dB on smooth pictures, would dominate
        camera = (SIDE, SIDE, (SIDE - 1) / 2, (SIDE - 1) / 2)
        depth = np.full((SIDE, SIDE), samples.PLANE, np.uint16)
        counts = np.ones((1, SIDE, SIDE), np.uint8)
        source = samples.Procedural(7, build_folder=BUILD)
        for number in range(PICTURES):
            image = np.ascontiguousarray(source.leaves(SIDE, SIDE)[0])
            view = samples.prepare(image, depth, camera, KEPT)
            points = view.points
            features = torch.from_numpy(view.features).permute(2, 0, 1)[None].float() * head_net.FEATURE_STEP
            y, x = (torch.from_numpy(points[k].astype(np.int64)) for k in "yx")
            picture = torch.from_numpy(image).permute(2, 0, 1).float() / 255
            with torch.no_grad():
                outputs = head(features, (torch.zeros_like(y), y, x))
                spacing = torch.from_numpy(points["spacing"].copy())
                footprints = splatting.footprints(outputs, spacing, picture[:, y, x].T)
                pixels = torch.stack((x, y), 1).float()
                plain = splatting.planar_splats(*footprints, pixels)
                splats = splatting.planar_splats(*footprints, pixels, splatting.VARIANCE_LEAST_REFINED)
            start = np.array([0, len(splats)], np.int32)
            order = splatting.order_by(np.zeros(len(splats)), start)  # one depth: by index
            said, before = [], 0
            for passes in range(PASSES + 1):
                refined = splatting.refine(splats if passes > 0 else plain, start, order, picture[None], counts, passes)
                drawn = splatting.draw(refined, start, order, SIDE, SIDE)[0].permute(1, 2, 0).numpy()
                ours = psnr(np.round(drawn * 255).clip(0, 255), image)
                theirs = psnr(self.runtime_draws(image, camera, len(splats), passes), image)
                said.append(f"{ours:.2f} {theirs:.2f}")
                self.assertLess(abs(ours - theirs), APART_MOST, f"picture {number}, {passes} passes: {said}")
                self.assertGreater(theirs, before, "a pass that does not pay says nothing")
                before = theirs
            print(f"picture {number}, dB of the training and the runtime by passes: {', '.join(said)}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
