#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""allocations.py TRIM3R CC [EVERY]: each allocation of each writer fails in turn, or each EVERY-th. Then a file is whole, or
it is not there and the program says why."""
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from checks import check, done, run  # noqa: E402

TRIM3R, CC = os.path.abspath(sys.argv[1]), sys.argv[2]
EVERY = int(sys.argv[3]) if len(sys.argv) > 3 else 1
HERE = os.path.dirname(os.path.abspath(__file__))
WRITERS = {
    "o.ply": ("convert", "scene.ply"),
    "o.splat": ("convert", "scene.ply"),
    "o.spz": ("convert", "scene.ply"),
    "o.glb": ("convert", "scene.ply"),
    "o.sog": ("convert", "scene.ply"),
    "o.compressed.ply": ("convert", "scene.ply"),
    "o.png": ("render", "scene.ply", "room.mcap", "--view", "0"),
    "o.mcap": ("room", "--size", "16x16", "--frames", "2"),
    "o.svg": ("info", "scene.ply", "--svg"),
}
ENOUGH = 40  # runs in a row in which nothing failed any more


def outcome(command, output, fail_at):
    """Returns the exit status, the messages, and the bytes of the output; None: it is not there."""
    if os.path.exists(output):
        os.remove(output)
    last = () if command[-1] == "--svg" else ("-o",)
    ended = subprocess.run([TRIM3R, *command, *last, output], capture_output=True, text=True,
                           env=os.environ | {"LD_PRELOAD": os.path.abspath("fail.so"), "FAIL_AT": str(fail_at)})
    if not os.path.exists(output):
        return ended.returncode, ended.stderr, None
    with open(output, "rb") as file:
        return ended.returncode, ended.stderr, file.read()


def try_writer(output, command):
    whole = outcome(command, output, 0)
    check(whole[0] == 0 and whole[2], f"{output}: {whole[:2]}")
    failed, unfailing, number = 0, 0, 1
    while unfailing < ENOUGH:
        status, message, written = outcome(command, output, number)
        what = f"{output}, allocation {number}: exit status {status}: {message}"
        if status == 0:
            check(written == whole[2], f"{what}, and the file is another one")
        else:
            check(status > 0 and message and written is None, f"{what}, file there: {written is not None}")
        failed += status != 0
        unfailing = 0 if status != 0 else unfailing + 1
        number += EVERY
    check(failed * EVERY > 5, f"{output}: only {failed} allocations fail")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    run(CC, "-O1", "-shared", "-fPIC", "-o", "fail.so", os.path.join(HERE, "fail_allocation.c"))
    run(TRIM3R, "room", "--size", "16x16", "--frames", "2", "-o", "room.mcap")
    run(TRIM3R, "build", "room.mcap", "--context", "0,1", "--gaussians", "40", "-o", "scene.ply")
    for name, line in WRITERS.items():
        try_writer(name, line)
    check(not [name for name in os.listdir(".") if ".part" in name], "parts of files are left")
done()
