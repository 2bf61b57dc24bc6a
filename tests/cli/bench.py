#!/usr/bin/env python3
"""bench.py TRIM3R: every figure of `trim3r bench`, and K-means of points that are given."""
import struct
import sys

from program import check, expect_json, in_scratch, write


def points():
    corners = [[1000.0 + 3 * (i & 1), 2.0 * (i >> 1 & 1), -4.0 * (i >> 2 & 1), 0, 0.5, 1] for i in range(8)] * 50
    clustering = ["bench", "--runs", 1, "--stages", "kmeans_ms,texture_ns_per_pixel", "--points"]
    found = expect_json(*clustering, write("corners.f32", b"".join(struct.pack("<6f", *row) for row in corners)))
    check("kmeans_ms" in found and "texture_ns_per_pixel" in found and "stereo_ms" not in found, "bench --stages")
    check(found["kmeans_points"] == 400 and found["kmeans_msd"] < 1e-4,
          f"eight places need eight clusters: {found['kmeans_msd']}")
    # any scale: a power of two less changes the distances by just that
    cloud = [[((i * (7919 + 2 * d)) % 4093) / 4093 for d in range(6)] for i in range(2000)]
    distance = {}
    for scale in (1.0, 2.0 ** -20, 2.0 ** 60):
        rows = b"".join(struct.pack("<6f", *[scale * v for v in row]) for row in cloud)
        found = expect_json(*clustering, write("cloud.f32", rows))
        distance[scale] = found["kmeans_msd"] / scale ** 2
    check(0 < distance[1.0] < 0.5 and max(distance.values()) <= 1.0001 * min(distance.values()), f"scales: {distance}")


def stages():
    found = expect_json("bench", "--runs", 1)
    for key in ("raster_131k_ms", "raster_13k_ms", "refine_ms", "kmeans_ms", "texture_ns_per_pixel", "build_analytic_ms",
                "build_small_ms", "stereo_ms", "stereo_8_paths_ms", "head_gmac_per_s"):
        check(found[key] > 0 and found[key + "_min"] <= found[key] <= found[key + "_max"], f"bench lacks {key}")
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
    if "avx2" in features:
        check(found["kernels"]["blend"] != "c", f"blend has a variant: {found['kernels']}")


sys.exit(in_scratch(points, stages))
