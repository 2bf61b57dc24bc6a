#!/usr/bin/env python3
"""robot.py TRIM3R ROBOT_LOOP ROBOT_SMALL COMPILER SOURCE: how far the way is clear, by what the recording's depth says,
with much room and with little; no room is an error of the compiler; the robot's own code neither allocates nor uses
floats."""
import re
import subprocess
import struct
import sys
import tempfile

from common import EXAMPLE, ROOT, check, done, room, run

SMALL, COMPILER, SOURCE = sys.argv[3:6]
SIDE, FRAMES = 128, 6
METRES = 0.13  # measured: 0.10
LINE = re.compile(r"frame (\d+): (\d+) Gaussians, (\d+\.\d{3}) m ahead")


def compiled(*flags):
    return subprocess.run([COMPILER, "-std=c11", "-O2", *flags, "-I", ROOT / "runtime" / "include", "-I",
                           ROOT / "platform", SOURCE], capture_output=True, text=True)


def nearest(depth):
    """Millimetres, in the middle third."""
    steps = struct.unpack(f"<{SIDE * SIDE}H", depth)
    middle = range(SIDE // 3, 2 * SIDE // 3)
    return min(steps[y * SIDE + x] for y in middle for x in middle)


with tempfile.TemporaryDirectory() as folder:
    _, depths = room(f"{folder}/room.mcap", SIDE, FRAMES)
    for program, gaussians in ((EXAMPLE, 4096), (SMALL, 1024)):
        lines = run(program, f"replay:{folder}/room.mcap").stdout.splitlines()
        told = [LINE.fullmatch(line) for line in lines]
        check(all(told) and [int(line[1]) for line in told] == [1, 3, 5], lines)
        check([int(line[2]) for line in told] == [gaussians] * 3, lines)
        for line in told:
            there = nearest(depths[int(line[1])]) / 1000
            print(f"{line[0]}, measured {there:.3f}")
            check(abs(float(line[3]) - there) <= METRES, f"{line[0]}: {there:.3f} m by the recording")
    check("none.mcap" in run(EXAMPLE, f"replay:{folder}/none.mcap", expect=1).stdout, "a recording that is not there")

    for cap, words in ((262144, "no room for any map"), (1048577, "multiple of")):
        ended = compiled("-fsyntax-only", f"-DROBOT_BYTES={cap}")
        check(ended.returncode != 0 and words in ended.stderr, f"{cap} bytes: {ended.stderr}")
    check(compiled("-c", "-o", f"{folder}/robot.o").returncode == 0, "the robot compiles")
    called = set(re.findall(r" U (\w+)", run("nm", f"{folder}/robot.o").stdout))
    foreign = {name for name in called if not name.startswith("t3r_")} - {"printf", "puts", "__stack_chk_fail"}
    check("t3r_init" in called and foreign == set(), f"the robot calls {foreign}")
done()
