# SPDX-License-Identifier: Apache-2.0
"""The Gaussian head in torch: the layers of runtime/head/weights.h, in float or rounded like quant's."""
import json
import math
import struct

import numpy as np
import torch
import torch.nn.functional as F
from torch import nn

FEATURES, OUTPUTS = 9, 9
FEATURE_STEP = 1 / 64  # of the int8 features, quant/README.md
START = (0, 0, math.log2(0.6), math.log2(0.6), 0, 0.96, 0, 0, 0)  # the last layer's bias: the analytic head
RANGE_LEAST = 1e-3


def _conv(level, sources, inputs, outputs, kernel, stride=1):
    return dict(kind="conv", level=level, sources=sources, inputs=inputs, outputs=outputs, kernel=kernel, stride=stride,
                phases=1, relu=True)  # fmt: skip


def _depthwise(level, sources, channels, kernel, stride=1):
    """Has no nonlinearity: the convolution of kernel 1 that follows completes it."""
    return dict(kind="depthwise", level=level, sources=sources, inputs=channels, outputs=channels, kernel=kernel, stride=stride,
                phases=1, relu=False)  # fmt: skip


def _point(sources, inputs, outputs, phases=1, relu=True):
    return dict(kind="point", level=0, sources=sources, inputs=inputs, outputs=outputs, kernel=1, stride=1,
                phases=phases, relu=relu)  # fmt: skip


def u_net(half, quarter, eighth, hidden):
    """Three levels below the picture's own, and two layers at the retained points only."""
    return [
        _conv(1, [0], FEATURES, half, 4, 2),
        _conv(1, [1], half, half, 3),
        _conv(2, [2], half, quarter, 3, 2),
        _conv(2, [3], quarter, quarter, 3),
        _conv(3, [4], quarter, eighth, 3, 2),
        _conv(3, [5], eighth, eighth, 3),
        _conv(2, [4, 6], quarter + eighth, quarter, 1),
        _conv(2, [7], quarter, quarter, 3),
        _conv(1, [2, 8], half + quarter, half, 1),
        _conv(1, [9], half, half, 3),
        _point([10, 0], half + FEATURES, hidden, 4),
        _point([11], hidden, OUTPUTS, 1, False),
    ]


def small_u_net(channels, hidden):
    """The same levels with one or two layers each, for microcontrollers."""
    return [
        _depthwise(1, [0], FEATURES, 4, 2),
        _conv(1, [1], FEATURES, channels, 1),
        _conv(2, [2], channels, channels, 3, 2),
        _conv(2, [3], channels, channels, 3),
        _conv(3, [4], channels, channels, 3, 2),
        _conv(2, [4, 5], 2 * channels, channels, 1),
        _conv(1, [2, 6], 2 * channels, channels, 1),
        _point([7, 0], channels + FEATURES, hidden, 4),
        _point([8], hidden, OUTPUTS, 1, False),
    ]


HEADS = {"tiny": small_u_net(8, 8), "small": u_net(20, 28, 20, 20)}


def multiply_accumulates(layers, kept=1.0):
    """Returns the multiply-accumulates per pixel, with this share of the pixels retained."""
    total = 0.0
    for layer in layers:
        area = layer["kernel"] ** 2 * layer["outputs"] * (1 if layer["kind"] == "depthwise" else layer["inputs"])
        total += area * kept if layer["kind"] == "point" else area / 4 ** layer["level"]
    return total


class _Round(torch.autograd.Function):
    @staticmethod
    def forward(context, x):
        return torch.round(x)

    @staticmethod
    def backward(context, gradient):
        return gradient


