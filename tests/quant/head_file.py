# SPDX-License-Identifier: Apache-2.0
"""Heads in numpy, written from runtime/head/weights.h alone: writes .safetensors, reads .t3w, runs the graph in floats
and in integers.

A description is the JSON object of the metadata key "trim3r"; tensors are a dict of float32 arrays."""
import json
import struct
import zlib

import numpy

FEATURES = 9
OUTPUTS = 9
OUTPUT_SCALES = numpy.array([2.0**14, 2.0**14, 2.0**13, 2.0**13, 2.0**14, 2.0**15, 2.0**13, 2.0**13, 2.0**13])
KINDS = ["conv", "depthwise", "point"]


def safetensors(tensors, description, metadata=None):
    header, data = {"__metadata__": metadata or {"trim3r": json.dumps(description)}}, b""
    for name, tensor in tensors.items():
        raw = numpy.ascontiguousarray(tensor, "<f4").tobytes()
        header[name] = {"dtype": "F32", "shape": list(tensor.shape), "data_offsets": [len(data), len(data) + len(raw)]}
        data += raw
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    return struct.pack("<Q", len(text)) + text + data



def layer(kind, level, sources, inputs, outputs, kernel=1, stride=1, phases=1, relu=True):
    return dict(kind=kind, level=level, sources=sources, inputs=inputs, outputs=outputs, kernel=kernel, stride=stride,
                phases=phases, relu=relu)


def every_kind():
    """Returns a description with every kind, kernel size, stride, phase count and kind of source in the format."""
    return {"format": 1, "name": "every_kind", "feature_set": 1, "layers": [
        layer("conv", 1, [0], 9, 10, 6, 2),
        layer("depthwise", 1, [1], 10, 10, 3),
        layer("conv", 1, [2], 10, 12, 1),
        layer("depthwise", 2, [3], 12, 12, 5, 2, relu=False),
        layer("conv", 3, [4], 12, 8, 2, 2),
        layer("conv", 2, [5, 4], 20, 7, 3),
        layer("conv", 1, [6, 2], 17, 6, 4, relu=False),
        layer("conv", 0, [7, 0], 15, 5, 5),
        layer("depthwise", 4, [5], 8, 8, 4, 2),
        layer("depthwise", 0, [7], 6, 6, 2),
        layer("point", 0, [8, 9], 13, 11, phases=4),
        layer("point", 0, [11, 10], 17, 10),
        layer("point", 0, [12, 0], 19, 9, phases=4, relu=False)]}


def plain():
    return {"format": 1, "name": "plain", "feature_set": 1, "layers": [
        layer("conv", 1, [0], 9, 16, 6, 2),
        layer("conv", 2, [1], 16, 16, 4, 2),
        layer("conv", 1, [2, 1], 32, 16, 3),
        layer("point", 0, [3, 0], 25, 24, phases=4),
        layer("point", 0, [4], 24, 9, relu=False)]}


def random_tensors(description, random):
    """Draws weights that keep the activations' size, over one order of magnitude between channels."""
    tensors = {}
    for n, l in enumerate(description["layers"], 1):
        k, fan_in = l["kernel"], 1 if l["kind"] == "depthwise" else l["inputs"]
        gain = 10 ** random.uniform(-0.5, 0.5, l["outputs"]) * numpy.sqrt(2 / (fan_in * k * k))
        if l["kind"] == "point":
            gain = gain if n < len(description["layers"]) else 0.2 / numpy.sqrt(l["inputs"])
            weight = random.normal(size=(l["phases"], l["outputs"], l["inputs"])) * numpy.reshape(gain, (-1, 1))
            bias = random.normal(size=(l["phases"], l["outputs"])) * 0.1
        else:
            weight = random.normal(size=(l["outputs"], fan_in, k, k)) * gain[:, None, None, None]
            bias = random.normal(size=l["outputs"]) * 0.3
        tensors[f"layer{n}.weight"] = weight.astype("f4")
        tensors[f"layer{n}.bias"] = bias.astype("f4")
    return tensors


def random_view(random, height, width):
    """Draws smooth features with noise, and a mask of a third of the pixels."""
    y, x = numpy.mgrid[:height, :width]
    waves = [numpy.sin(x / (3 + c) + c) * numpy.cos(y / (4 + c)) * 90 for c in range(FEATURES)]
    features = numpy.stack(waves, -1) + random.normal(size=(height, width, FEATURES)) * 25
    return numpy.clip(numpy.round(features), -128, 127).astype(numpy.int8), random.random((height, width)) < 1 / 3



