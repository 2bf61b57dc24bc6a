#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""example.py FOLDER: the firmware of tools/examples/firmware, built from the two files of tools/amalgamate, runs on an
emulated Cortex-M7 and a Cortex-M55 with the same bits. An empty partition, lines that come too fast and a watchdog that
is not fed in time each end it with a reason."""
import pathlib
import re
import shutil
import subprocess
import sys

from checks import check, done, skip

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "tools" / "examples" / "firmware"
FOLDER = pathlib.Path(sys.argv[1])
BOARDS = ("mps2-an500", "mps3-an547")
FLASH_MOST, STACK_MOST = 104 << 10, 12288


def make(board, *words):
    return subprocess.run(["make", "-s", "-C", EXAMPLE, f"BOARD={board}", f"OUT={FOLDER / board}", *words],
                          capture_output=True, text=True, timeout=300, check=False)


def changed(board, macro):
    """Runs the firmware with a macro of the compiler."""
    (FOLDER / board / "firmware.elf").unlink()
    return make(board, f"MORE={macro}", "run")


if any(shutil.which(tool) is None for tool in ("make", "arm-none-eabi-gcc", "qemu-system-arm")):
    skip("no make, no cross compiler or no emulator here")
shown = set()
for board in BOARDS:
    shutil.rmtree(FOLDER / board, ignore_errors=True)
    ended = make(board, "MORE=-Werror", "run")
    said = dict(re.findall(r"^(\w+) (\d+)$", ended.stdout, re.M))
    check(ended.returncode == 0, f"{board}: {ended.stdout}{ended.stderr}")
    check((said["gaussians"], said["points"]) == ("400", "8192"), f"{board}: the whole budget of two whole views: {said}")
    check(int(said["stack_bytes"]) <= STACK_MOST, f"{board}: the stack: {said}")
    text, data = map(int, re.search(r"^ *(\d+)\s+(\d+)", ended.stdout, re.M).groups())
    check(text + data <= FLASH_MOST, f"{board}: {text + data} bytes of flash, at most {FLASH_MOST}")
    check((FOLDER / board / "weights.t3w").read_bytes()[:4] == b"T3RW", f"{board}: the partition is a weight file")
    shown.add(said["display"])
check(len(shown) == 1, f"the boards draw the same: {shown}")

board = BOARDS[0]
partition = FOLDER / board / "weights.t3w"
for name, ended, reason in (
        ("a watchdog of 3 million instructions", changed(board, "-DWATCHDOG_MS=100"), "the watchdog was not fed"),
        ("lines that come too fast", changed(board, "-DTICKS_PER_LINE=200"), "camera: lines come faster than they are taken"),
        ("an erased partition", (partition.write_bytes(b"\xff" * 4064), changed(board, ""))[1],
         "t3r_bind_head: not a weight file")):
    check(ended.returncode != 0 and f"error: {reason}" in ended.stdout, f"{name}: {ended.stdout}{ended.stderr}")
done()
