#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""commands.py TRIM3R: common behaviour of all commands: help, unknown options, tables, counts, a full disk."""
import re
import subprocess

from program import TRIM3R, check, expect, expect_json, fill_disk, in_scratch, room


COMMANDS = ["import", "room", "info", "build", "render", "view", "eval", "replay", "diff", "plan", "bench", "head-info"]
STUDY = ["stress", "quantize"]


def every_command():
    expect(2)
    expect(2, "paint", err="paint")
    expect(0, "--version", out="bits epoch")
    summary = expect(0, "--help", out="COMMAND")
    for command in COMMANDS + (STUDY if "\nStudy:\n" in summary else []):
        check(f"\n  {command} " in summary, f"--help does not list {command}")
        text = expect(0, command, "--help", out="trim3r " + command)
        check("Example" in text, f"{command} --help has no examples")
        check(all(len(line) < 80 for line in text.splitlines()), f"{command} --help is wider than 79 columns")
        check("--json" in text, f"{command} has no --json")
        check(expect(0, "help", command) == text, f"help {command} is not {command} --help")
        expect(2, command, "--no-such-option", err="no-such-option")
    # a result that cannot be printed is an error
    with open("out.txt", "w") as out:
        done = subprocess.run([TRIM3R, "plan", "--size", "64x64", "--gaussians", "5"], stdout=out, text=True,
                              stderr=subprocess.PIPE, preexec_fn=fill_disk, restore_signals=False)
    check(done.returncode == 1 and "standard output: " in done.stderr, f"plan to a full disk: {done.returncode}")


def tables_fit():
    """Reports have at most 80 columns, and eval shows more by --wide, or where rows need more to tell them apart."""
    room()
    expect(0, "build", "room.mcap", "--keep", 10, "-o", "scene.ply")
    score = ["eval", "room.mcap", "--working", "32x32", "--keep", "20,5"]
    expect(0, *score, "--csv", "scores.csv")
    lines = (["--help"], ["info", "room.mcap", "room.mcap"], ["info", "scene.ply", "scene.ply"], score,
             ["plan", "--size", "640x480", "--gaussians", "1M"], ["plan", "--size", "96x96", "--arena", "1M"],
             ["build", "room.mcap", "--keep", 10, "-o", "fits.ply"], ["scene", "room.mcap", "-o", "fits.ply"],
             ["render", "scene.ply", "room.mcap", "--view", 1, "-o", "fits.png"],
             ["render", "scene.ply", "--orbit", 3, "--size", "64x64", "-o", "fits.png"],
             ["convert", "scene.ply", "--min-opacity", 0.5, "-o", "fits.spz"], ["diff", "scene.ply", "scene.ply"],
             ["room", "--size", "64x64", "-o", "fits.mcap"], ["import", "room.mcap", "-o", "a recording of a longer name.mcap"],
             ["view", "scene.ply", "-o", "fits.html"], ["replay", "room.mcap"], ["replay", "room.mcap", "--stream", "--gaussians", 500],
             ["chart", "scores.csv", "-o", "fits-chart.html"])
    commands = set(re.findall(r"^  ([a-z-]+) +[a-z]", expect(0, "--help").split("Data flow")[0], re.MULTILINE))
    for line in lines:
        if line[0] in commands | {"--help"}:  # a product has no chart
            text = expect(0, *line)
            check(max(map(len, text.splitlines()), default=0) <= 80, f"{line}: wider than 80: {text}")
    # doctor and stress have tests of their own; completion prints a script
    others = {"capture", "bench", "doctor", "head-info", "completion", "stress", "trouble", "quantize"}
    check(commands - {line[0] for line in lines} <= others, f"whose reports are not looked at: {commands - {line[0] for line in lines} - others}")
    narrow, wide = expect(0, *score).splitlines()[0].split(), expect(0, *score, "--wide").splitlines()[0].split()
    check(set(narrow) < set(wide) and {"psnr", "ssim", "gaussians"} <= set(narrow), f"{narrow}, {wide}")
    check(expect(0, *score, "--heads", "small,analytic").splitlines()[0].split() == wide, "rows of two heads look alike")


def several_files():
    one = expect_json("info", "room.mcap")
    found = expect_json("info", "room.mcap", "room.mcap")
    check(found == {"files": [{"file": "room.mcap", **one}] * 2}, f"{found}")
    check(expect(0, "info", "room.mcap", "room.mcap") == "\n".join([expect(0, "info", "room.mcap")] * 2), "one after the other")
    expect(1, "info", "room.mcap", "absent.mcap", "room.mcap", err="absent.mcap")
    expect(2, "info", "scene.ply", "room.mcap", err="one REC.mcap and --view")


def counts():
    """10k is a count wherever one is asked for."""
    made = {text: expect_json("build", "room.mcap", "--gaussians", text, "-o", "c.ply")["gaussians"] for text in ("0.1k", "100")}
    check(set(made.values()) == {100}, f"{made}")
    rows = expect_json("eval", "room.mcap", "--working", "32x32", "--gaussians", "0.2k,50")["rows"]
    check({row["requested"] for row in rows} == {200, 50}, "eval --gaussians 0.2k,50")
    for text in ("10K", "1.0001k", "k", "1e3", "10kk"):
        expect(2, "build", "room.mcap", "--gaussians", text, "-o", "c.ply", err="--gaussians")


in_scratch(every_command, tables_fit, several_files, counts)
