#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""commands.py TRIM3R: common behaviour of all commands: help, unknown options, a full disk."""
import subprocess

from program import TRIM3R, check, expect, fill_disk, in_scratch


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
        expect(2, command, "--no-such-option", err="no-such-option")
    # a result that cannot be printed is an error
    with open("out.txt", "w") as out:
        done = subprocess.run([TRIM3R, "plan", "--size", "64x64", "--gaussians", "5"], stdout=out, text=True,
                              stderr=subprocess.PIPE, preexec_fn=fill_disk, restore_signals=False)
    check(done.returncode == 1 and "standard output: " in done.stderr, f"plan to a full disk: {done.returncode}")


in_scratch(every_command)
