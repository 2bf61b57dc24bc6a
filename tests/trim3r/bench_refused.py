#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bench_refused.py TRIM3R: what `trim3r bench` refuses before it measures anything."""
import struct
import sys

from program import expect, in_scratch, write


def refused():
    for option, values in {"--runs": ["0", "102", "x"], "--threads": ["0", "x"]}.items():
        for value in values:
            expect(2, "bench", f"{option}={value}", err=option)
    expect(2, "bench", "more", err="too many")
    expect(2, "bench", "--stages", "kmeans_ms,kmeans", err="'kmeans'")
    expect(2, "bench", "--stages", "", err="--stages")
    expect(1, "bench", "--runs", 1, "--points", "absent.f32", err="absent.f32")
    expect(1, "bench", "--runs", 1, "--points", write("odd.f32", b"\0" * 25), err="25 bytes")
    expect(1, "bench", "--runs", 1, "--points", write("nan.f32", struct.pack("<6f", *[float("nan")] * 6)), err="byte 0")
    expect(2, "bench", "--depth", "laser", err="--depth")
    expect(2, "bench", "--head", "analytic", err="--head analytic")
    expect(2, "bench", "--head", "large", err="--head")
    expect(2, "bench", "--calibrate", err="belong together")
    expect(2, "bench", "-o", "machine.json", err="belong together")
    expect(2, "bench", "--profile", "--against", sys.argv[1], err="--profile")
    expect(2, "bench", "--calibrate", "-o", "machine.json", "--against", sys.argv[1], err="exclude")


in_scratch(refused)
