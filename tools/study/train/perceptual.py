# SPDX-License-Identifier: Apache-2.0
"""Perceptual terms of the training loss: LPIPS if trunk weights are given, otherwise a substitute."""
import torch
import torch.nn.functional as F
from torch import nn

LAMBDA = 0.001  # GaussianTrim3R eq. 3


class StandIn(nn.Module):
    """Squared differences of gradients over four octaves, each normalised by its contrast: blur and displaced edges
    weigh more than level errors. About 1 between unlike pictures."""

    def forward(self, a, b):
        """a, b: [n, 3, h, w] in 0..1; [n]."""
        total = torch.zeros(len(a), device=a.device)
        for octave in range(4):
            if octave:
                a, b = F.avg_pool2d(a, 2), F.avg_pool2d(b, 2)
            for axis in (2, 3):
                da, db = torch.diff(a, dim=axis), torch.diff(b, dim=axis)
                contrast = (db * db).mean((1, 2, 3)) + 1e-4
                total = total + ((da - db) ** 2).mean((1, 2, 3)) / contrast / 8
        return total


class Lpips(nn.Module):
    """Zhang et al. 2018, "The Unreasonable Effectiveness of Deep Features", AlexNet: trunk weights as torchvision names
    them (features.N.weight), heads as LPIPS v0.1 names them (linN.model.1.weight)."""

    LAYERS = ((0, 4, 2), (3, 1, 2), (6, 1, 1), (8, 1, 1), (10, 1, 1))  # index, stride, padding

    def __init__(self, trunk, heads):
        super().__init__()
        weights, linear = torch.load(trunk, map_location="cpu"), torch.load(heads, map_location="cpu")
        for n, (index, _, _) in enumerate(self.LAYERS):
            self.register_buffer(f"w{n}", weights[f"features.{index}.weight"].float())
            self.register_buffer(f"b{n}", weights[f"features.{index}.bias"].float())
            self.register_buffer(f"l{n}", linear[f"lin{n}.model.1.weight"].float())
        self.register_buffer("shift", torch.tensor([-0.030, -0.088, -0.188]).reshape(1, 3, 1, 1))
        self.register_buffer("scale", torch.tensor([0.458, 0.448, 0.450]).reshape(1, 3, 1, 1))

    def _features(self, x):
        x, made = (2 * x - 1 - self.shift) / self.scale, []
        for n, (_, stride, padding) in enumerate(self.LAYERS):
            if n in (1, 2):
                x = F.max_pool2d(x, 3, 2)
            x = F.relu(F.conv2d(x, getattr(self, f"w{n}"), getattr(self, f"b{n}"), stride, padding))
            made.append(x / (x.norm(dim=1, keepdim=True) + 1e-10))
        return made

    def forward(self, a, b):
        """a, b: [n, 3, h, w] in 0..1, at least 64 pixels a side; [n]."""
        total = torch.zeros(len(a), device=a.device)
        for n, (x, y) in enumerate(zip(self._features(a), self._features(b))):
            total = total + F.conv2d((x - y) ** 2, getattr(self, f"l{n}")).mean((1, 2, 3))
        return total