class Head(nn.Module):
    """forward(features [b, 9, h, w] in FEATURE_STEP units, points (b, y, x)) -> [n, 9], natural units.

    `mode`: "float"; "observe", which also follows each channel's range; "quantized", which rounds weights to int8 by
    output channel and activations to 8 bits by channel, derivatives passing through."""

    def __init__(self, layers, seed=0):
        super().__init__()
        self.layers, self.mode = layers, "float"
        self.weight, self.bias = nn.ParameterList(), nn.ParameterList()
        rng = np.random.default_rng(seed)
        for n, layer in enumerate(layers, 1):
            inputs, outputs, k, phases = layer["inputs"], layer["outputs"], layer["kernel"], layer["phases"]
            shape = {"conv": (outputs, inputs, k, k), "depthwise": (outputs, 1, k, k)}.get(
                layer["kind"], (phases, outputs, inputs)
            )
            fan = k * k * (1 if layer["kind"] == "depthwise" else inputs)
            drawn = rng.standard_normal(shape, dtype=np.float32) * math.sqrt(2 / fan)
            self.weight.append(nn.Parameter(torch.from_numpy(drawn)))
            self.bias.append(nn.Parameter(torch.zeros((phases, outputs) if layer["kind"] == "point" else outputs)))
            self.register_buffer(f"range{n}", torch.zeros(outputs))
        with torch.no_grad():
            self.weight[-1] *= 0.02
            self.bias[-1][:] = torch.tensor(START)

    def _step(self, n):
        """Returns the size of one activation step of source n, by channel."""
        if n == 0:
            return torch.full((FEATURES,), FEATURE_STEP, device=self.range1.device)
        levels = 255 if self.layers[n - 1]["relu"] else 127
        return getattr(self, f"range{n}").clamp(min=RANGE_LEAST) / levels

    def _weight(self, n):
        w = self.weight[n - 1]
        if self.mode != "quantized":
            return w
        layer = self.layers[n - 1]
        steps = torch.cat([self._step(s) for s in layer["sources"]])
        by_input = {"conv": (1, -1, 1, 1), "depthwise": (-1, 1, 1, 1), "point": (1, 1, -1)}[layer["kind"]]
        folded = w * steps.reshape(by_input)
        dims = (0, 2) if layer["kind"] == "point" else (1, 2, 3)
        scale = folded.detach().abs().amax(dims, keepdim=True).clamp(min=1e-12) / 127
        return _Round.apply(folded / scale) * scale / steps.reshape(by_input)

    def _activation(self, n, x):
        """x: channels in dimension 1."""
        layer = self.layers[n - 1]
        if layer["relu"]:
            x = F.relu(x)
        if n == len(self.layers) or self.mode == "float":
            return x
        shape = (1, -1) + (1,) * (x.dim() - 2)
        if self.mode == "observe":
            seen = getattr(self, f"range{n}")
            most = x.detach().abs().transpose(0, 1).flatten(1).amax(1)
            seen.copy_(torch.where(seen == 0, most, torch.maximum(most, seen * 0.995 + most * 0.005)))
            return x
        step = self._step(n).reshape(shape)
        top = 255 if layer["relu"] else 127
        bottom = 0 if layer["relu"] else -128
        return _Round.apply(torch.minimum(torch.maximum(x, bottom * step), top * step) / step) * step

    def _plane(self, n, made):
        layer, parts = self.layers[n - 1], []
        stride, kernel = layer["stride"], layer["kernel"]
        wanted = layer["level"] - (1 if stride == 2 else 0)
        height, width = (-(-made[0].shape[d] // 2**wanted) for d in (2, 3))
        for s in layer["sources"]:
            plane = made[s]
            level = self.layers[s - 1]["level"] if s else 0
            for _ in range(level - wanted):
                plane = F.interpolate(plane, scale_factor=2, mode="nearest")
            parts.append(plane[:, :, :height, :width])
        plane = torch.cat(parts, 1) if len(parts) > 1 else parts[0]
        before = (kernel - stride + 1) // 2
        rows, columns = -(-height // stride), -(-width // stride)
        below = (rows - 1) * stride - before + kernel - height
        right = (columns - 1) * stride - before + kernel - width
        plane = F.pad(plane, (before, max(right, 0), before, max(below, 0)))
        groups = layer["inputs"] if layer["kind"] == "depthwise" else 1
        plane = F.conv2d(plane, self._weight(n), self.bias[n - 1], stride, groups=groups)[:, :, :rows, :columns]
        return self._activation(n, plane)

    def _points(self, n, made, points):
        layer, parts = self.layers[n - 1], []
        b, y, x = points
        for s in layer["sources"]:
            source = made[s]
            if source.dim() == 4:
                level = self.layers[s - 1]["level"] if s else 0
                source = source[b, :, y >> level, x >> level]
            parts.append(source)
        value = torch.cat(parts, 1) if len(parts) > 1 else parts[0]
        weight, bias = self._weight(n), self.bias[n - 1]
        if layer["phases"] == 1:
            return self._activation(n, F.linear(value, weight[0], bias[0]))
        phase = 2 * (y & 1) + (x & 1)
        all_phases = torch.einsum("ni,poi->npo", value, weight) + bias
        return self._activation(n, all_phases[torch.arange(len(value), device=value.device), phase])

    def forward(self, features, points):
        made = [features]
        for n, layer in enumerate(self.layers, 1):
            made.append(self._points(n, made, points) if layer["kind"] == "point" else self._plane(n, made))
        return made[-1]


def widened(head, layers, seed=0):
    """Returns a head of the same graph with at least as many channels everywhere, which at first computes the same
    as `head`: weights of added channels start at random, weights that read them at 0 (Chen et al. 2016,
    "Net2Net")."""
    made = Head(layers, seed)
    width = [FEATURES] + [layer["outputs"] for layer in head.layers]
    wide = [FEATURES] + [layer["outputs"] for layer in layers]
    with torch.no_grad():
        for n, (old, new) in enumerate(zip(head.layers, layers)):
            if [old[k] for k in ("kind", "level", "sources", "kernel", "stride", "phases")] != [
                new[k] for k in ("kind", "level", "sources", "kernel", "stride", "phases")
            ] or old["outputs"] > new["outputs"]:
                raise ValueError(f"layer {n + 1}: not a wider version of the same layer")
            first, places = 0, []
            for source in new["sources"]:  # channels of the old inputs among the new ones
                places += range(first, first + width[source])
                first += wide[source]
            if new["kind"] == "depthwise":
                places = [0]  # each output has one input
            outputs, point = old["outputs"], new["kind"] == "point"
            rows = made.weight[n][:, :outputs] if point else made.weight[n][:outputs]
            rows.zero_()
            if point:
                rows[:, :, places] = head.weight[n]
                made.bias[n][:, :outputs] = head.bias[n]
            else:
                rows[:, places] = head.weight[n]
                made.bias[n][:outputs] = head.bias[n]
    return made


def save_safetensors(head, path, name):
    """Writes the head for `trim3r quantize`; quant/README.md describes the tensors and the metadata."""
    tensors = {}
    for n, _ in enumerate(head.layers, 1):
        tensors[f"layer{n}.weight"] = head.weight[n - 1]
        tensors[f"layer{n}.bias"] = head.bias[n - 1]
        seen = getattr(head, f"range{n}")
        if n < len(head.layers) and bool((seen > 0).any()):
            tensors[f"layer{n}.range"] = seen.clamp(min=RANGE_LEAST)
    graph = {"format": 1, "name": name, "feature_set": 1, "layers": head.layers}
    header, data = {"__metadata__": {"trim3r": json.dumps(graph)}}, b""
    for key, tensor in tensors.items():
        raw = tensor.detach().cpu().contiguous().numpy().astype("<f4").tobytes()
        header[key] = {"dtype": "F32", "shape": list(tensor.shape), "data_offsets": [len(data), len(data) + len(raw)]}
        data += raw
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + data)


def load_safetensors(path):
    """Returns the head in a .safetensors file, and its name."""
    with open(path, "rb") as file:
        raw = file.read()
    (size,) = struct.unpack("<Q", raw[:8])
    header, data = json.loads(raw[8 : 8 + size]), raw[8 + size :]
    graph = json.loads(header["__metadata__"]["trim3r"])
    head = Head(graph["layers"])

    def tensor(key):
        entry = header[key]
        a, b = entry["data_offsets"]
        return torch.from_numpy(np.frombuffer(data[a:b], "<f4").reshape(entry["shape"]).astype(np.float32))

    with torch.no_grad():
        for n in range(1, len(graph["layers"]) + 1):
            head.weight[n - 1].copy_(tensor(f"layer{n}.weight"))
            head.bias[n - 1].copy_(tensor(f"layer{n}.bias"))
            if f"layer{n}.range" in header:
                getattr(head, f"range{n}").copy_(tensor(f"layer{n}.range"))
    return head, graph["name"]
