#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""troubles.py TRIM3R: `trim3r trouble` on the built-in room, and `replay --stream` on what it writes: a bad frame is skipped for
its reason and ends nothing, the map is written, and five good keyframes later nothing is lost."""
import statistics

from program import check, expect, expect_json, in_scratch, room

FIRST, COUNT, GOOD, FRAMES = 8, 2, 5, 34
MOST_LOST = 0.3 # dB
BASE = ["--stream", "--every", 2, "--gaussians", 1500]
# a hand without depth is as unlike the map as one that covers it may be: likeness 81 and 66, and 80 is the bound
SKIPPED = {"hand": {"covered": 2}, "blind-hand": {"covered": 1, "contradicts": 1}, "black": {"dark": 2}, "dark": {"exposure": 2}, "gap": {}, "back": {},
           "flick": {"contradicts": 2}, "nan-pose": {"no pose": 2}, "absurd-pose": {"far": 2}, "no-depth": {"no depth": 2},
           "no-pose": {"no pose": 2}}


def live(found, least):
    """Returns {frame: dB} of the held-back frames from that one on, on the way."""
    return {h["frame"]: h["live_psnr"] for h in found["held_back"] if h["frame"] >= least and "live_psnr" in h}


def streamed(recording, *more):
    found = expect_json("replay", recording, *BASE, "-o", "map.ply", *more)
    check(expect_json("info", "map.ply")["scenes"][0]["gaussians"] == found["gaussians"] > 0, f"{recording}: no map")
    return found


def a_bad_frame_ends_nothing(recording, clean):
    for trouble, skipped in SKIPPED.items():
        expect(0, "trouble", recording, "--with", trouble, "--at", FIRST, "--for", COUNT, "-o", "bad.mcap")
        found = streamed("bad.mcap")
        check(found["skip_counts"] == skipped, f"{trouble}: {found['skip_counts']} is skipped instead of {skipped}")
        check(all(FIRST <= s["frame"] < FIRST + COUNT and s["decision"] in skipped for s in found["skipped"]),
              f"{trouble}: {found['skipped']}")
        shift = {"gap": COUNT, "back": -COUNT}.get(trouble, 0)
        after = live(found, FIRST + COUNT + 2 * GOOD)
        before = live(clean, 0)
        lost = statistics.fmean(before[frame + shift] - psnr for frame, psnr in after.items() if frame + shift in before)
        check(lost <= MOST_LOST, f"{trouble}: {lost:.2f} dB are lost on the way")


def a_jump_that_lasts(recording, clean):
    """The frames are refused until they are believed. The map then moves, or without alignment shows them alone."""
    expect(0, "trouble", recording, "--with", "jump", "--at", FIRST, "-o", "jump.mcap")
    found = streamed("jump.mcap")
    check(found["skip_counts"] == {"contradicts": 2}, f"a jump: {found['skip_counts']}")
    check([k["frame"] for k in found["keyframes"] if k["realigned"]] == [FIRST + 2], "a jump does not move the map")
    apart = streamed("jump.mcap", "--align", "off")
    check([k["frame"] for k in apart["keyframes"] if k["moved"]] == [FIRST + 4], "a jump begins no new piece")
    ghosts = streamed("jump.mcap", "--gate", "off")
    check(ghosts["skip_counts"] == {} and not any(k["moved"] for k in ghosts["keyframes"]), "without a gate frames are refused")
    late = FIRST + 4 + 2 * GOOD
    moved, new_piece, ghostly, steady = (statistics.fmean(live(f, late).values()) for f in (found, apart, ghosts, clean))
    check(moved >= steady - MOST_LOST, f"after a jump {steady - moved:.2f} dB are lost on the way")
    check(new_piece >= ghostly - MOST_LOST, "the jump costs more with the gate")


def frames_are_named(recording):
    for trouble, at, count, frames in (("hand", 6, 3, "frames 6 to 8"), ("gap", 6, 1, "frame 6"), ("jump", 6, 3, "from frame 6 on"),
                                       ("black", FRAMES - 3, 3, f"from frame {FRAMES - 3} on")):
        expect(0, "trouble", recording, "--with", trouble, "--at", at, "--for", count, "-o", "named.mcap", "--force",
               out=f"named.mcap: {trouble}, {frames}\n")


def exposure_is_measured(recording):
    for trouble in ("step", "ramp"):
        expect(0, "trouble", recording, "--with", trouble, "--at", FIRST, "--for", COUNT, "-o", "bright.mcap")
        found = streamed("bright.mcap")
        check(found["skip_counts"] == {}, f"{trouble}: {found['skip_counts']}")
        check(max(k["exposure_q8"] for k in found["keyframes"]) > 60, f"{trouble}: no step is measured")


def troubles():
    recording = room("64x64", frames=FRAMES)
    clean = streamed(recording)
    check(clean["skip_counts"] == {} and clean["skipped"] == [], f"honest frames are skipped: {clean['skipped']}")
    a_bad_frame_ends_nothing(recording, clean)
    a_jump_that_lasts(recording, clean)
    exposure_is_measured(recording)
    frames_are_named(recording)
    expect(0, "trouble", recording, "--with", "hand", "-o", "hand.mcap")
    expect(0, "replay", "hand.mcap", *BASE, out="skipped frames: covered 3")
    expect(2, "trouble", recording, "--with", "rain", "-o", "rain.mcap", err="--with does not know 'rain'")
    expect(2, "trouble", recording, "--with", "hand", "--at", 2, "-o", "hand.mcap", err="--for is at most --at")
    expect(2, "trouble", recording, "--with", "hand", err="is missing")
    expect(1, "trouble", recording, "--with", "hand", "--at", FRAMES, "-o", "hand.mcap", err="has no frame")


in_scratch(troubles)
