#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Same bits: every stage's hash, against the ones written down in this folder.

golden.py host [--few] DRIVER     the driver as built here, in every way that must not matter (arena, tasks, moves)
golden.py build [--both-ways] [--vectors] [--run EMULATOR] COMPILER FLAG...
                                  the driver built by another compiler, for another processor; run in the usual way,
                                  with --both-ways in the one that differs most from it, too; with --vectors by the
                                  loops of the processor's instruction sets in the place of plain C
golden.py replay [--few] TRIM3R   the built-in recording, made and replayed by the program
                                  with --few only in the way that differs most from the usual one, by vectors
Exit 0: the same; 1: other bits, naming the first stage that differs; 77: skipped, a tool is absent.
"""
import json
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "study" / "boards"))

import objects  # noqa: E402
from objects import output_of  # noqa: E402

STAGES = HERE / "stages.txt"
ROOM = HERE / "room.json"
VECTORS = ["--cpu-mask", "all"]
WAYS = [[], ["--arena", "min"], ["--arena", "ten"], ["--tasks", "reverse"], ["--moved"],
        ["--tasks", "reverse", "--workers", "3"], VECTORS, ["--moved", *VECTORS],
        ["--arena", "min", "--tasks", "reverse", "--workers", "8", "--moved"]]
REPLAY_WAYS = [[], ["--threads", "3"], ["--arena", "min"], ["--cpu-mask", "0"],
               ["--cpu-mask", "sse4.1"], ["--cpu-mask", "avx2"]]
FEW_WAYS = [[*WAYS[-1], *VECTORS]]
FEW_REPLAY_WAYS = [["--threads", "3", "--arena", "min"]]
DRIVER_SOURCES = [HERE / "golden_driver.c", ROOT / "tests" / "weights_maker.c", ROOT / "quant" / "heads" / "small.c",
                  ROOT / "platform" / "host" / "cpu.c",
                  *sorted((ROOT / "tools" / "room").glob("*.c"))]
DRIVER_INCLUDES = [ROOT / "runtime" / "include", ROOT / "runtime", ROOT / "platform", ROOT / "tools", ROOT / "tests",
                   ROOT / "quant" / "heads"]


def difference(got, expected):
    """Returns None, or a sentence that names the first line that differs."""
    got, expected = got.splitlines(), expected.splitlines()
    for here, there in zip(got, expected):
        if here != there:
            return f"got '{here}', written down is '{there}'"
    if len(got) != len(expected):
        return f"got {len(got)} lines, written down are {len(expected)}"
    return None


def same(what, got, expected):
    at = max(expected.rfind(digit) for digit in "0123456789abcdef")
    tampered = expected[:at] + ("0" if expected[at] != "0" else "1") + expected[at + 1:]
    if difference(got, tampered) is None:
        sys.exit("blind: a changed digit was not noticed")
    found = difference(got, expected)
    if found:
        sys.exit(f"OTHER BITS: {what}: {found}")
    print(f"same bits: {what}, {len(expected.splitlines())} lines")


def check_host(driver, ways):
    expected = STAGES.read_text()
    for way in ways:
        same(" ".join(way) or "as usual", output_of(driver, *way), expected)


def check_build(arguments):
    ways, emulator = WAYS[:1], []
    if arguments[0] == "--both-ways":
        ways, arguments = [WAYS[0], WAYS[-1]], arguments[1:]
    if arguments[0] == "--vectors":
        ways, arguments = [[*way, "--cpu-mask", "all"] for way in ways], arguments[1:]
    if arguments[0] == "--run":
        emulator, arguments = [arguments[1]], arguments[2:]
    lacking = objects.absent(arguments[0], *emulator)
    if lacking is not None:
        print(f"SKIPPED: no {lacking} here (tools/setup --tests)")
        sys.exit(77)
    runtime = objects.compiled([word for word in arguments if word != "-static"])
    with tempfile.TemporaryDirectory(prefix="trim3r-golden-") as folder:
        driver = pathlib.Path(folder) / "golden_driver"
        includes = [word for folder in DRIVER_INCLUDES for word in ("-I", folder)]
        output_of(*arguments, "-std=gnu11", *includes, *DRIVER_SOURCES, *runtime, "-o", driver)
        expected = STAGES.read_text()
        for way in ways:
            same(" ".join([*emulator, *arguments, *way]), output_of(*emulator, driver, *way), expected)


def replay(program, way=()):
    """Returns the hash of the built-in recording and the output of `trim3r replay --json`."""
    with tempfile.TemporaryDirectory(prefix="trim3r-golden-") as folder:
        recording = pathlib.Path(folder) / "room.mcap"
        made = json.loads(output_of(program, "room", "--json", "-o", recording))
        said = json.loads(output_of(program, "replay", recording, "--json", *way))
    kept = {"recording": made["hash"], **{key: said[key] for key in ("bits_epoch", "gaussians", "stages", "hash")}}
    return json.dumps(kept, indent=2) + "\n"


def check_replay(program, ways):
    for way in ways:
        same(" ".join(["the built-in recording", *way]), replay(program, way), ROOM.read_text())


def main():
    few = "--few" in sys.argv
    if sys.argv[1] == "host":
        check_host(sys.argv[-1], FEW_WAYS if few else WAYS)
    elif sys.argv[1] == "build":
        check_build(sys.argv[2:])
    elif sys.argv[1] == "replay":
        check_replay(sys.argv[-1], FEW_REPLAY_WAYS if few else REPLAY_WAYS)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
