#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stream.py TRIM3R: `trim3r replay --stream`: keyframes, held-out views, the same bits every time."""
import json
import os

from program import check, expect, expect_json, in_scratch, room, run, write


def the_map_in_a_file(recording, base):
    """The written file is the final map: a held-out frame drawn from it equals the run's."""
    for name, least in (("map.ply", 60), ("map.spz", 30)):
        told = expect_json(*base, "--gaussians", 500, "-o", name)
        check(told["scene"] == name and expect_json("info", name)["scenes"][0]["gaussians"] == 500, f"{name} holds no 500 Gaussians")
        expect(0, "render", name, recording, "--view", 1, "--size", "64x64", "-o", "view.png")
        same = json.loads(run("diff", "view.png", "held/final_00001.png", "--json")[1])
        check(same["equal"] or same["psnr"] > least, f"{name} draws another view: {same['psnr']} dB")
    expect(0, *base, "--gaussians", 500, "-o", "map.ply", out="map.ply: 500 Gaussians")
    expect(2, *base, "-o", "map.txt", err="scenes are written as")
    expect(2, *base, "-o", recording, err="one file")
    expect(2, "replay", recording, "-o", "map.ply", err="--output belongs to --stream; trim3r build -o writes")


def rounds(recording):
    """Checks that keyframes shown again make the final map better, the same in every run, and with a budget as before."""
    base = ["replay", recording, "--working", "64x64", "--stream", "--every", 1, "--at-hand", 1, "--gaussians", 500]
    plain, again = expect_json(*base), expect_json(*base, "--rounds", 2)
    check(plain["keyframes"][-1]["hash"] == again["keyframes"][-1]["hash"], "rounds come after the last keyframe")
    check(plain["hash"] != again["hash"] and "rounds" not in plain and again["rounds"] == 2 and again["rounds_ms"] > 0, "told")
    check(plain["gaussians"] == again["gaussians"] == 500, "the map keeps its size")
    write("rounds.json", json.dumps(again))
    for more in (["--threads", 2], ["--arena", "min"], ["--cpu-mask", 0]):
        expect(0, *base, "--rounds", 2, "--expect", "rounds.json", *more, out="as expected")
    base[base.index("--every") + 1] = 2
    scores = [expect_json(*base, "--rounds", n)["final_psnr"] for n in (0, 1, 2)]
    check(scores[2] > scores[1] > scores[0] + 0.05, f"each round makes the map better: {scores}")
    expect(0, *base, "--rounds", 1, "-o", "rounds.ply", out="1 round over all keyframes")
    expect(2, *base, "--rounds", 17, err="--rounds takes")
    expect(2, *base, "--rounds", 1, "--state", "a.t3s", err="--rounds and --state exclude each other")
    expect(2, "replay", recording, "--rounds", 1, err="--rounds belongs to --stream")


