#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""colours.py TRIM3R: errors, warnings and headings are coloured on a terminal, and only there."""
import os
import re
import subprocess

from program import TRIM3R, check, expect, in_scratch, room
from terminal import on_terminal

ESCAPE = "\x1b["
TERMINAL = {key: value for key, value in os.environ.items() if key != "NO_COLOR"} | {"TERM": "xterm"}


def shown(*command, **more):
    """Returns what both streams write on a terminal."""
    return on_terminal([TRIM3R, *map(str, command)], env=TERMINAL | more)[1].replace("\r\n", "\n")


def colours():
    recording = room()
    build = ["build", recording, "--keep", 10, "-o", "scene.ply"]
    lines = {
        "an error": (["info", "absent.mcap"], "\x1b[1;31mtrim3r info:\x1b[0m absent.mcap: No such"),
        "an error of an option's value": (["build", "--keep", "x"], "\x1b[1;31mtrim3r build:\x1b[0m --keep takes"),
        "an error of a name": (["biuld"], "\x1b[1;31mtrim3r:\x1b[0m there is no command"),
        "an option that is none": (["plan", "--no-such-option"], "\x1b[1;31mtrim3r plan:\x1b[0m unrecognized"),
        "a value that is missing": (["plan", "--size"], "\x1b[1;31mtrim3r plan:\x1b[0m option '--size' requires"),
        "a warning": ([*build[:3], 0.5, *build[4:]], "trim3r build: \x1b[1;33mwarning:\x1b[0m --keep 0.5 is"),
        "the stages' heading": ([*build, "--profile"], "\x1b[1mstage"),
        "the heading of scores": (["eval", recording, "--keep", 5, "--refine", 0], "\x1b[1mscene  "),
        "a heading of help": (["build", "--help"], "\x1b[1mExamples:\x1b[0m\n"),
        "the program's help": (["--help"], "\x1b[1mData flow:\x1b[0m\n")}
    for what, (command, wanted) in lines.items():
        text = shown(*command)
        check(wanted in text, f"{what}: {text[:200]!r}")
        plain = re.sub(r"\x1b\[[0-9;]*m", "", wanted).strip()
        for more in ({"NO_COLOR": "1"}, {"TERM": "dumb"}) if command[0] in ("info", "plan", "--help") else ():
            text = shown(*command, **more)
            check("\x1b[1" not in text and plain in text, f"{what} with {more}: {text[:200]!r}")
        piped = subprocess.run([TRIM3R, *map(str, command)], capture_output=True, text=True, env=TERMINAL)
        check(ESCAPE not in piped.stdout + piped.stderr, f"{what} in a pipe: {piped.stdout[:99]}{piped.stderr[:99]}")
    always = subprocess.run([TRIM3R, *map(str, build), "--profile", "--color", "always"], capture_output=True, text=True)
    check("\x1b[1mstage" in always.stdout, "--color always in a pipe")
    check("\x1b[1" not in shown(*build, "--profile", "--color", "never"), "--color never on a terminal")
    expect(2, "plan", "--color", "red", err="--color takes auto, always or never")
    with open("scene.ply", "rb") as file:
        check(b"\x1b[" not in file.read()[:400], "colours in a file")


in_scratch(colours)
