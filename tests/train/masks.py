#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The points on which a head is trained for a rival's choice equal those that `trim3r build --method RIVAL+head` keeps
of the same views.

masks.py TRAIN_FOLDER BUILD_FOLDER TRIM3R"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

try:
    import cv2
    import numpy as np
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

TRAIN, BUILD, TRIM3R = map(os.path.abspath, sys.argv[1:4])
os.environ["TRIM3R_BUILD"] = BUILD
sys.dont_write_bytecode = True
sys.path.insert(0, TRAIN)
import samples  # noqa: E402

SIDE, KEPT = 64, 10  # pixels, percent
RIVALS = samples.MASKS[1:]


def posed(views, depth_unit=0.001):
    """Rounds the views of a synthetic room as a recording does: depth in whole millimetres, lenses in 16ths of a
    pixel."""
    for view in views:
        lens = np.round(view["intrinsics"].astype(np.float64) * 16) / 16
        depth = np.rint(view["depth"] / depth_unit).astype(np.uint16)
        yield view["image"], depth, lens, view["pose"].astype(np.float64)


def record(folder, views):
    frames = []
    for number, (image, depth, lens, pose) in enumerate(views):
        cv2.imwrite(f"{folder}/{number}.png", image[:, :, ::-1])
        cv2.imwrite(f"{folder}/{number}.depth.png", depth)
        frames.append({"file_path": f"{number}.png", "depth_path": f"{number}.depth.png", "w": SIDE, "h": SIDE,
                       "fl_x": lens[0], "fl_y": lens[1], "cx": lens[2] + 0.5, "cy": lens[3] + 0.5,
                       "transform_matrix": (pose @ np.diag([1.0, -1.0, -1.0, 1.0])).tolist()})  # fmt: skip
    with open(f"{folder}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"integer_depth_scale": 0.001, "frames": frames}, file)
    subprocess.run([TRIM3R, "import", folder, "-o", f"{folder}/rec.mcap"], check=True, stdout=subprocess.DEVNULL)
    return f"{folder}/rec.mcap"


def scene(recording, *options):
    """Returns the bytes of a build whose head ignores the mask, so that they depend only on its points."""
    path = recording + ".ply"
    command = [TRIM3R, "build", recording, "--head", "none", "--exposure", "off", *options, "-o", path]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(path, "rb") as file:
        return file.read().split(b"end_header\n", 1)[1]


class Masks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        room = samples.Procedural(5, build_folder=BUILD).room(SIDE, SIDE, 2)
        cls.views = list(posed(room))
        cls.recording = record(cls.folder.name, cls.views)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def scene_of(self, masks):
        names = [f"{self.folder.name}/mask{v}.png" for v in range(len(masks))]
        for name, mask in zip(names, masks):
            cv2.imwrite(name, mask.astype(np.uint16) * 65535)
        return scene(self.recording, "--gaussians", str(int(masks.sum())), "--allocate", "given", "--importance",
                     ",".join(names))  # fmt: skip

    def prepared(self, mask):
        return samples.prepare_views(*zip(*self.views), KEPT / 100, mask=mask)

    def test_samples_are_the_points_that_the_program_keeps(self):
        earlier = []
        for rival in RIVALS:
            masks = np.zeros((2, SIDE, SIDE), bool)
            for mask, view in zip(masks, self.prepared(rival)):
                mask[view.points["y"].astype(int), view.points["x"].astype(int)] = True
                self.assertTrue(np.array_equal(view.features[:, :, 3], np.where(mask, 127, 0)), f"{rival}: the feature")
            self.assertEqual(masks.sum(), round(2 * SIDE * SIDE * KEPT / 100), rival)
            theirs = scene(self.recording, "--keep", f"{KEPT}%", "--method", f"{rival}+head", "--mask-head", "small")
            self.assertEqual(self.scene_of(masks), theirs, f"{rival}: the points")
            self.assertTrue(all((masks & other).sum() < 0.9 * masks.sum() for other in earlier), f"{rival}: its own")
            earlier.append(masks)

    def test_draws_of_a_run_are_of_the_mask(self):
        """All random draws agree: crops and context views have the points of the mask, and the same views prepared
        for another mask have others."""
        called, prepare_views = [], samples.prepare_views

        def noted(*arguments, **budget):
            made = prepare_views(*arguments, **budget)
            called.append((arguments, budget, made))
            return made

        samples.prepare_views = noted
        try:
            source = samples.Samples([], SIDE, 1.0, mask="eagles")
            for seed in range(3):
                source.crops(np.random.default_rng(seed), 2)
            before = len(called)
            for seed in range(4):
                self.assertEqual(len(source.crops(np.random.default_rng(seed), 1)), 1)
            single = [len(arguments[0]) for arguments, _, _ in called[before:]]
            self.assertEqual(set(single), {1, 2}, "a picture at a time, too")
            source.triplet(np.random.default_rng(7))
        finally:
            samples.prepare_views = prepare_views
        together = [len(arguments[0]) for arguments, _, _ in called]
        self.assertTrue({1, 2} == set(together) and together[-1] == 2, f"alone, and ranked together: {together}")
        for arguments, budget, made in called:
            self.assertEqual(budget["mask"], "eagles")
            others = prepare_views(*arguments, **{**budget, "mask": "random"})
            self.assertEqual(*(sum(len(view.points) for view in views) for views in (made, others)))
            self.assertFalse(all(np.array_equal(a.points, b.points) for a, b in zip(made, others)))

    def test_points_are_in_their_own_camera(self):
        for (_, depth, lens, _), view in zip(self.views, self.prepared("random")):
            x, y = (view.points[k].astype(int) for k in "xy")
            z = depth[y, x] / 1000
            at = np.stack(((x - lens[2]) / lens[0] * z, (y - lens[3]) / lens[1] * z, z), 1)
            self.assertLess(np.abs(view.points["position"] - at).max(), 1e-3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
