#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""live.py TRIM3R: what `replay --stream` writes on the way: lines of JSON, snapshots, the state after kill -9, rows in a
pipe; and what ends it early: --until, --max-ms."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

from program import TRIM3R, check, expect, expect_json, in_scratch, room, run, write

FRAMES = 40
STREAM = ("replay", "room.mcap", "--stream", "--every", 2, "--gaussians", 400, "--working", "64x64")


def lines_of(path):
    with open(path) as file:
        return [json.loads(line) for line in file]


def without_times(rows):
    return [{key: value for key, value in row.items() if key not in ("ms", "psnr_before", "stages_ms")} for row in rows]


def lines():
    """A line a keyframe with the fields that help lists; they equal the report's, and change no hash."""
    plain = expect_json(*STREAM)
    found = expect_json(*STREAM, "--lines", "a.jsonl")
    check(found["hash"] == plain["hash"], "the hash does not depend on lines")
    rows = lines_of("a.jsonl")
    check(rows == found["keyframes"], "lines are the rows of the report")
    check(without_times(rows) == without_times(plain["keyframes"]), "and those of a run without lines")
    help_text = expect(0, "replay", "--help").split("Fields of --lines")[1]
    listed = re.findall(r"^  (\w+) +\S", help_text, flags=re.M)
    check(list(rows[0]) == listed[:len(rows[0])], f"help lists the fields: {listed}")
    check([row["keyframe"] for row in rows] == list(range(1, FRAMES // 2 + 1)), "keyframes are counted")
    check([row["frame"] for row in rows] == list(range(0, FRAMES, 2)), "frames are named")
    check(all(a["stamp_ns"] < b["stamp_ns"] for a, b in zip(rows, rows[1:])), "time goes on")
    check(all(row["decision"] == "taken" and row["passes"] == row["passes_planned"] == 4 for row in rows), "all are taken")
    check(rows[0]["psnr_before"] is None and all(18 < row["psnr_before"] < 60 for row in rows[1:]), "the map is scored")
    check(len({tuple(row["position"]) for row in rows}) > 9, "the camera moves")
    check(all(abs(sum(q * q for q in row["rotation"]) - 1) < 1e-6 for row in rows), "rotations are unit quaternions")
    printed = expect(0, *STREAM, "--lines", "-").splitlines()
    check(without_times(map(json.loads, printed)) == without_times(rows), "nothing but lines on stdout")
    *printed, report = expect(0, *STREAM, "--lines", "-", "--json").splitlines()
    check(len(printed) == len(rows) and json.loads(report)["hash"] == plain["hash"], "with --json the report is the last")
    times = rows[1]["stages_ms"]
    check(len(times) > 6 and 0 < sum(times.values()) < 1.5 * rows[1]["ms"] + 1, f"times of stages: {times}")
    bare = expect_json(*STREAM, "--no-hash")
    check("hash" not in bare and bare["keyframes"][1]["hash"] is None and bare["keyframes"][1]["stages_ms"] == {}, "--no-hash")
    expect(2, *STREAM, "--no-hash", "--expect", "0" * 16, err="exclude each other")
    expect(2, "replay", "room.mcap", "--no-hash", err="--no-hash belongs to --stream")
    expect(2, *STREAM, "--lines", write("table.csv", "a,b\n1,2\n"), err="a table")


def snapshots():
    """The map file is whole whenever it is looked at, and grows with the run."""
    process = subprocess.Popen([TRIM3R, *map(str, STREAM), "--snapshot", "1", "-o", "map.spz"], stdout=subprocess.DEVNULL)
    seen = 0
    while process.poll() is None:
        if os.path.exists("map.spz"):
            expect(0, "info", "map.spz")
            seen += 1
    check(process.returncode == 0 and seen > 1, f"{seen} looks at the map")
    check(not [name for name in os.listdir(".") if name.endswith(".part")], "no part remains")
    expect(2, *STREAM, "--snapshot", 3, err="--snapshot writes")


def killed():
    """Killed between snapshots and started again, a run ends with the same bits, lines and map."""
    whole = expect_json(*STREAM, "-o", "whole.ply", "--lines", "whole.jsonl")
    saved = (*STREAM, "-o", "map.ply", "--lines", "some.jsonl", "--state", "room.t3s", "--resume", "--snapshot", 3)
    times = 0
    while True:
        process = subprocess.Popen([TRIM3R, *map(str, saved), "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        before = len(lines_of("some.jsonl")) if os.path.exists("some.jsonl") and times else 0
        while process.poll() is None and (not os.path.exists("some.jsonl") or count_lines("some.jsonl") < before + 5):
            time.sleep(0.001)
        process.send_signal(signal.SIGKILL)
        printed, said = process.communicate()
        if process.returncode == 0:
            break
        times += 1
        check(os.path.exists("room.t3s"), "a state was written before it was killed")
    check(times > 1, f"it was killed {times} times")
    found = json.loads(printed)
    check("continues at frame" in said and found["resumed_at"] > 0, f"it says where it continues: {said}")
    for key in ("hash", "stages", "live_psnr", "final_psnr", "held_back", "gaussians"):
        check(found[key] == whole[key], f"{key} as in one run: {found[key]}, {whole[key]}")
    check(without_times(found["keyframes"]) == without_times(whole["keyframes"]), "keyframes as in one run")
    check(without_times(lines_of("some.jsonl")) == without_times(lines_of("whole.jsonl")), "no line is missing or twice")
    with open("map.ply", "rb") as one, open("whole.ply", "rb") as other:
        check(one.read() == other.read(), "the same map")


def count_lines(path):
    with open(path, "rb") as file:
        return file.read().count(b"\n")


def forged_state():
    """A state with the arena of a stream of fewer workers, whose hash agrees, is refused: threads would write beyond it."""
    arena = 1 << 20
    for threads in (1, 2):
        expect(0, *STREAM, "--until", 3, "--arena", "1M", "--threads", threads, "--state", f"of{threads}.t3s")
    one, two = (pathlib.Path(f"of{threads}.t3s").read_bytes() for threads in (1, 2))
    at = one.index(b"tm3r")
    check(at == two.index(b"tm3r") and one[:at] != two[:at] and len(one) >= at + arena, "blind: no arena")
    forged, value = two[:at] + one[at:at + arena] + two[at + arena:-8], 0xcbf29ce484222325
    for byte in forged: # FNV-1a
        value = (value ^ byte) * 0x100000001b3 & (1 << 64) - 1
    pathlib.Path("forged.t3s").write_bytes(forged + value.to_bytes(8, sys.byteorder))
    expect(1, *STREAM, "--arena", "1M", "--threads", 2, "--state", "forged.t3s", "--resume", err="forged.t3s: its arena has other settings")


def refused_states():
    """A state of other settings, another recording or another file is refused, and one that is cut or changed."""
    expect(0, *STREAM, "--until", 9, "--state", "some.t3s")
    more = ("--state", "some.t3s", "--resume")
    expect(1, *STREAM, *more, "--half-life", 7, err="--half-life 32")
    expect(1, *STREAM, *more, "--every", 3, err="another --every")
    expect(1, *STREAM, *more, "--head", "tiny", err="another --head")
    expect(1, *STREAM, *more, "--gaussians", 401, err="or budget")
    expect(0, "room", "--size", "64x64", "--frames", FRAMES, "--seed", 5, "-o", "other.mcap")
    expect(1, "replay", "other.mcap", *STREAM[2:], *more, err="another recording")
    with open("some.t3s", "rb") as file:
        whole = file.read()
    for broken in (whole[:-1], whole[:500], whole[:9000] + bytes([whole[9000] ^ 1]) + whole[9001:], whole[:8]):
        write("broken.t3s", broken)
        expect(1, *STREAM, "--state", "broken.t3s", "--resume", err="broken.t3s: ")
    forged_state()
    expect(2, *STREAM, "--resume", err="--resume needs --state")
    expect(2, *STREAM, "--state", "room.mcap", err="one file")
    again = expect_json(*STREAM, *more)
    check(again["hash"] == expect_json(*STREAM)["hash"] and again["resumed_at"] == 10, "after --until it continues")
    expect(0, *STREAM, "--until", 9, "--state", "lines.t3s", "--lines", "gap.jsonl")
    expect(1, *STREAM, "--state", "lines.t3s", "--resume", err="written with --lines")
    write("gap.jsonl", "")
    expect(1, *STREAM, "--state", "lines.t3s", "--resume", "--lines", "gap.jsonl", err="gap.jsonl: lacks lines")
    longer = expect_json(*STREAM, "--state", "none.t3s", "--resume", "--until", 3)
    check("resumed_at" not in longer, "without a state it begins at the start")


def until():
    by_frame = expect_json(*STREAM, "--until", 9)
    check([row["frame"] for row in by_frame["keyframes"]] == [0, 2, 4, 6, 8] and by_frame["held_back"][-1]["frame"] == 9,
          "frame 9 is the last")
    first, last = by_frame["keyframes"][0]["stamp_ns"], by_frame["keyframes"][4]["stamp_ns"]
    by_time = expect_json(*STREAM, "--until", f"{(last - first) / 1e6 + 1}ms")
    check([row["frame"] for row in by_time["keyframes"]] == [0, 2, 4, 6, 8], "until a time")
    expect(2, *STREAM, "--until", "soon", err="--until takes a time")
    expect(2, "replay", "room.mcap", "--until", 9, err="--until belongs to --stream")


def budget():
    """Passes are left out until keyframes fit; nothing is compared with other runs."""
    slow = (*STREAM, "--refine", 16, "--fit-passes", "off")
    free = expect_json(*slow)
    check(free["comparable"] and free["passes"] == free["passes_planned"] == 16 * FRAMES // 2, "all passes")
    unrefined = expect_json(*STREAM, "--refine", 0)["keyframe_ms"]["median"]
    most = unrefined + (free["keyframe_ms"]["median"] - unrefined) / 3
    hurried = expect_json(*slow, "--max-ms", f"{most:.3f}", "--lines", "b.jsonl")
    check(not hurried["comparable"] and "hash" not in hurried and "stages" not in hurried, "hashes are not comparable")
    check(hurried["max_ms"] == float(f"{most:.3f}"), "the budget is in the report")
    rows = lines_of("b.jsonl")
    check(all(row["hash"] is None and row["passes"] <= row["passes_planned"] == 16 for row in rows), "passes of each")
    check(0 < hurried["passes"] == sum(row["passes"] for row in rows) < free["passes"], f"fewer passes: {hurried['passes']}")
    expect(0, *slow, "--max-ms", 1, out="no hashes, as each run gives other bits")
    expect(2, *STREAM, "--max-ms", 5, "--expect", "0" * 16, err="--expect has nothing to compare")
    expect(2, *STREAM, "--max-ms", 0, err="--max-ms")


def rows_in_a_pipe():
    """The table's rows appear in a pipe as they are made, not all at the end."""
    with subprocess.Popen([TRIM3R, *map(str, STREAM), "--refine", "16", "--fit-passes", "off"], stdout=subprocess.PIPE) as process:
        first = [os.read(process.stdout.fileno(), 1 << 16).decode()]
        while "taken" not in first[-1]:
            first.append(os.read(process.stdout.fileno(), 1 << 16).decode())
        check(sum(part.count("taken") for part in first) < FRAMES // 4, f"rows come one by one: {first}")
        process.stdout.read()
    check(process.returncode == 0, "and it ends well")


def walk():
    room(frames=FRAMES)


in_scratch(walk, lines, snapshots, killed, refused_states, until, budget, rows_in_a_pipe)
