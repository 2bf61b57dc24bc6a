#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""heads.py TRIM3R: `--head`: each gives another scene and is named; refused weights give a reason. `--preset`."""
import json
import os
import struct

from program import HEADS, check, expect, expect_json, in_scratch, room, weight_file, write


def heads():
    recording = room()
    expect(0, "room", "--size", "32x32", "-o", "tiny.mcap")
    whole = weight_file("mine.t3w")
    weight_file("wide.t3w", "16")
    base = ["build", recording, "--working", "64x64", "--gaussians", 500, "-o", "head.ply"]
    hashes = {}
    for head in ("analytic", "none", "tiny", "small", "mine.t3w", "wide.t3w"):
        found = expect_json(*base, "--head", head, "--comments")
        hashes[head] = found["hash"]
        name = head.split(".")[0]
        check(found["head"] == name, f"--head {head}: build names {found['head']}")
        comment = f"comment trim3r head {name}"
        if "head_crc" in found:
            comment += f" crc {found['head_crc']}"
            check(found["head_bits"] == ("16" if head == "wide.t3w" else "8"), f"--head {head}: bits")
        check((comment + "\n").encode() in open("head.ply", "rb").read(), f"--head {head}: not in the comments")
        check(("head_crc" in found) == (head not in ("analytic", "none")), f"--head {head}: CRC")
    check(len(set(hashes.values())) == len(hashes), f"heads give the same scene: {hashes}")
    crc = expect_json(*base, "--head", "mine.t3w")["head_crc"]
    check(crc == expect_json("head-info", "mine.t3w")["crc"] == whole[15:11:-1].hex(), "the CRC")
    # the closed forms use no weights; networks give the same bits for any arena and number of threads
    check(len({expect_json(*base, "--head", "wide.t3w", "--arena", arena, "--threads", threads)["hash"]
               for arena, threads in (("min", 1), ("full", 3))}) == 1, "arena or threads change a learned scene")
    # weights that are refused say why
    for name, content, why in [("cut.t3w", whole[:-4], "not as long as it says"), ("foreign.t3w", b"RIFF" + whole[4:], "not a weight file"),
                               ("empty.t3w", b"", "not a weight file"), ("bit.t3w", whole[:-1] + bytes([whole[-1] ^ 1]), "CRC"),
                               ("epoch.t3w", whole[:6] + b"\xff\xff" + whole[8:], "epoch")]:
        write(name, content)
        for command in (base, ["replay", recording], ["plan", "--size", "64x64", "--gaussians", 5], ["bench", "--runs", 1]):
            expect(1, *command, "--head", name, err=name)
        expect(1, *base, "--head", name, err=why)
    expect(1, *base, "--head", "absent.t3w", err="absent.t3w")


def haze_head(path):
    """Makes the float head small with a last layer that gives the same everywhere: faint, and 16 spacings wide."""
    raw = bytearray(open(os.path.join(HEADS, "small.safetensors"), "rb").read())
    data = 8 + struct.unpack("<Q", raw[:8])[0]
    tensors = json.loads(raw[8:data])
    for name, values in {"layer12.weight": [0] * 180, "layer12.bias": [0, 0, 4, 4, 0, 0.02, 0, 0, 0]}.items():
        begin, end = tensors[name]["data_offsets"]
        raw[data + begin : data + end] = struct.pack(f"<{len(values)}f", *values)
    write(path, bytes(raw))


def a_head_that_makes_haze_is_named():
    recording = room()
    expect(0, "room", "--size", "32x32", "-o", "tiny.mcap")
    haze_head("haze.safetensors")
    expect(0, "quantize", "haze.safetensors", "--calibrate", "tiny.mcap", "--name", "haze", "-o", "haze.t3w")
    base = ["build", recording, "--keep", 20, "-o", "head.ply"]
    usual, haze = (expect_json(*base, "--head", head)["tile_lists"] for head in ("small", "haze.t3w"))
    check(0 < usual["entries"] <= usual["usual"] and usual["widest"] > 0, f"the head small is taken for haze: {usual}")
    check(haze["entries"] > haze["usual"] and haze["widest"] == 16, f"haze is not seen: {haze}")
    check("warning" not in expect(0, *base, "--head", "small"), "a warning without a reason")
    expect(0, *base, "--head", "haze.t3w", out="unusually wide")
    few = [*base, "--head", "haze.t3w", "--tile-splats", 40]
    check(expect_json(*few)["tile_lists"]["entries"] == 16 * 40, "--tile-splats leaves more than it draws")
    check("warning" not in expect(0, *few), "a warning of what --tile-splats has cut off")


def presets():
    recording = room()
    base = ["build", recording, "--working", "64x64", "--keep", 2, "-o", "preset.ply"]
    hashes = {}
    for preset, head, passes, structural in (("fast", "tiny", 2, "off"), ("balanced", "small", 8, "off"), ("best", "small", 32, "on")):
        same = ["--head", head, "--refine", passes, "--fit-passes", "on", "--structural", structural]
        hashes[preset] = expect_json(*base, "--preset", preset)["hash"]
        check(hashes[preset] == expect_json(*base, *same)["hash"], f"--preset {preset} is not {same}")
        planned = ["plan", "--size", "64x64", "--keep", 20]
        check(expect_json(*planned, "--preset", preset) == expect_json(*planned, *same), f"plan --preset {preset} is not {same}")
    check(len(set(hashes.values())) == len(hashes), f"presets give the same scene: {hashes}")
    check(expect_json(*base, "--preset", "fast", "--head", "small")["head"] == "small", "--head after --preset replaces the head")
    for command in (base, ["plan", "--size", "64x64", "--keep", 20]):
        expect(2, *command, "--preset", "quick", err="--preset does not know 'quick'; there are fast, balanced, best")


in_scratch(heads, presets, a_head_that_makes_haze_is_named)
