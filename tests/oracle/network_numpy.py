#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""network_numpy.py DRIVER, or network_numpy.py --build COMPILER RUNNER: computes each layer of random quantized
networks in plain int64 by numpy, from the text of runtime/head/weights.h, and compares with the runtime's rows and
outputs, bit for bit.

Networks of every kind of layer, kernel, stride, level, phase, width of weights and activations, with two sources and
upsampling; sums at the edge of their accumulators; images of odd and of the smallest sizes. --build makes the driver
for another processor with the other byte order and runs it under an emulator.
"""
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

import objects

HERE = pathlib.Path(__file__).resolve().parent

NETWORKS = 160
FEATURES, OUTPUTS = 9, 9
RUNTIME = HERE.parent.parent / "runtime"
CONV, DEPTHWISE, POINT, NONE = 0, 1, 2, 255
SIZES = [(37, 29), (8, 8), (8, 33), (64, 9), (9, 8), (50, 40), (16, 17), (31, 64)]


def epoch():
    line = next(line for line in (RUNTIME / "include/trim3r.h").read_text().splitlines() if line.startswith("#define T3R_BITS_EPOCH"))
    return int(line.split()[2])


class Layer:
    """A layer's place in the graph and its quantized numbers."""

    def __init__(self, kind, level, sources, outputs, kernel=1, stride=1, phases=1):
        self.kind, self.level, self.sources, self.outputs = kind, level, sources, outputs
        self.kernel, self.stride, self.phases = kernel, stride, phases


