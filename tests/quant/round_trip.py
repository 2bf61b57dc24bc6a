#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random heads through `trim3r quantize` and back: the float graph of quant/ against numpy's, every layer of the weight
file in numpy's integers against exact bounds, the runtime's bits against numpy's, and the whole against the float
graph.

round_trip.py PATH/TO/trim3r PATH/TO/float_driver PATH/TO/network_driver"""
import json
import os
import subprocess
import sys
import tempfile

import numpy

import head_file
from checks import check, done, run

TRIM3R, DRIVER, NETWORK = map(os.path.abspath, sys.argv[1:4])
HEIGHT, WIDTH = 37, 50  # no level divides them
# least signal to noise of the whole head's outputs, dB, by (weight bits, activation bits); every_kind has 13 layers
LEAST_SNR = {"plain": {(8, 8): 33, (16, 8): 42, (8, 16): 33, (16, 16): 77},
             "every_kind": {(8, 8): 22, (16, 8): 30, (8, 16): 24, (16, 16): 69}}  # one of 16 bits is headroom
SOURCE_USER = """#include <stdint.h>
#include <stdio.h>
extern const uint8_t t3r_head_NAME[];
extern const uint32_t t3r_head_NAME_bytes;
int main(void)
{
    size_t written = fwrite(t3r_head_NAME, 1, t3r_head_NAME_bytes, stdout);
    return (uintptr_t)t3r_head_NAME % 16 != 0 || written != t3r_head_NAME_bytes;
}
"""


def snr(exact, got):
    return 10 * numpy.log10((exact**2).sum() / ((got - exact)**2).sum())


def check_float_graph(description, features, mask, planes):
    (features_bytes, mask_bytes) = features.tobytes(), mask.astype("u1").tobytes()
    with open("view.raw", "wb") as file:
        file.write(features_bytes + mask_bytes)
    run(DRIVER, "head.safetensors", "view.raw", WIDTH, HEIGHT, "planes.raw")
    got = numpy.fromfile("planes.raw", "f4")
    expected = numpy.concatenate([plane.ravel() for plane in planes[1:]])
    check(got.shape == expected.shape, "the driver's planes have another size")
    at = 0
    for n, plane in enumerate(planes[1:], 1):
        off = numpy.abs(got[at:at + plane.size] - plane.ravel()).max() / numpy.abs(plane).max()
        check(off < 1e-5, f"{description['name']} layer {n}: float graph off by {off} of the largest")
        at += plane.size


def scales(head, description, tensors):
    """Returns each plane's step by channel, from the ranges alone, and each layer's accumulator step from its
    multiplier."""
    feature_step = 1 / 64 if head["activation_bits"] == 8 else 1 / 64 / 256
    outputs, sums = [numpy.full(head_file.FEATURES, feature_step)], []
    for n, l in enumerate(head["layers"], 1):
        if n == len(head["layers"]):
            step = 1 / head_file.OUTPUT_SCALES
        else:
            relu = description["layers"][n - 1]["relu"]
            steps = 2 ** (head["activation_bits"] - (0 if relu else 1)) - 1
            headroom = 2 if head["activation_bits"] == 16 else 1  # given ranges are for 8 bits
            step = headroom * tensors[f"layer{n}.range"].astype(float) / steps
        outputs.append(step)
        sums.append(step * l["multiplier"] * 2.0 ** (l["shift"] - 31))
    return outputs, sums


def check_layers(head, description, tensors, planes, mask):
    """Checks each layer alone, on the integers of the previous layers: its error is at most half a step of its output,
    half a step of each weight times its activation, and half a step of the bias."""
    steps, sum_steps = scales(head, description, tensors)
    height, width = mask.shape
    zeros = [0] + [l["zero"] for l in head["layers"]]
    real = [(plane - zero) * step for plane, zero, step in zip(planes, zeros, steps)]
    for n, l in enumerate(head["layers"], 1):
        which = f"{head['name']} {head['weight_bits']}/{head['activation_bits']} layer {n}"
        weight, bias = tensors[f"layer{n}.weight"].astype(float), tensors[f"layer{n}.bias"].astype(float)
        grid, _ = head_file.gather(head["layers"], real, [0.0] * n, n, height, width)
        counts, _ = head_file.gather(head["layers"], [numpy.abs(p - z) for p, z in zip(planes, zeros)], [0] * n, n,
                                     height, width)
        ones = numpy.ones(l["weight"].shape)
        if l["kind"] == "point":
            exact = head_file.point_sums(l, weight, bias, grid)
            moved = head_file.point_sums(l, ones, 0 * bias, counts)
        else:
            order = weight[:, 0].transpose(1, 2, 0) if l["kind"] == "depthwise" else weight.transpose(0, 2, 3, 1)
            exact = head_file.sums(l, order, grid, numpy.zeros(grid.shape[2]), height, width) + bias
            moved = head_file.sums(l, ones, counts.astype(float), numpy.zeros(grid.shape[2]), height, width)
        bits = 16 if n == len(head["layers"]) else head["activation_bits"]
        low, high = ((limit - l["zero"]) * steps[n] for limit in (-2 ** (bits - 1), 2 ** (bits - 1) - 1))
        bound = 0.5 * steps[n] + sum_steps[n - 1] * (0.5 * moved + 0.5)
        off = numpy.abs(real[n] - numpy.clip(exact, low, high))
        off, bound = (off[mask], bound[mask]) if l["kind"] == "point" else (off, bound)
        check((off <= bound * (1 + 1e-9)).all(), f"{which}: off by {(off / bound).max()} of the bound")
        check(off.max() > 0, f"{which}: nothing was rounded")
        most = numpy.abs(l["weight"]).reshape(*l["weight"].shape[:0], -1).max()
        check(most >= (127 if head["weight_bits"] == 8 else 32767) - 1 or head["activation_bits"] == 8,
              f"{which}: the weights' bits are not used: {most}")


def check_runtime(path, features, mask, integers):
    """Compares the runtime's outputs at the retained pixels, bit for bit."""
    done = subprocess.run([NETWORK, path, str(WIDTH), str(HEIGHT)], capture_output=True,
                          input=features.tobytes() + mask.astype("u1").tobytes())
    check(done.returncode == 0, f"network_driver {path}: {done.stderr.decode()}")
    at, outputs = 0, []
    while at < len(done.stdout):
        layer, _, size = numpy.frombuffer(done.stdout, "u4", 3, at)
        if layer == 0xffffffff:
            outputs.append(numpy.frombuffer(done.stdout, "i2", size // 2, at + 12))
        at += 12 + int(size)
    got = numpy.concatenate(outputs).reshape(-1, head_file.OUTPUTS)
    expected = integers[-1][mask]
    check(got.shape == expected.shape and (got == expected).all(), f"{path}: the runtime's bits are others")


def macs(description):
    return sum(l["outputs"] * l["kernel"]**2 * (1 if l["kind"] == "depthwise" else l["inputs"]) / 4**l["level"]
               for l in description["layers"])


def check_info(path, description, tensors, head):
    info = json.loads(run(TRIM3R, "head-info", path, "--json").stdout)
    parameters = sum(tensor.size for name, tensor in tensors.items() if not name.endswith("range"))
    check(info["macs_per_pixel"] == macs(description), f"{path}: macs {info['macs_per_pixel']}, not {macs(description)}")
    check(info["parameters"] == parameters, f"{path}: parameters {info['parameters']}, not {parameters}")
    check(info["name"] == description["name"], f"{path}: name {info['name']}")
    keys = {"layer", "kind", "level", "sources", "inputs", "outputs", "kernel", "stride", "phases", "relu",
            "macs_per_pixel", "bytes", "work_bytes"}
    for n, (told, l) in enumerate(zip(info["layers"], description["layers"]), 1):
        check(told["layer"] == n and keys <= set(told), f"{path} layer {n}: keys {sorted(told)}")
        check(all(told[key] == l[key] for key in l), f"{path} layer {n}: {told} is not {l}")
    check(len(info["layers"]) == len(description["layers"]), f"{path}: {len(info['layers'])} layers")
    check(sum(told["macs_per_pixel"] for told in info["layers"]) == macs(description), f"{path}: macs of the layers")
    rows = info["feature_work_bytes"] + sum(l["work_bytes"] for l in info["layers"])
    check(0 < info["work_bytes"] - rows < 2 * 4 * (36 * 128 + 16), f"{path}: work bytes do not add up")
    check(all((l["work_bytes"] > 0) == (l["kind"] != "point") for l in info["layers"]), f"{path}: work bytes of a layer")
    if head is not None:
        check((info["weight_bits"], info["activation_bits"]) == (head["weight_bits"], head["activation_bits"]), path)
        check(head["macs"] == macs(description) and head["parameters"] == parameters, f"{path}: header's counts")
        check(info["bytes"] == os.path.getsize(path), f"{path}: bytes")


def check_source(path, name, expected):
    """Checks that OUT.c compiles, and holds the bytes of OUT.t3w."""
    with open("main.c", "w") as file:
        file.write(SOURCE_USER.replace("NAME", name))
    run("cc", "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "main.c", path, "-o", "main")
    done = subprocess.run(["./main"], capture_output=True)
    check(done.returncode == 0 and done.stdout == expected, f"{path} holds other bytes")


def check_head(description, seed):
    random = numpy.random.default_rng(seed)
    tensors = head_file.random_tensors(description, random)
    features, mask = head_file.random_view(random, HEIGHT, WIDTH)
    planes = head_file.run_float(description, tensors, features, mask)
    for n, plane in enumerate(planes[1:-1], 1):
        most = numpy.abs(plane).reshape(-1, plane.shape[2]).max(0)
        tensors[f"layer{n}.range"] = numpy.where(most > 0, most, 1).astype("f4")
    with open("head.safetensors", "wb") as file:
        file.write(head_file.safetensors(tensors, description))
    check_float_graph(description, features, mask, planes)
    check_info("head.safetensors", description, tensors, None)
    # outputs beyond their format are clipped, as they must be
    limits = 32767 / head_file.OUTPUT_SCALES
    exact = numpy.clip(planes[-1][mask], -limits, limits)
    for bits, least in LEAST_SNR[description["name"]].items():
        path = f"head_w{bits[0]}a{bits[1]}.t3w"
        run(TRIM3R, "quantize", "head.safetensors", "--weights", bits[0], "--activations", bits[1], "-o", path)
        with open(path, "rb") as file:
            data = file.read()
        head = head_file.read_t3w(data)
        integers = head_file.run_integers(head, features, mask)
        check_layers(head, description, tensors, integers, mask)
        check_runtime(path, features, mask, integers)
        got = integers[-1][mask] / head_file.OUTPUT_SCALES
        reached = snr(exact, got)
        print(f"{description['name']:10} seed {seed} weights {bits[0]:2} activations {bits[1]:2}: {reached:5.1f} dB, "
              f"{len(data)} bytes")
        check(reached >= least, f"{path} of {description['name']}, seed {seed}: {reached} dB, not {least}")
        check_info(path, description, tensors, head)
        if seed == 0:
            run(TRIM3R, "quantize", "head.safetensors", "--weights", bits[0], "--activations", bits[1], "-o", "head.c")
            check_source("head.c", description["name"], data)


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for seed in range(3):
            check_head(head_file.plain(), seed)
            check_head(head_file.every_kind(), seed)
        os.chdir("/")
    done()


if __name__ == "__main__":
    main()
