#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""robot.py TRIM3R ROBOT_LOOP ROBOT_SMALL COMPILER SOURCE: the free distance agrees with the recording's depth, with
much memory and with little; too little memory is an error of the compiler; the robot's own code neither allocates
nor uses floats."""
import re
import struct
import subprocess
import sys
import tempfile

from checks import check, done, run
from common import EXAMPLE, ROOT, room, without_crc

SMALL, COMPILER, SOURCE = sys.argv[3:6]
SIDE, FRAMES = 128, 6
OUTPUT = {"printf", "puts", "putchar", "memcpy", "memset", "__stack_chk_fail"}
METRES = 0.13  # measured: 0.10
LINE = re.compile(r"frame (\d+): (\d+) Gaussians, (\d+\.\d{3}) m ahead")


def compiled(*flags):
    return subprocess.run([COMPILER, "-std=c11", "-O2", *flags, "-I", ROOT / "runtime" / "include", "-I",
                           ROOT / "platform", SOURCE], capture_output=True, text=True)


def nearest(depth):
    """Returns millimetres in the middle third."""
    steps = struct.unpack(f"<{SIDE * SIDE}H", depth)
    middle = range(SIDE // 3, 2 * SIDE // 3)
    return min(steps[y * SIDE + x] for y in middle for x in middle)


with tempfile.TemporaryDirectory() as folder:
    _, depths = room(f"{folder}/room.mcap", SIDE, FRAMES)
    for program, gaussians in ((EXAMPLE, 4096), (SMALL, 2048)):
        lines = run(program, f"replay:{folder}/room.mcap").stdout.splitlines()
        told = [LINE.fullmatch(line) for line in lines]
        check(all(told) and [int(line[1]) for line in told] == [1, 3, 5], lines)
        check([int(line[2]) for line in told] == [gaussians] * 3, lines)
        for line in told:
            there = nearest(depths[int(line[1])]) / 1000
            print(f"{line[0]}, measured {there:.3f}")
            check(abs(float(line[3]) - there) <= METRES, f"{line[0]}: {there:.3f} m by the recording")
    with open(f"{folder}/room.mcap", "rb") as file:
        data = file.read()
    with open(f"{folder}/dark.mcap", "wb") as file:  # the first frame has no measurement
        file.write(without_crc(data.replace(depths[0], bytes(len(depths[0])))))
    lines = run(EXAMPLE, f"replay:{folder}/dark.mcap").stdout.splitlines()
    check([line.split()[1] for line in lines] == ["0:", "2:", "4:"] and "depth" in lines[0], lines)
    check("none.mcap" in run(EXAMPLE, f"replay:{folder}/none.mcap", expect=1).stdout, "a recording that is not there")

    for cap, words in ((262144, "no room for any map"), (1048577, "multiple of")):
        ended = compiled("-fsyntax-only", f"-DROBOT_BYTES={cap}")
        check(ended.returncode != 0 and words in ended.stderr, f"{cap} bytes: {ended.stderr}")
    ended = compiled("-mgeneral-regs-only", "-c", "-o", f"{folder}/robot.o")
    check(ended.returncode == 0, f"without registers for floats: {ended.stderr}")
    called = set(re.findall(r" U (\w+)", run("nm", f"{folder}/robot.o").stdout))
    foreign = {name for name in called if not name.startswith("t3r_")} - OUTPUT
    check("t3r_init_as" in called and foreign == set(), f"the robot calls {foreign}")
done()