class Network:
    """Layers in order; `planes[n]` is the output of layer n, (height, width, channels); n = 0 is the features."""

    def __init__(self, rng, weight_bits, activation_bits, features, edge):
        self.rng, self.weight_bits, self.activation_bits, self.edge = rng, weight_bits, activation_bits, edge
        self.layers, self.zeros = [], [0]
        self.planes = [features * (256 if activation_bits == 16 else 1)]
        self.height, self.width = features.shape[:2]

    def channels(self, source):
        return FEATURES if source == 0 else self.layers[source - 1].outputs

    def level(self, source):
        return 0 if source == 0 else self.layers[source - 1].level

    def quantities(self, layer):
        """Makes random weights and bias within the accumulators' bound, sometimes exactly at it."""
        rng, wide = self.rng, self.activation_bits == 16
        taps = layer.kernel ** 2 * (1 if layer.kind == DEPTHWISE else layer.inputs)
        rows = layer.phases * layer.outputs
        budget = (2 ** 47 - 1) // 2 ** 15 if wide else (2 ** 31 - 1) // 2 ** 7
        most = min(2 ** (self.weight_bits - 1) - 1, budget // (2 * taps))
        weights = rng.integers(-most, most + 1, (rows, taps))
        if self.edge:
            weights = np.abs(weights) * rng.choice([-1, 1], (rows, 1))
        room = (2 ** 47 if wide else 2 ** 31) - 1 - np.abs(weights).sum(1) * (2 ** 15 if wide else 2 ** 7)
        assert (room >= 0).all()
        bias = room * rng.choice([-1, 1], rows) if self.edge else rng.integers(-(room // 8) - 1, room // 8 + 1)
        if not self.edge:
            bias = np.clip(bias, -taps * most * 30, taps * most * 30)
        return weights, bias

    def choose_scale(self, layer, sums):
        """Returns a multiplier and shift per channel, so that most outputs are in range and some far outside."""
        rng = self.rng
        want = 2.0 ** 13 if layer.last or self.activation_bits == 16 else 40.0
        spread = np.maximum(np.abs(sums.reshape(-1, layer.outputs)).mean(0), 1)
        scale = want / spread * 2 ** rng.uniform(-1, 1, layer.outputs)
        shift = np.clip(np.floor(np.log2(scale)).astype(int) + 1, -30, 15)
        layer.multiplier = np.clip((scale * 2.0 ** (31 - shift)).astype(np.int64), 2 ** 30, 2 ** 31 - 1)
        wild = rng.random(layer.outputs) < 0.05
        shift[wild] = rng.integers(-30, 16, wild.sum())
        layer.multiplier[rng.random(layer.outputs) < 0.05] = 2 ** 31 - 1
        layer.shift = shift

    def requantize(self, layer, sums):
        """Requantizes sums (..., outputs), exactly in Python's integers where int64 could overflow."""
        low, high = (-2 ** 15, 2 ** 15 - 1) if layer.last or self.activation_bits == 16 else (-128, 127)
        if self.activation_bits == 16:
            multiplier = np.minimum((layer.multiplier + 2 ** 15) >> 16, 2 ** 15 - 1)
            right = 15 - layer.shift
        else:
            multiplier, right = layer.multiplier, 31 - layer.shift
        product = sums * multiplier
        assert np.abs(product.astype(float)).max() < 2 ** 62.5
        half = np.where(right > 0, np.int64(1) << np.maximum(right - 1, 0), 0)
        return np.clip(layer.zero + ((product + half) >> right), low, high)

    def source_on_grid(self, source, grid, border):
        """Returns a source's plane on the finer grid of a level, with a border of `border` pixels of its zero point."""
        plane, coarser = self.planes[source], self.level(source) - grid
        height, width = -(-self.height >> grid), -(-self.width >> grid)
        ys, xs = np.arange(height) >> coarser, np.arange(width) >> coarser
        wide = np.full((height + 2 * border, width + 2 * border, plane.shape[2]), self.zeros[source], np.int64)
        wide[border:border + height, border:border + width] = plane[ys][:, xs]
        return wide

    def run_plane(self, layer):
        k, s = layer.kernel, layer.stride
        grid, p, border = layer.level - (s - 1), (k - s + 1) // 2, 8
        wide = np.concatenate([self.source_on_grid(n, grid, border) for n in layer.sources], 2)
        height, width = -(-self.height >> layer.level), -(-self.width >> layer.level)
        taps = []
        for ky in range(k):
            for kx in range(k):
                y0, x0 = border - p + ky, border - p + kx
                taps.append(wide[y0:y0 + s * (height - 1) + 1:s, x0:x0 + s * (width - 1) + 1:s])
        under = np.stack(taps, 2)  # (height, width, taps, inputs)
        if layer.kind == DEPTHWISE:
            per_tap = layer.weights.T.reshape(k * k, layer.outputs)
            return (under * per_tap).sum(2) + layer.bias
        return under.reshape(height, width, -1) @ layer.weights.T + layer.bias

    def run_point(self, layer):
        ys, xs = np.arange(self.height), np.arange(self.width)
        inputs = np.concatenate([self.planes[n][ys >> self.level(n)][:, xs >> self.level(n)] for n in layer.sources], 2)
        weights = layer.weights.reshape(layer.phases, layer.outputs, layer.inputs)
        bias = layer.bias.reshape(layer.phases, layer.outputs)
        sums = np.zeros((self.height, self.width, layer.outputs), np.int64)
        for y in range(2):
            for x in range(2):
                phase = 0 if layer.phases == 1 else 2 * y + x
                sums[y::2, x::2] = inputs[y::2, x::2] @ weights[phase].T + bias[phase]
        return sums

    def add(self, layer, last=False):
        layer.last, layer.inputs = last, sum(self.channels(n) for n in layer.sources)
        top = 2 ** (self.activation_bits - 1)
        choices = [0] if last else [0, -top, -top, top - 1, int(self.rng.integers(-top, top))]
        layer.zero = int(self.rng.choice(choices))
        layer.weights, layer.bias = self.quantities(layer)
        sums = self.run_point(layer) if layer.kind == POINT else self.run_plane(layer)
        self.choose_scale(layer, sums)
        self.planes.append(self.requantize(layer, sums))
        self.zeros.append(layer.zero)
        self.layers.append(layer)
        return len(self.layers)

    def file_order(self, layer):
        """Converts rows (phase, output) of taps to the file's order."""
        if layer.kind == DEPTHWISE:
            return layer.weights.T
        return layer.weights

    def save(self, path):
        blocks, table = [], []
        at = 64 + 32 * len(self.layers)
        macs = parameters = 0

        def block(array, kind):
            nonlocal at
            gap = -at % 16
            start = at + gap
            data = np.ascontiguousarray(array).astype(kind).tobytes()
            blocks.append(bytes(gap) + data)
            at = start + len(data)
            return start

        for layer in self.layers:
            offsets = [block(self.file_order(layer), f"<i{self.weight_bits // 8}"),
                       block(layer.bias, "<i8" if self.activation_bits == 16 else "<i4"),
                       block(layer.multiplier, "<i4"), block(layer.shift, "<i1")]
            sources = (list(layer.sources) + [NONE])[:2]
            table.append(struct.pack("<BBBBHHBBBBhHIIII", layer.kind, layer.level, *sources, layer.inputs,
                                     layer.outputs, layer.kernel, layer.stride, layer.phases, 0, layer.zero, 0,
                                     *offsets))
            used = layer.weights.size // layer.phases
            macs += used * 256 // 4 ** layer.level
            parameters += layer.weights.size + layer.bias.size
        rest = struct.pack("<BBBBIII16s16x", self.weight_bits, self.activation_bits, len(self.layers), 1, macs,
                           parameters, 0, b"random")
        rest += b"".join(table) + b"".join(blocks)
        path.write_bytes(b"T3RW" + struct.pack("<HHII", 1, epoch(), at, zlib.crc32(rest)) + rest)


def plane_layer(rng, net, made):
    """Returns a random layer that may follow; its grid is no finer than any of its sources'."""
    kind = CONV if rng.random() < 0.75 else DEPTHWISE
    sources = [int(rng.choice(made))]
    if kind == CONV and len(made) > 1 and rng.random() < 0.5:
        sources.append(int(rng.choice(made)))
    if sum(net.channels(n) for n in sources) > 128:
        sources = sources[:1]
    coarsest = min(net.level(n) for n in sources)
    grid = int(rng.integers(0, coarsest + 1)) if rng.random() < 0.3 else coarsest
    stride = 2 if grid < 4 and rng.random() < 0.45 else 1
    kernel = int(rng.integers(1, 7 if kind == CONV else 6))
    outputs = net.channels(sources[0]) if kind == DEPTHWISE else int(rng.choice([1, 3, 5, 8, 16, 17, 24]))
    return Layer(kind, grid + stride - 1, sources, outputs, kernel, stride)


def random_network(rng, net):
    """Makes up to seven plane layers, each read by a later one, then one to three point layers."""
    made, unread = [0], set()
    for _ in range(int(rng.integers(0, 8))):
        layer = plane_layer(rng, net, made)
        if unread and rng.random() < 0.7:  # continue from the last
            layer = plane_layer(rng, net, [max(unread)])
        unread -= set(layer.sources)
        made.append(net.add(layer))
        unread.add(made[-1])
    unread = sorted(unread)
    while len(unread) > 1:  # point layers read two sources: join loose ends on the finest grid among them
        pair, unread = unread[:2], unread[2:]
        grid = min(net.level(n) for n in pair)
        if sum(net.channels(n) for n in pair) > 128:
            return False
        unread.append(net.add(Layer(CONV, grid, pair, 6, int(rng.integers(1, 4)))))
    sources = (unread or [0]) + ([0] if rng.random() < 0.5 and unread else [])
    count = int(rng.integers(1, 4))
    for i in range(count):
        last = i == count - 1
        phases = 4 if rng.random() < 0.5 else 1
        if i > 0:
            sources = [len(net.layers)] + ([int(rng.choice(made))] if rng.random() < 0.4 else [])
        if sum(net.channels(n) for n in sources) > 128:
            sources = sources[:1]
        net.add(Layer(POINT, 0, sources, OUTPUTS if last else int(rng.choice([4, 16, 33])), phases=phases), last)
    return True


def run_driver(driver, path, net, features, mask):
    given = features.astype(np.int8).tobytes() + mask.astype(np.uint8).tobytes()
    command = driver + [str(path), str(net.width), str(net.height)]
    result = subprocess.run(command, input=given, capture_output=True)
    if result.returncode != 0:
        sys.exit(f"FAILED: {' '.join(command)}: {result.returncode}: {result.stderr.decode()}")
    return result.stdout


def compare(net, mask, output, order):
    """Compares every record of the driver's output with the planes; returns the rows seen of each layer."""
    seen, at = [set() for _ in net.planes], 0
    points = set()
    kind = "i1" if net.activation_bits == 8 else order + "i2"
    while at < len(output):
        n, y, count = struct.unpack_from(order + "III", output, at)
        data = output[at + 12:at + 12 + count]
        at += 12 + count
        if n == 0xffffffff:
            want, got = net.planes[-1][y][mask[y]], np.frombuffer(data, order + "i2")
            points.add(y)
        else:
            want, got = net.planes[n][y], np.frombuffer(data, kind)
            seen[n].add(y)
        if not np.array_equal(got.reshape(want.shape), want):
            where = "outputs" if n == 0xffffffff else f"layer {n}"
            sys.exit(f"FAILED: {where} row {y}: {np.argwhere(got.reshape(want.shape) != want)[:4].tolist()}")
    if points != set(range(net.height)):
        sys.exit("FAILED: rows of outputs are missing")
    return seen


def built(compiler, runner, folder):
    """Builds the driver for another processor, statically linked, and returns it with the command that runs it."""
    lacking = objects.absent(compiler, runner)
    if lacking is not None:
        print(f"SKIPPED: no {lacking} here (tools/setup --tests)")
        sys.exit(77)
    made = pathlib.Path(folder) / "network_driver"
    objects.output_of(compiler, "-O2", "-static", "-I", RUNTIME, "-I", RUNTIME / "include", HERE / "network_driver.c",
                      *objects.compiled([compiler, "-O2"]), "-o", made)
    return [runner, str(made)]


def main():
    rows = layers = networks = 0
    covered = set()
    with tempfile.TemporaryDirectory(prefix="trim3r-network-") as folder:
        emulated = sys.argv[1] == "--build"
        driver = built(sys.argv[2], sys.argv[3], folder) if emulated else sys.argv[1:]
        order = ">" if emulated else "="
        path = pathlib.Path(folder) / "random.t3w"
        for seed in range(NETWORKS):
            rng = np.random.default_rng(seed)
            width, height = SIZES[seed % len(SIZES)]
            weight_bits, activation_bits = [(8, 8), (16, 8), (8, 16), (16, 16)][seed % 4]
            features = rng.integers(-128, 128, (height, width, FEATURES))
            if seed % 5 == 0:
                features[:] = rng.choice([-128, 127])
            mask = rng.random((height, width)) < rng.choice([0.03, 0.3, 1.0])
            net = Network(rng, weight_bits, activation_bits, features, edge=seed % 5 == 0)
            if not random_network(rng, net):
                continue
            net.save(path)
            seen = compare(net, mask, run_driver(driver, path, net, features, mask), order)
            networks += 1
            rows += sum(len(s) for s in seen)
            layers += len(net.layers)
            for layer in net.layers:
                coarser = max(net.level(n) for n in layer.sources) - (layer.level - layer.stride + 1)
                covered.add(("kind, kernel, stride", layer.kind, layer.kernel, layer.stride))
                covered.add(("kind, bits", layer.kind, weight_bits, activation_bits))
                covered.add(("level", layer.level))
                covered.add(("phases", layer.phases, len(layer.sources)))
                covered.add(("upsampled", layer.kind != POINT and coarser > 0, len(layer.sources)))
    wanted = {("kind, kernel, stride", CONV, k, s) for k in range(1, 7) for s in (1, 2)}
    wanted |= {("kind, kernel, stride", DEPTHWISE, k, s) for k in range(1, 6) for s in (1, 2)}
    wanted |= {("kind, bits", kind, w, a) for kind in range(3) for w in (8, 16) for a in (8, 16)}
    wanted |= {("level", n) for n in range(5)} | {("phases", 1, 1), ("phases", 4, 1), ("phases", 1, 2), ("phases", 4, 2)}
    wanted |= {("upsampled", True, 1), ("upsampled", True, 2), ("upsampled", False, 2)}
    if wanted - covered or networks < 0.9 * NETWORKS or rows < 20 * networks:
        sys.exit(f"FAILED: not covered: {sorted(wanted - covered)}; {networks} networks, {rows} rows")
    print(f"{layers} layers of {networks} networks, {rows} of their rows and all outputs: the same bits")


if __name__ == "__main__":
    main()
