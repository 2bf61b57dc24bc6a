#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""calibrate.py TRIM3R: a machine is measured, and plans use its file."""
import json

from program import check, expect, expect_full, expect_json, in_scratch


def calibrated():
    told = expect_json("bench", "--calibrate", "--runs", 1, "-o", "machine.json")
    check(told["machine"] == "machine.json" and set(told["largest_errors"]) >= {"head", "refine"}, f"calibrated: {told}")
    with open("machine.json", encoding="utf-8") as file:
        prices = json.load(file)["picoseconds"]
    check(sum(price > 0 for price in prices.values()) > len(prices) / 2, f"prices: {prices}")
    expect_full("full.json", "bench", "--calibrate", "--runs", 1, "-o", "full.json")
    plan = ["plan", "--size", "128x128", "--keep", 10, "--machine", "machine.json"]
    found = expect_json(*plan)
    check(abs(sum(ms for stage, ms in found["stages_ms"].items() if stage != "raster") - found["build_ms"]) < 0.01,
          f"stages are no build: {found['stages_ms']}, {found['build_ms']}")
    check(found["build_ms"] > 0 and found["render_ms"] > 0, "nothing takes time")
    check(expect_json(*plan, "--refine", 16)["build_ms"] > found["build_ms"], "more passes take no longer")
    expect(0, *plan, out=" ms\n")
    expect(2, *plan, "--threads", 2, err="--threads 1")
    # a list's entry agrees with plan for that setting
    best = expect_json("plan", "--size", "128x128", "--arena", "4M", "--time", "9s", "--machine", "machine.json")["choices"][0]
    again = expect_json("plan", "--size", "128x128", "--gaussians", best["gaussians"], "--head", best["head"], "--refine",
                        best["refine"], "--machine", "machine.json")
    check(again["arena_bytes"] == best["arena_bytes"], f"the arena of {best} is of {again['arena_bytes']} bytes")
    check(abs(again["build_ms"] / best["build_ms"] - 1) < 0.25, f"the time of {best} is {again['build_ms']}")
    expect(3, "plan", "--arena", "4M", "--time", "1us", "--machine", "machine.json", err="the fastest build takes")


in_scratch(calibrated)
