#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""replay.py TRIM3R: replays agree with the expectation, however they run, or report the first difference."""
import json

from program import check, expect, expect_json, in_scratch, room, write


def replay():
    recording = room()
    base = ["replay", recording, "--working", "64x64"]
    found = expect_json(*base)
    check(len(found.get("stages", {})) == 9 and len(found["tiles"]) == 16, "replay --json lacks stages or tiles")
    write("golden.json", json.dumps(found))
    for more in ([], ["--threads", 2], ["--arena", "min"], ["--arena", 30000000], ["--cpu-mask", 0],
                 ["--cpu-mask", 255]):
        expect(0, *base, "--expect", "golden.json", *more, out="as expected")
        expect(0, *base, "--expect", found["hash"], *more, out="as expected")
    check(expect_json(*base, "--expect", "golden.json")["match"] is True, "match is not told")

    expect(1, *base, "--expect", "0" * 16, err=found["hash"])
    expect(1, *base, "--expect", "golden.json", "--seed", 9, err="stage superclusters")
    expect(1, *base, "--expect", "golden.json", "--redundancy", "off", err="stage pointmap")
    expect(1, *base, "--expect", "golden.json", "--wavelet", "haar", err="stage wavelet")
    expect(1, *base, "--expect", "golden.json", "--context", "0,2", err="stage image")
    expect(1, *base, "--expect", "golden.json", "--head", "analytic", err="stage head")
    expect(1, *base, "--expect", "golden.json", "--head", "tiny", err="stage head")
    check(found["head"] == "small" and len(found["head_crc"]) == 8, "replay --json does not name the head")
    broken = dict(found, hash="1" * 16, stages=dict(found["stages"], raster="2" * 16), tiles=list(found["tiles"]))
    broken["tiles"][6] = "3" * 16
    write("broken.json", json.dumps(broken))
    expect(1, *base, "--expect", "broken.json", err="tile 6 (pixels from 32, 16)")
    expect(1, *base, "--expect", "absent.json", err="absent.json")
    for content in ("{", "[]", '{"hash": 5}', '{"hash": "xyz"}', json.dumps(dict(found, stages={"image": 1})),
                    json.dumps(dict(found, tiles=["x"]))):
        expect(1, *base, "--expect", write("malformed.json", content), err="malformed.json")
    for more in ([], ["--slide"], ["--stream", "--every", 1]):
        shown = expect(0, "replay", recording, "--working", "64x64", *more)
        check(max(map(len, shown.splitlines())) <= 80, f"replay {more}: lines of over 80 columns: {shown}")
    expect(2, "replay", err="REC.mcap")
    expect(2, "replay", recording, recording, err="too many")


in_scratch(replay)
