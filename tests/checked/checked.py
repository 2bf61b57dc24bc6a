#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""checked.py FOLDER SHARED_DATA: the program built with T3R_CHECK_FIXED builds, streams and draws scenes of the
built-in room with every head, source of depth and way of working, of perturbed frames, and of the recorded scenes
if they are there. A violated bound ends it."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

from checks import check, done, run

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

FOLDER, DATA = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
HERE = pathlib.Path(__file__).resolve().parent
PLANTED = 6
HEADS = ("analytic", "tiny", "small")
SIZE = "160x120"


def build():
    run("cmake", "-S", ROOT, "-B", FOLDER, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS_RELEASE=-O2", "-DT3R_CHECK_FIXED=ON",
        "-DT3R_TESTS=OFF", "-DT3R_SHARED=OFF", "-DT3R_PYTHON_PACKAGE=OFF")
    run("cmake", "--build", FOLDER, "--target", "trim3r", "-j", str(os.cpu_count()))
    return FOLDER / "trim3r"


def finds_what_is_planted(folder):
    planted = folder / "planted"
    run("gcc", "-O2", "-include", HERE / "checked.h", "-fsanitize=signed-integer-overflow,shift,integer-divide-by-zero",
        "-fno-sanitize-recover=all", f"-I{ROOT / 'runtime'}", f"-I{ROOT / 'runtime' / 'include'}", HERE / "planted.c",
        FOLDER / "libtrim3r.a", "-o", planted)
    run(planted)
    for kind in range(1, PLANTED + 1):
        ended = subprocess.run([planted, str(kind)], capture_output=True, text=True)
        check(ended.returncode in (-signal.SIGABRT, 1), f"planted {kind} is found: {ended.returncode}")
        check("Assertion" in ended.stderr or "runtime error" in ended.stderr, f"and named: {ended.stderr}")


def works(program, recording, folder):
    """Uses a recording with depth in all ways."""
    out = folder / "out.ply"
    for head in HEADS:
        run(program, "build", recording, "--head", head, "--keep", "15", "-o", out)
    run(program, "build", recording, "--refine", "16", "--fit-passes", "on", "--keep", "2", "-o", out)
    run(program, "build", recording, "--head", "analytic", "--refine", "0", "--keep", "40", "-o", out)
    run(program, "build", recording, "--align", "on", "--keep", "10", "-o", out)
    run(program, "build", recording, "--structural", "on", "--keep", "10", "-o", out)
    run(program, "build", recording, "--allocate", "paper", "--keep", "40", "--arena", "min", "-o", out)
    run(program, "build", recording, "--auto", "-o", out)
    run(program, "build", recording, "--cpu-mask", "none", "--refine", "8", "--keep", "30", "-o", out)
    run(program, "eval", recording, "--keep", "100,5")
    run(program, "replay", recording, "--stream", "--every", "1", "--gaussians", "3000")
    run(program, "replay", recording, "--slide", "--warm", "on", "--threads", "2")


program = build()
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    finds_what_is_planted(folder)
    room = folder / "room.mcap"
    run(program, "room", "--size", SIZE, "--frames", "6", "-o", room)
    works(program, room, folder)
    run(program, "build", room, "--depth", "stereo", "--keep", "20", "-o", folder / "out.ply")
    run(program, "build", room, "--cpu-mask", "none", "--depth", "stereo", "--keep", "20", "-o", folder / "out.ply")
    run(program, "stress", room, "--strengths", "1", "--keep", "10")
    splits = DATA / "splits.json"
    scenes = [scene for part in json.loads(splits.read_text()).values() for scene in part] if splits.exists() else []
    for scene in scenes:
        if (DATA / scene / "transforms.json").exists() and (DATA / scene / "depth").exists():
            recording = folder / f"{scene}.mcap"
            made = run(program, "import", DATA / scene, "--size", SIZE, "-o", recording)
            if "have no depth" in made.stdout + made.stderr:
                run(program, "eval", recording, "--depth", "stereo", "--keep", "20")
            else:
                works(program, recording, folder)
            recording.unlink()
            print(f"{scene}: within its bounds")
    print(f"{len(scenes)} recorded scenes at hand")
done()
