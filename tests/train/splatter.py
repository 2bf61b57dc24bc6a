#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The training's splatter against finite differences and against itself.

Usage: splatter.py TRAIN_FOLDER BUILD_FOLDER"""
import os
import sys
import unittest

try:
    import numpy as np
    import torch
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

TRAIN, BUILD = sys.argv[1:3]
os.environ["TRIM3R_BUILD"] = BUILD
sys.path.insert(0, TRAIN)
import native  # noqa: E402
import splatting  # noqa: E402

SIDE = 48


def splats_of(seed, count=60, opacity=0.9):
    rng = np.random.default_rng(seed)
    angle, a, b = rng.uniform(0, np.pi, count), rng.uniform(0.9, 6, count), rng.uniform(0.9, 3, count)
    xx, yy = (a * np.cos(angle)) ** 2 + (b * np.sin(angle)) ** 2, (a * np.sin(angle)) ** 2 + (b * np.cos(angle)) ** 2
    xy = (a * a - b * b) * np.cos(angle) * np.sin(angle)
    mean, colour = rng.uniform(0, SIDE, (count, 2)), rng.uniform(0, 1, (count, 3))
    columns = (mean, xx, xy, yy, rng.uniform(0.2, opacity, count), colour)
    return splatting.pack(*(torch.from_numpy(c).float() for c in columns))


def drawn_by_loops(splats, order):
    """Draws the picture by the definition, pixel by pixel, in float64."""
    y, x = np.mgrid[0:SIDE, 0:SIDE]
    left, colour = np.ones((SIDE, SIDE)), np.zeros((3, SIDE, SIDE))
    for n in order:
        mx, my, a, b, c, opacity, *rgb = (float(v) for v in splats[n])
        dx, dy = x - mx, y - my
        alpha = np.minimum(opacity * np.exp(-(a * dx * dx + c * dy * dy) / 2 - b * dx * dy), 0.99)
        alpha[(alpha < 1 / 255) | (left < 1e-4)] = 0
        colour += left * alpha * np.array(rgb)[:, None, None]
        left *= 1 - alpha
    return colour


class Splatter(unittest.TestCase):
    def setUp(self):
        splatting._library = None

    def order(self, splats, seed=0):
        start = np.array([0, len(splats)], np.int32)
        return start, splatting.order_by(np.random.default_rng(seed).random(len(splats)), start)

    def test_draws_what_the_definition_says(self):
        splats = splats_of(1)
        start, order = self.order(splats)
        drawn = splatting.draw(splats, start, order, SIDE, SIDE)[0].numpy()
        # a pixel at the cut of 1/255 may fall on either side in float32
        self.assertLess(np.abs(drawn - drawn_by_loops(splats, order)).max(), 1.5 / 255)
        self.assertLess(np.abs(drawn - drawn_by_loops(splats, order)).mean(), 1e-4)

    def test_derivatives_are_finite_differences(self):
        splatting._library = native.splatter("-DALPHA_LEAST=1e-7f")  # the cut moves with the splat: no derivative
        splats = splats_of(2)
        start, order = self.order(splats)
        rng = np.random.default_rng(3)
        weight = torch.from_numpy(rng.standard_normal((1, 3, SIDE, SIDE))).float()
        leaf = splats.clone().requires_grad_(True)
        (splatting.draw(leaf, start, order, SIDE, SIDE) * weight).sum().backward()
        for column in range(9):
            for _ in range(3):
                way = torch.zeros_like(splats)
                way[:, column] = torch.from_numpy(rng.standard_normal(len(splats))).float()
                way[:, column] *= 2e-3 * (splats[:, column].abs() if 2 <= column <= 4 else 1)
                ends = [
                    (splatting.draw(splats + s * way, start, order, SIDE, SIDE).double() * weight).sum()
                    for s in (1, -1)
                ]
                found, expected = float((leaf.grad * way).sum()), float(ends[0] - ends[1]) / 2
                size = float((leaf.grad * way).norm())
                self.assertLess(abs(found - expected), 0.02 * size + 1e-5, f"column {column}")

    def test_pictures_of_a_batch_do_not_mix(self):
        first, second = splats_of(4), splats_of(5, 40)
        start = np.array([0, 60, 100], np.int32)
        order = splatting.order_by(np.random.default_rng(0).random(100), start)
        both = splatting.draw(torch.cat((first, second)), start, order, SIDE, SIDE)
        alone = splatting.draw(second, np.array([0, 40], np.int32), order[60:], SIDE, SIDE)
        self.assertTrue(torch.equal(both[1:], alone))

    def test_refinement_finds_what_was_changed(self):
        wanted_splats = splats_of(6, 80)
        start, order = self.order(wanted_splats)
        wanted = splatting.draw(wanted_splats, start, order, SIDE, SIDE)
        rng = np.random.default_rng(7)
        moved = wanted_splats.clone()
        moved[:, :2] += torch.from_numpy(rng.normal(0, 0.3, (80, 2))).float()
        moved[:, 6:] = (moved[:, 6:] + torch.from_numpy(rng.normal(0, 0.1, (80, 3))).float()).clamp(0, 1)
        counts = np.ones((1, SIDE, SIDE), np.uint8)

        def error(splats):
            return float(((splatting.draw(splats, start, order, SIDE, SIDE) - wanted) ** 2).mean())

        errors = [error(splatting.refine(moved, start, order, wanted, counts, n)) for n in (0, 1, 2, 6)]
        self.assertLess(errors[1], 0.6 * errors[0])
        self.assertLess(errors[2], 0.4 * errors[0])
        self.assertLess(errors[3], errors[2])
        kept = splatting.refine(wanted_splats, start, order, wanted, counts, 1)
        self.assertLess(float((kept - wanted_splats).abs().max()), 1e-4)

    def test_refinement_makes_up_for_what_is_missing(self):
        """A missing splat: its neighbours come nearer to the picture, and those that share no pixel with them stay."""
        rng, count, missing = np.random.default_rng(9), 120, 60
        everything = splats_of(9, count)
        place = torch.from_numpy(rng.uniform(0, SIDE, (count, 2))).float()
        everything[:, :2], everything[:, 2:5] = place, torch.tensor([1 / 2.25, 0, 1 / 2.25])  # sigma 1.5
        everything[missing, :2], everything[missing, 5] = SIDE / 3, 0.95
        everything[missing, 6:] = torch.tensor([1.0, 0.0, 1.0])
        keys = rng.random(count)
        keys[missing] = -1  # before all others
        start = np.array([0, count], np.int32)
        wanted = splatting.draw(everything, start, splatting.order_by(keys, start), SIDE, SIDE)
        rest = torch.cat((everything[:missing], everything[missing + 1 :]))
        start = np.array([0, count - 1], np.int32)
        order = splatting.order_by(np.delete(keys, missing), start)
        counts = np.ones((1, SIDE, SIDE), np.uint8)
        away = (rest[:, :2] - SIDE / 3).norm(dim=1)
        far, near = away > 2 * 1.5 * 3.4, away < 3  # alpha 1/255 is reached at 3.4 deviations at most

        def error(splats):
            return float(((splatting.draw(splats, start, order, SIDE, SIDE) - wanted) ** 2).mean())

        once = splatting.refine(rest, start, order, wanted, counts, 1)
        self.assertGreater(error(rest), 1e-3)
        self.assertLess(error(once), 0.8 * error(rest))
        self.assertLess(error(splatting.refine(rest, start, order, wanted, counts, 4)), 0.6 * error(rest))
        self.assertTrue(int(far.sum()) > 10 and int(near.sum()) > 0)
        self.assertLess(float((once - rest)[far].abs().max()), 1e-4)
        redder = (once - rest)[near][:, 6] - (once - rest)[near][:, 7]
        self.assertGreater(float(redder.mean()), 0.1)

    def test_pixels_without_say_change_nothing(self):
        splats = splats_of(8)
        start, order = self.order(splats)
        nothing = np.zeros((1, SIDE, SIDE), np.uint8)
        kept = splatting.refine(splats, start, order, torch.zeros(1, 3, SIDE, SIDE), nothing, 2)
        self.assertLess(float((kept - splats).abs().max()), 1e-4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
