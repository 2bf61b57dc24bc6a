#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bench.py TRIM3R: every figure of `trim3r bench`, and K-means of given points."""
import os
import struct

from program import TRIM3R, check, expect, expect_json, in_scratch, write


def points():
    corners = [[1000.0 + 3 * (i & 1), 2.0 * (i >> 1 & 1), -4.0 * (i >> 2 & 1), 0, 0.5, 1] for i in range(8)] * 50
    clustering = ["bench", "--runs", 1, "--stages", "kmeans_ms,texture_ns_per_pixel", "--points"]
    found = expect_json(*clustering, write("corners.f32", b"".join(struct.pack("<6f", *row) for row in corners)))
    check("kmeans_ms" in found and "texture_ns_per_pixel" in found and "stereo_ms" not in found, "bench --stages")
    check(found["kmeans_points"] == 400 and found["kmeans_msd"] < 1e-4,
          f"eight places need eight clusters: {found['kmeans_msd']}")
    # at any scale: dividing all by a power of two scales the distances exactly
    cloud = [[((i * (7919 + 2 * d)) % 4093) / 4093 for d in range(6)] for i in range(2000)]
    distance = {}
    for scale in (1.0, 2.0 ** -20, 2.0 ** 60):
        rows = b"".join(struct.pack("<6f", *[scale * v for v in row]) for row in cloud)
        found = expect_json(*clustering, write("cloud.f32", rows))
        distance[scale] = found["kmeans_msd"] / scale ** 2
    check(0 < distance[1.0] < 0.5 and max(distance.values()) <= 1.0001 * min(distance.values()), f"scales: {distance}")


def stages():
    found = expect_json("bench", "--runs", 1)
    check("stages" not in "".join(found), "bench tells stages that nobody asked for")
    profiled = expect_json("bench", "--runs", 1, "--stages", "build_analytic_ms,kmeans_ms", "--profile")
    parts = profiled["build_analytic_stages_ms"]
    check({"image", "head", "refine"} < set(parts) and min(parts.values()) > 0, f"the stages of a build: {parts}")
    check("kmeans_stages_ms" not in profiled, "a stage has no stages")
    for key in ("raster_131k_ms", "raster_13k_ms", "refine_ms", "kmeans_ms", "texture_ns_per_pixel", "build_analytic_ms",
                "build_unrefined_ms", "build_small_ms", "stereo_ms", "stereo_8_paths_ms", "head_gmac_per_s", "network_ms", "machine_gmac_per_s",
                "machine_copy_gb_per_s"):
        check(found[key] > 0 and found[key + "_min"] <= found[key] <= found[key + "_max"], f"bench lacks {key}")
    # each item's share of the whole
    for key, items in {"stereo": ("pixel", 131072), "build_small": ("pixel", 131072), "kmeans": ("point", 131072)}.items():
        each = found[f"{key}_ns_per_{items[0]}"] * items[1] / 1e6
        check(abs(each - found[key + "_ms"]) < 1e-6 * each, f"{key}: {each} ms and {found[key + '_ms']}")
    check(abs(found["head_ns_per_mac"] * found["head_gmac_per_s"] - 1) < 1e-6, "the head's two figures differ")
    check(found["head_gmac_per_s"] < found["machine_gmac_per_s"], "the head is faster than the machine")
    pairs = {key: found[f"{key}_ms"] * 1e6 / found[f"{key}_ns_per_pair"] for key in ("raster_131k", "raster_13k", "refine")}
    check(65536 < pairs["raster_13k"] < pairs["raster_131k"] < 65536 * 200 and pairs["refine"] > pairs["raster_13k"],
          f"blended pairs: {pairs}")
    matched = expect_json("bench", "--runs", 1, "--depth", "stereo", "--stages", "stereo_ms,build_analytic_ms,refine_ms")
    check(found["depth"] == "sensor" and matched["depth"] == "stereo", "bench tells the depth")
    check("kmeans_msd" in found and "kmeans_msd" not in matched, "nothing is told of clusters that were not made")
    check(matched["build_analytic_ms"] > matched["stereo_ms"] > 0 and matched["refine_ms"] > 0, "builds by stereo")
    check(found["head"] == "small" and found["head_bits"] == "8", "bench does not name the head")
    check(isinstance(found["cpu_flags"], str), "bench lacks cpu_flags")
    features = set(found["cpu_used"].split())
    check(set(found["kernels"].values()) <= features | {"c"}, f"kernels of what is not used: {found['kernels']}")
    plain = expect_json("bench", "--runs", 1, "--stages", "texture_ns_per_pixel", "--cpu-mask", "none")
    check(set(plain["kernels"].values()) <= {"c"}, f"kernels without features: {plain['kernels']}")
    check(plain["kernels"].keys() == found["kernels"].keys(), "kernels come and go")
    slow, fast = (expect_json("bench", "--runs", 3, "--stages", "machine_gmac_per_s", "--cpu-mask", mask)["machine_gmac_per_s"]
                  for mask in ("none", "all"))
    check(fast > (1.5 if "avx2" in features else 0.5) * slow, f"wider instructions give {fast}, plain ones {slow}")
    if "avx2" in features:
        check(found["kernels"]["blend"] != "c", f"blend has a variant: {found['kernels']}")


