#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The perceptual terms of the loss: LPIPS' structure with random weights, the stand-in by differences that it must
and must not notice; usage: terms.py TRAIN_FOLDER"""
import os
import sys
import tempfile
import unittest

try:
    import torch
    import torch.nn.functional as F
    from torch import nn
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

sys.path.insert(0, sys.argv[1])
import perceptual  # noqa: E402

SIDE = 96
TAPS = (1, 4, 7, 9, 11)  # the trunk's layers that LPIPS compares


def alexnet():
    """Builds the trunk like torchvision."""
    return nn.Sequential(
        nn.Conv2d(3, 64, 11, 4, 2), nn.ReLU(), nn.MaxPool2d(3, 2),
        nn.Conv2d(64, 192, 5, padding=2), nn.ReLU(), nn.MaxPool2d(3, 2),
        nn.Conv2d(192, 384, 3, padding=1), nn.ReLU(),
        nn.Conv2d(384, 256, 3, padding=1), nn.ReLU(),
        nn.Conv2d(256, 256, 3, padding=1), nn.ReLU(), nn.MaxPool2d(3, 2),
    )  # fmt: skip


def pictures(count=2, seed=1):
    """Returns smooth patches with texture and hard edges, [count, 3, SIDE, SIDE] in 0.1..0.9."""
    made = torch.rand(count, 3, SIDE, SIDE, generator=torch.Generator().manual_seed(seed))
    coarse = F.interpolate(made[:, :, ::12, ::12], SIDE, mode="nearest")
    return 0.1 + 0.8 * (0.7 * coarse + 0.3 * made)


def blurred(picture, sigma):
    at = torch.arange(-12, 13).float()
    kernel = torch.exp(-(at**2) / (2 * sigma**2))
    kernel = (kernel / kernel.sum()).expand(3, 1, -1)
    padded = F.pad(picture, (12, 12, 12, 12), mode="reflect")
    return F.conv2d(F.conv2d(padded, kernel[:, :, None], groups=3), kernel[:, :, :, None], groups=3)


class Lpips(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(5)
        self.trunk, widths = alexnet(), (64, 192, 384, 256, 256)
        self.linear = {f"lin{n}.model.1.weight": torch.rand(1, width, 1, 1) for n, width in enumerate(widths)}
        with tempfile.TemporaryDirectory() as folder:
            files = [os.path.join(folder, name) for name in ("trunk.pth", "heads.pth")]
            torch.save({f"features.{k}": v for k, v in self.trunk.state_dict().items()}, files[0])
            torch.save(self.linear, files[1])
            self.term = perceptual.Lpips(*files)

    def by_definition(self, a, b):
        """Computes Zhang et al. 2018, eq. 1, layer after layer of the trunk."""
        shift = torch.tensor([-0.030, -0.088, -0.188])[:, None, None]
        scale = torch.tensor([0.458, 0.448, 0.450])[:, None, None]
        x, y = ((2 * p - 1 - shift) / scale for p in (a, b))
        total = 0
        for n, layer in enumerate(self.trunk):
            x, y = layer(x), layer(y)
            if n in TAPS:
                weight = self.linear[f"lin{TAPS.index(n)}.model.1.weight"]
                unit = [v / (v.pow(2).sum(1, keepdim=True).sqrt() + 1e-10) for v in (x, y)]
                total = total + (weight * (unit[0] - unit[1]) ** 2).sum(1).mean((1, 2))
        return total

    def test_wiring(self):
        a, b = pictures(2, 1), pictures(2, 2)
        got, expected = self.term(a, b), self.by_definition(a, b)
        self.assertEqual(got.shape, (2,))
        self.assertTrue(torch.allclose(got, expected, rtol=1e-4), (got, expected))
        self.assertGreater(float(got.min()), 1e-3)
        self.assertEqual(float(self.term(a, a).abs().max()), 0)

    def test_derivatives_reach_the_picture(self):
        a = pictures().requires_grad_(True)
        self.term(a, pictures(2, 2)).sum().backward()
        self.assertTrue(bool(torch.isfinite(a.grad).all()) and float(a.grad.abs().sum()) > 0)


class StandIn(unittest.TestCase):
    term = perceptual.StandIn()

    def test_equal_pictures_cost_nothing(self):
        self.assertEqual(float(self.term(pictures(), pictures()).abs().max()), 0)

    def test_blur_costs_more_and_more(self):
        sharp = pictures()
        costs = [self.term(blurred(sharp, sigma), sharp) for sigma in (0.5, 1, 2, 4)]
        for less, more in zip(costs, costs[1:]):
            self.assertTrue(bool((more > 1.1 * less).all()), costs)
        self.assertTrue(bool((costs[0] > 1e-3).all()))

    def test_a_level_costs_nothing(self):
        a, b = pictures(2, 1), pictures(2, 2)
        self.assertLess(float(self.term(b + 0.1, b).max()), 1e-6)
        self.assertTrue(torch.allclose(self.term(a + 0.1, b), self.term(a, b), rtol=1e-4))

    def test_a_displaced_edge_costs(self):
        a = pictures()
        self.assertGreater(float(self.term(a.roll(2, 3), a).min()), 0.1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
