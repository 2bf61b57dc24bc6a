#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""arena.py TRIM3R: the arena and threads change nothing but the time."""

from program import check, expect, expect_json, in_scratch, room


def arena():
    recording = room()
    expect(0, "build", recording, "--keep", 10, "-o", "scene.ply")
    base = ["build", recording, "--context", "0,2", "--gaussians", 5000, "--working", "64x64"]
    plan = expect_json("plan", "--size", "64x64", "--views", 2, "--gaussians", 5000)
    least, full = plan["min_bytes"], plan["arena_bytes"]
    expect(3, *base, "--arena", least - 1, "-o", "s.ply", err="too small")
    expect(3, *base, "--arena", 0, "-o", "s.ply", err=str(least))
    hashes, files = set(), set()
    for i, more in enumerate((["--arena", "min"], ["--arena", least], ["--arena", "full"], ["--arena", full * 10],
                              ["--threads", 2], ["--threads", 7, "--arena", "min"], ["--cpu-mask", 0])):
        name = f"arena{i}.ply"
        hashes.add(expect_json(*base, *more, "-o", name).get("hash"))
        files.add(open(name, "rb").read())
    check(len(hashes) == 1 and len(files) == 1, "arena or threads change the scene")

    few = ["build", recording, "--working", "64x64", "--gaussians", 100, "--refine", 0, "-o", "few.ply", "--force", "--head"]
    sizes = [expect_json(*few, head, "--arena", size)["arena_bytes"] for head in ("small", "analytic") for size in ("full", "min")]
    check(sizes[0] - sizes[1] > 50000 and sizes[2] == sizes[3], f"a full arena has room for packed layers where there are any: {sizes}")

    views = set()
    for more in (["--arena", "min"], ["--arena", "full"], ["--threads", 3]):
        views.add(expect_json("render", "scene.ply", recording, "--view", 1, "-o", "v.png", *more).get("hash"))
    check(len(views) == 1, "arena or threads change the view")
    expect(3, "render", "scene.ply", recording, "--view", 1, "--arena", 1000, "-o", "v.png", err="too small")


in_scratch(arena)
