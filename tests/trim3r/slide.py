#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""slide.py TRIM3R: `trim3r replay --slide`: a scene at every frame, warm or not; the same bits every time."""
import json

from program import check, expect, expect_json, in_scratch, room, write


def slide():
    recording = room()
    frames = expect_json("info", recording)["frames"]
    base = ["replay", recording, "--working", "64x64", "--slide", "--gaussians", 500]
    hashes = {}
    for warm in ("off", "on"):
        found = expect_json(*base, "--warm", warm)
        hashes[warm] = found["hash"]
        check(found["scenes"] == frames - 1 and found["gaussians"] == 500, f"warm {warm}: {found}")
        check(found["warm"] == (warm == "on") and found["frames_per_second"] > 0, f"warm {warm} is not told")
        write(f"{warm}.json", json.dumps(found))
        for more in (["--threads", 2], ["--arena", "min"], ["--cpu-mask", "none"]):
            expect(0, *base, "--warm", warm, "--expect", f"{warm}.json", *more, out="as expected")
    check(hashes["on"] != hashes["off"], "warm builds take nothing over")
    expect(1, *base, "--expect", "on.json", err="stage")
    expect(2, *base, "--stream", err="--slide")
    expect(2, *base, "--context", "0,1", err="--slide")
    expect(0, "replay", recording, "--slide", "--keep", 5, "--working", "32x32", "--refine", 0, out="frames a second")
    expect(2, *base, "--warm", "on", "--depth", "stereo", err="warm")


def large():
    """Plans, builds and draws pictures of usual sizes."""
    for size in ("640x480", "1280x720"):
        width, height = map(int, size.split("x"))
        recording = room(size, f"room-{size}.mcap", frames=2)
        plan = expect_json("plan", "--size", size, "--gaussians", 5000)
        check(plan["width"] == width and plan["height"] == height and plan["min_bytes"] > width * height * 12, "plan")
        build = ["build", recording, "--context", "0,1", "--gaussians", 5000, "--head", "analytic", "--refine", 1]
        found = expect_json(*build, "--clusters", 20, "--arena", "min", "-o", f"{size}.ply")
        check(found["gaussians"] == 5000 and found["arena_bytes"] >= plan["min_bytes"] / 2, f"{size}: {found}")
        expect(0, "render", f"{size}.ply", recording, "--view", 1, "-o", f"{size}.png", out="1 view")


in_scratch(slide, large)
