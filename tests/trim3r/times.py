#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""times.py TRIM3R: each kind of work has its own time, and their sum is at most the command's time."""
import re
import time

from program import check, expect, expect_json, in_scratch, room

KINDS = ("read_ms", "pose_ms", "build_ms", "render_ms", "write_ms")


def times_of(kinds, count, *command):
    """Returns the times in ms, which must be of exactly these kinds, and their share of the elapsed time; drawing
    and writing count for `count` views."""
    start = time.monotonic()
    found = expect_json(*command)
    elapsed = (time.monotonic() - start) * 1e3
    there = {kind: found[kind] for kind in KINDS if isinstance(found.get(kind), (int, float))}
    check(sorted(there) == sorted(kinds) and all(ms > 0 for ms in there.values()), f"{command[0]}: {there}")
    spent = sum(ms * (count if kind in ("render_ms", "write_ms") else 1) for kind, ms in there.items())
    check(spent <= elapsed, f"{command[0]}: {there} are more than {elapsed:.1f} ms")
    return there, spent / elapsed


def words(text):
    return re.findall(r"\b(read|poses|build|render|write) [0-9.]+ ms", text)


def kinds_are_apart():
    recording = room("256x256")
    build = ["build", recording, "--keep", 10, "-o", "scene.ply"]
    times_of(("read_ms", "build_ms", "write_ms"), 1, *build)
    times_of(("read_ms", "pose_ms", "build_ms", "write_ms"), 1, *build, "--poses", "estimate")
    times_of(("read_ms", "build_ms", "render_ms"), 1, "replay", recording)
    check(words(expect(0, *build)) == ["read", "build", "write"], "the text of build")
    check(words(expect(0, "replay", recording)) == ["read", "build", "render"], "the text of replay")


def most_of_a_large_picture_is_its_file():
    expect(0, "build", room(), "--keep", 1, "--head", "analytic", "--refine", 0, "-o", "few.ply")
    view = ["render", "few.ply", "room.mcap", "--view", 1, "--size", "2048x2048", "-o", "view.png"]
    kinds = ("read_ms", "render_ms", "write_ms")
    large, share = times_of(kinds, 1, *view, "--depth", "depth.png", "--alpha", "alpha.png")
    check(large["write_ms"] > large["render_ms"], f"three files of 2048x2048 take less than drawing: {large}")
    check(share > 0.5, f"only {share:.2f} of the command's time is named")
    shown = expect(0, *view)
    check(words(shown) == ["read", "render", "write"] and " a view" not in shown, f"the text of render: {shown}")
    with open("path.txt", "w", encoding="utf-8") as file:
        file.writelines(f"{i} {0.01 * i} 0 0 0 0 0 1\n" for i in range(5))
    path = ["render", "few.ply", "--trajectory", "path.txt", "--fov", 60, "--size", "512x512", "-o", "v.png"]
    times_of(kinds, 5, *path)
    check(" a view" in expect(0, *path), "times of several views are of each")


def a_live_recording_is_apart_from_its_builds():
    line = ["capture", "--source", f"replay:{room()}", "--quiet", "-o", "copy.mcap", "--build", "live.ply", "--context", "0,2"]
    found = expect_json(*line)
    for kind in ("record_ms", "build_ms", "write_ms", "frame_ms"):
        times = found[kind]
        check(0 < times["median"] <= times["most_95"] <= times["worst"] and 0 < times["mean"] <= times["worst"], f"{kind}: {times}")
    check(found["record_ms"]["mean"] <= found["frame_ms"]["mean"], "recording takes longer than a frame")
    check("recorded: " in expect(0, *line, "--force") , "the text of capture")


STAGES = ["image", "depth", "pointmap", "wavelet", "superclusters", "budget", "head", "refine"]


def table_of(text):
    """Returns {stage: ms} of a printed table."""
    return {name: float(ms) for name, ms in re.findall(r"^(\w+) +([0-9.]+) +[0-9.]+$", text, flags=re.M)}


def a_build_has_its_stages():
    build = ["build", room("96x96"), "--keep", 10, "-o", "scene.ply", "--profile"]
    found = expect_json(*build)["stages_ms"]
    check(list(found) == STAGES and min(found.values()) > 0, f"build: {found}")
    for line in (build, ["bench", "--runs", 1, "--stages", "build_analytic_ms", "--profile"]):
        table = table_of(expect(0, *line))
        check([*STAGES, "all"] == list(table), f"{line[0]}: {table}")
        check(abs(sum(table[stage] for stage in STAGES) - table["all"]) < 0.1, f"{line[0]}: {table}")


in_scratch(kinds_are_apart, most_of_a_large_picture_is_its_file, a_live_recording_is_apart_from_its_builds,
                    a_build_has_its_stages)
