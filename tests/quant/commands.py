#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""trim3r quantize and head-info from outside: outputs, refusals, calibrated ranges.

commands.py PATH/TO/trim3r"""
import json
import os
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy

import head_file

TRIM3R = os.path.abspath(sys.argv[1])
failures = []


def check(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def expect(code, *arguments, err=None, out=None):
    done = subprocess.run([TRIM3R, *map(str, arguments)], capture_output=True, text=True)
    line = " ".join(map(str, arguments))
    check(done.returncode == code, f"{line}: exit {done.returncode}, not {code}: {done.stderr.strip()}")
    check(err is None or err in done.stderr, f"{line}: '{done.stderr.strip()}' does not say '{err}'")
    check(out is None or out in done.stdout, f"{line}: '{done.stdout.strip()}' does not say '{out}'")
    return done.stdout


def write(path, content):
    with open(path, "wb") as file:
        file.write(content)
    return path


def read(path):
    with open(path, "rb") as file:
        return file.read()


def png(width, height, colour):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(colour) * width for _ in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def identity():
    """Returns a first layer that passes the features on, so that its ranges are theirs."""
    description = {"format": 1, "name": "identity", "feature_set": 1, "layers": [
        head_file.layer("conv", 0, [0], 9, 9, relu=False), head_file.layer("point", 0, [1], 9, 9, relu=False)]}
    return description, {"layer1.weight": numpy.eye(9).reshape(9, 9, 1, 1), "layer1.bias": numpy.zeros(9),
                         "layer2.weight": numpy.eye(9).reshape(1, 9, 9), "layer2.bias": numpy.zeros((1, 9))}


def ranges_of(path):
    """Returns the ranges of an identity's first layer, in feature units: a weight w and multiplier m mean a step of 1 /
    (w m)."""
    head = head_file.read_t3w(read(path))
    first = head["layers"][0]
    weight = first["weight"].reshape(9, 9).diagonal()
    bits = head["activation_bits"]
    step = 1 / (weight * first["multiplier"] * 2.0 ** (first["shift"] - 31)) / (1 if bits == 8 else 256)
    return step * (2 ** (bits - 1) - 1)


def test_calibration():
    write("identity.safetensors", head_file.safetensors(identity()[1], identity()[0]))
    write("flat.png", png(80, 64, (120, 128, 28)))
    expect(0, "quantize", "identity.safetensors", "--calibrate", "flat.png", "--size", "64x64", "-o", "i.t3w",
           "--percentile", 100, out="1 layers measured")
    found = ranges_of("i.t3w")
    # red 120, blue 28, retained, confidence; green and both gradients are 0 throughout and get the maximum
    expected = {0: 8, 1: 127, 2: 100, 3: 127, 4: 127, 7: 127, 8: 127}
    for channel, value in expected.items():
        check(abs(found[channel] / value - 1) < 1e-4, f"range of feature {channel}: {found[channel]}, not {value}")
    # log2 of the density, 64 at 100 % and -70 at the minimum; and of the flat texture
    check(abs(found[6] - 104) < 1.01 and 63 < found[5] < 70.1, f"ranges of density and texture: {found[5]}, {found[6]}")
    # 16 bits take twice the maximum
    expect(0, "quantize", "identity.safetensors", "--calibrate", "flat.png", "--size", "64x64", "-o", "i16.t3w",
           "--activations", 16, "--weights", 16)
    wide = ranges_of("i16.t3w")
    for channel, value in expected.items():
        check(abs(wide[channel] / value / 2 - 1) < 1e-4, f"16-bit range of feature {channel}: {wide[channel]}")
    # recordings and images add up, in either form, and the same input gives the same file
    expect(0, "room", "--size", "32x32", "-o", "room.mcap")
    arguments = ["--calibrate", "room.mcap", "--calibrate", "flat.png", "--size", "64x64"]
    told = json.loads(expect(0, "quantize", "identity.safetensors", *arguments, "-o", "a.t3w", "--json"))
    expect(0, "quantize", "--calibrate", "room.mcap", "identity.safetensors", "flat.png", "--size", "64x64", "-o", "b.t3w")
    check(read("a.t3w") == read("b.t3w"), "the same input gives another file")
    check(told["calibrated_layers"] == 1 and told["bytes"] == os.path.getsize("a.t3w") and told["name"] == "identity"
          and len(told["weight_snr_db"]) == 2 and told["weight_bits"] == 8, f"quantize --json says {told}")
    check(ranges_of("a.t3w")[0] > 30, "the room is not in the ranges")
    # a head's own ranges are kept
    tensors = {**identity()[1], "layer1.range": numpy.full(9, 3.0)}
    write("own.safetensors", head_file.safetensors(tensors, identity()[0]))
    expect(0, "quantize", "own.safetensors", "--calibrate", "flat.png", "-o", "own.t3w", out="0 layers measured, 1 from")
    check(numpy.allclose(ranges_of("own.t3w"), 3 * 64, rtol=1e-4), f"own ranges: {ranges_of('own.t3w')}")
    expect(0, "head-info", "own.safetensors", out=" yes")
    check(json.loads(expect(0, "head-info", "own.safetensors", "--json"))["layers"][0]["has_range"], "has_range")


def test_refusals():
    expect(2, "quantize", err="HEAD.safetensors is missing")
    expect(2, "quantize", "identity.safetensors", err="-o")
    expect(2, "quantize", "identity.safetensors", "-o", "x.bin", err=".t3w or .c")
    expect(2, "quantize", "identity.safetensors", "other.safetensors", "-o", "x.t3w", err="too many")
    for option, value in [("--weights", "4"), ("--activations", "32"), ("--percentile", "0"), ("--percentile", "101"),
                          ("--name", "A b"), ("--name", "sixteen_letters_"), ("--size", "7x7")]:
        expect(2, "quantize", "identity.safetensors", "-o", "x.t3w", option, value, err=option)
    expect(1, "quantize", "absent.safetensors", "-o", "x.t3w", err="absent.safetensors: No such file")
    expect(1, "quantize", "identity.safetensors", "-o", "x.t3w", err="no tensor layer1.range; --calibrate")
    expect(1, "quantize", "identity.safetensors", "--calibrate", "absent.png", "-o", "x.t3w", err="absent.png")
    expect(1, "quantize", "identity.safetensors", "--calibrate", "absent.mcap", "-o", "x.t3w", err="absent.mcap")
    expect(1, "quantize", "flat.png", "-o", "x.t3w", err="not a .safetensors")
    expect(1, "quantize", "own.safetensors", "-o", "no/such/folder/x.t3w", err="no/such/folder/x.t3w")
    check(not os.path.exists("x.t3w"), "a refusal leaves a file")
    huge = {**identity()[1], "layer1.range": numpy.full(9, 3.0), "layer2.weight": numpy.full((1, 9, 9), 1e30)}
    write("huge.safetensors", head_file.safetensors(huge, identity()[0]))
    expect(1, "quantize", "huge.safetensors", "-o", "x.t3w", err="layer 2: weights or biases of output 0 are too large")
    expect(2, "head-info", err="missing")
    expect(2, "head-info", "own.t3w", "own.t3w", err="too many")
    expect(1, "head-info", "absent.t3w", err="absent.t3w: No such file")
    expect(1, "head-info", write("cut.t3w", read("own.t3w")[:-1]), err="cut.t3w: the file is not as long as it says")
    expect(1, "head-info", write("cut.safetensors", read("own.safetensors")[:-1]), err="outside the file")
    expect(1, "head-info", write("empty.t3w", b""), err="empty.t3w: 0 bytes are no .safetensors")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        test_calibration()
        test_refusals()
        os.chdir("/")
    if failures:
        sys.exit(f"{len(failures)} failed")


if __name__ == "__main__":
    main()