def script(name, text):
    with open(name, "w", encoding="utf-8") as file:
        file.write(f"#!/bin/sh\n{text}\n")
    os.chmod(name, 0o755)
    return f"./{name}"


def against():
    both = ["--stages", "texture_ns_per_pixel,kmeans_ms", "--runs", 1]
    found = expect_json("bench", "--against", TRIM3R, *both[:2], "--runs", 2)
    check(found["turns"] == 2 and sorted(found["stages"]) == ["kmeans_ms", "texture_ns_per_pixel"], f"{found}")
    for key, row in found["stages"].items():
        check(0.2 < row["ratio_min"] <= row["ratio"] <= row["ratio_max"] < 5, f"{key} against itself: {row}")
    check(found["this_alone"] == found["other_alone"] == "", "the same program lacks a stage")
    # half the speed, another name for a stage, and no --stages
    slow = script("slow", f'[ "$2" = --help ] && exec {TRIM3R} "$@" | sed s/--stages/--rows/\n'
                  f"""exec {TRIM3R} bench --json --runs=1 --stages=texture_ns_per_pixel,kmeans_ms | sed '
                  s/"kmeans_ms"/"means_ms"/; s/"texture_ns_per_pixel":/"texture_ns_per_pixel":1000/' """)
    found = expect_json("bench", "--against", slow, *both)
    check(found["this_alone"] == "kmeans_ms" and found["other_alone"] == "means_ms", f"{found}")
    check(found["stages"]["texture_ns_per_pixel"]["ratio_min"] > 50, "another's figure was not taken")
    shown = expect(0, "bench", "--against", slow, *both, out="the other has no kmeans_ms")
    check("this one has no means_ms" in shown and "times as fast" in shown, shown)


def against_what_is_no_trim3r():
    line = ["bench", "--runs", 1, "--stages", "kmeans_ms", "--against"]
    expect(1, *line, "absent", err="absent: No such file")
    expect(1, *line, write("plain", "text"), err="plain: Permission denied")
    for text in ("exit 0", "exit 3", "cat", "echo kmeans"):
        expect(1, *line, script("other", text), err="./other: not a trim3r")
    helps = f'[ "$2" = --help ] && exec {TRIM3R} "$@"\n'
    expect(1, *line, script("other", helps + "exit 4"), err="./other: its bench --json ended with exit status 4")
    expect(1, *line, script("other", helps + "echo none"), err="./other: its bench --json prints no JSON object")
    expect(1, *line, script("other", helps + "echo '{}'"), err="it has none of the stages: kmeans_ms")


in_scratch(points, stages, against, against_what_is_no_trim3r)