def gather(layers, planes, zeros, n, height, width):
    """Returns layer n's sources on its kernel's grid, channels one after the other, and each channel's zero."""
    l = layers[n - 1]
    grid = l["level"] - (l["stride"] - 1)
    rows, columns = -(-height // 2**grid), -(-width // 2**grid)
    parts, zero = [], []
    for source in l["sources"]:
        up = (0 if source == 0 else layers[source - 1]["level"]) - grid
        part = planes[source][numpy.arange(rows) >> up][:, numpy.arange(columns) >> up]
        parts.append(part)
        zero += [zeros[source]] * part.shape[2]
    return numpy.concatenate(parts, 2), numpy.array(zero, parts[0].dtype)


def sums(l, weight, grid, zero, height, width):
    """Returns the sums of weight x source of a conv or depthwise layer: `weight` is [outputs][k][k][inputs] or
    [k][k][out]."""
    k, s, p = l["kernel"], l["stride"], (l["kernel"] - l["stride"] + 1) // 2
    rows, columns = -(-height // 2 ** l["level"]), -(-width // 2 ** l["level"])
    padded = numpy.broadcast_to(zero, (s * rows + k, s * columns + k, grid.shape[2])).copy()
    padded[p:p + grid.shape[0], p:p + grid.shape[1]] = grid[:s * rows + k - p, :s * columns + k - p]
    total = 0
    for ky in range(k):
        for kx in range(k):
            taken = padded[ky:ky + s * rows:s, kx:kx + s * columns:s]
            total = total + (taken * weight[ky, kx] if l["kind"] == "depthwise" else taken @ weight[:, ky, kx].T)
    return total


def point_sums(l, weight, bias, grid):
    """Returns the same with the bias, for a point layer: `weight` is [phases][outputs][inputs]."""
    y, x = numpy.mgrid[:grid.shape[0], :grid.shape[1]]
    phase = 2 * (y & 1) + (x & 1) if l["phases"] == 4 else 0 * y
    return numpy.einsum("yxoi,yxi->yxo", weight[phase], grid) + bias[phase]


def run_float(description, tensors, features, mask):
    """Returns every layer's output; point layers give 0 where nothing is retained."""
    layers, (height, width) = description["layers"], mask.shape
    planes = [features.astype(float) / 64]
    for n, l in enumerate(layers, 1):
        weight, bias = tensors[f"layer{n}.weight"].astype(float), tensors[f"layer{n}.bias"].astype(float)
        grid, zero = gather(layers, planes, [0.0] * n, n, height, width)
        if l["kind"] == "point":
            out = point_sums(l, weight, bias, grid)
        elif l["kind"] == "depthwise":
            out = sums(l, weight[:, 0].transpose(1, 2, 0), grid, zero, height, width) + bias
        else:
            out = sums(l, weight.transpose(0, 2, 3, 1), grid, zero, height, width) + bias
        out = numpy.maximum(out, 0) if l["relu"] else out
        planes.append(out * mask[:, :, None] if l["kind"] == "point" else out)
    return planes



def read_t3w(data):
    magic, form, epoch, size, crc = struct.unpack_from("<4sHHII", data)
    weight_bits, activation_bits, count, feature_set, macs_q8, parameters, reserved = struct.unpack_from("<4B3I", data, 16)
    assert magic == b"T3RW" and form == 1 and feature_set == 1 and reserved == 0 and size == len(data)
    assert crc == zlib.crc32(data[16:]) and data[48:64] == bytes(16)
    head = dict(name=data[32:48].rstrip(b"\0").decode(), epoch=epoch, weight_bits=weight_bits, parameters=parameters,
                activation_bits=activation_bits, macs=macs_q8 / 256, layers=[])
    for n in range(count):
        row = struct.unpack_from("<4B2H4BhH4I", data, 64 + 32 * n)
        kind, level, a, b, inputs, outputs, kernel, stride, phases, zero8, zero, zero16, *offsets = row
        assert zero8 == 0 and zero16 == 0 and all(offset % 16 == 0 for offset in offsets)
        l = dict(kind=KINDS[kind], level=level, sources=[s for s in (a, b) if s != 255], inputs=inputs, outputs=outputs,
                 kernel=kernel, stride=stride, phases=phases, zero=zero)
        shape = {"conv": (outputs, kernel, kernel, inputs), "depthwise": (kernel, kernel, outputs),
                 "point": (phases, outputs, inputs)}[l["kind"]]

        def block(offset, kind, shape):
            return numpy.frombuffer(data, kind, int(numpy.prod(shape)), offset).reshape(shape)
        l["weight"] = block(offsets[0], f"<i{weight_bits // 8}", shape).astype(numpy.int64)
        l["bias"] = block(offsets[1], f"<i{activation_bits // 2}", (phases, outputs)).astype(numpy.int64)
        l["multiplier"] = block(offsets[2], "<i4", outputs).astype(numpy.int64)
        l["shift"] = block(offsets[3], "<i1", outputs).astype(numpy.int64)
        head["layers"].append(l)
    return head


def requantize(acc, multiplier, shift, activation_bits):
    if activation_bits == 8:
        assert numpy.abs(acc).max() < 2**31
        down = 31 - shift
    else:
        assert numpy.abs(acc).max() < 2**47
        multiplier, down = numpy.minimum((multiplier + 2**15) >> 16, 32767), 15 - shift
    half = numpy.where(down > 0, numpy.int64(1) << numpy.maximum(down - 1, 0), 0)
    return (acc * multiplier + half) >> down


def run_integers(head, features, mask):
    """Returns every layer's output, as the runtime must compute it."""
    layers, bits, (height, width) = head["layers"], head["activation_bits"], mask.shape
    planes, zeros = [features.astype(numpy.int64) * (256 if bits == 16 else 1)], [0]
    for n, l in enumerate(layers, 1):
        grid, zero = gather(layers, planes, zeros, n, height, width)
        if l["kind"] == "point":
            acc = point_sums(l, l["weight"], l["bias"], grid)
        else:
            acc = sums(l, l["weight"], grid, zero, height, width) + l["bias"][0]
        limit = 2 ** ((16 if n == len(layers) else bits) - 1)
        out = numpy.clip(l["zero"] + requantize(acc, l["multiplier"], l["shift"], bits), -limit, limit - 1)
        planes.append(out * mask[:, :, None] if l["kind"] == "point" else out)
        zeros.append(l["zero"])
    return planes