def stream():
    recording = room()
    base = ["replay", recording, "--working", "64x64", "--stream", "--every", 2, "--at-hand", 2]
    found = expect_json(*base, "--gaussians", 500, "--images", "held")
    frames = expect_json("info", recording)["frames"]
    keyframes, held = found["keyframes"], found["held_back"]
    check([k["frame"] for k in keyframes] == list(range(0, frames, 2)), "every second frame is to be a keyframe")
    check([h["frame"] for h in held] == list(range(1, frames, 2)), "the others are to be held back")
    check(all(k["gaussians"] == 500 for k in keyframes) and found["gaussians"] == found["cap"] == 500, "no 500 Gaussians")
    check(keyframes[0]["shown"] == 0 < keyframes[1]["shown"] <= keyframes[1]["points"], "what the map shows is not told")
    check(all(k["added"] == k["removed"] + k["crowded"] for k in keyframes[1:]), "a full map is to stay full")
    check(found["live_psnr"] > 18 and found["final_psnr"] > 18, f"held-back views are poor: {found['live_psnr']}")
    check(all(os.path.exists(f"held/{what}_00001.png") for what in ("frame", "mask", "live", "final")), "no pictures")
    text = expect(0, *base, "--gaussians", 500)
    for when, name in (("drawn after the next keyframe", "live"), ("drawn from the final map", "final")):
        found_seen = (f"{found[f'{name}_psnr_seen']:.2f},", f"{100 * found[f'{name}_seen']:.0f}", "%")
        row = [f"{found[f'{name}_psnr']:.2f}", *found_seen, f"{found[f'{name}_psnr_all']:.2f}"]
        check(any(line.startswith(when) and line.split()[-5:] == row for line in text.splitlines()), f"no {when} {row}: {text}")
    check(all(0.5 < h.get("live_seen", h["final_seen"]) <= h["final_seen"] <= 1 for h in held), f"keyframes saw: {held}")
    check(found["final_psnr_seen"] > found["final_psnr"] - 0.1, "what keyframes saw is drawn worse than the rest")
    check(max(map(len, text.splitlines())) <= 80, f"a line of over 80 columns: {text}")
    the_map_in_a_file(recording, base)
    write("stream.json", json.dumps(found))
    base += ["--gaussians", 500]
    for more in ([], ["--threads", 2], ["--arena", "min"]):
        expect(0, *base, "--expect", "stream.json", *more, out="as expected")
        expect(0, *base, "--expect", found["hash"], *more, out="as expected")
    expect(1, *base, "--expect", "stream.json", "--wavelet", "haar", err="keyframe 0")
    expect(1, *base, "--expect", "stream.json", "--half-life", 1, err="keyframe 2")
    remembered = expect_json(*base[:-4], "--at-hand", 1, "--remember", 2, "--gaussians", 500)
    forgotten = expect_json(*base[:-4], "--at-hand", 1, "--gaussians", 500)
    check(remembered["keyframes"][1]["hash"] != forgotten["keyframes"][1]["hash"], "what is remembered changes nothing")
    check(remembered["arena_bytes"] == forgotten["arena_bytes"] + 2 * (64 * 64 * 2 + 128), "two bytes a pixel are remembered")
    write("remembered.json", json.dumps(remembered))
    for more in (["--threads", 2], ["--arena", "min"], ["--cpu-mask", 0]):
        expect(0, *base[:-4], "--at-hand", 1, "--remember", 2, "--gaussians", 500, "--expect", "remembered.json", *more, out="as expected")
    rounds(recording)
    expect(2, *base, "--remember", 17, err="--remember")
    expect(2, "replay", recording, "--remember", 2, err="--remember belongs to --stream")
    expect(1, *base, "--expect", "0" * 16, err=found["hash"])
    expect(0, "replay", recording, "--stream", "--keep", 2, "--working", "32x32", "--refine", 0, out="2 keyframes of 6 frames")
    turned = expect_json("replay", recording, "--working", "64x64", "--stream", "--every", 100, "--overlap", "90%",
                         "--gaussians", 500)
    check(0 == turned["keyframes"][0]["frame"] and 1 < len(turned["keyframes"]) < frames, "overlap chooses no keyframes")
    parts = {}
    for more in (["--refine-stride", 1], ["--refine-stride", 2], []):
        found = expect_json("replay", recording, "--working", "64x64", "--stream", "--gaussians", 200, *more)
        parts[str(more)] = found["hash"]
        spread = found["keyframe_ms"]
        check(0 < spread["median"] <= spread["most_95"] <= spread["worst"] and found["keyframes_per_s"] > 0, f"no latency: {spread}")
        check(all({"image", "refine"} < set(k["stages_ms"]) for k in found["keyframes"]), "keyframes lack the times of stages")
    whole, part, chosen = parts.values()
    check(whole != part == chosen, "with 20 pixels a Gaussian, passes compare a part of them")
    quick = expect_json("replay", recording, "--working", "64x64", "--stream", "--gaussians", 200, "--no-hash")
    check("hash" not in quick and "stages" not in quick and quick["final_psnr"] == found["final_psnr"], "--no-hash hashes, or changes views")
    expect(2, "replay", recording, "--stream", "--no-hash", "--expect", whole, err="--no-hash and --expect")
    expect(2, "replay", recording, "--refine-stride", 2, err="--refine-stride belongs to --stream")
    expect(2, "replay", recording, "--overlap", "80%", err="--overlap belongs to --stream")
    expect(2, "replay", recording, "--every", 2, err="--every belongs to --stream")
    expect(2, "replay", recording, "--stream", "--context", "0,1", err="--context")
    expect(2, "replay", recording, "--stream", "--auto", err="--auto")
    expect(2, *base, "--at-hand", 17, err="--at-hand")
    expect(1, *base, "--images", recording + "/absent", err="absent")


in_scratch(stream)
