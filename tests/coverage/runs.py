# SPDX-License-Identifier: Apache-2.0
"""Runs that show which branches of the runtime are taken: test programs, and the program trim3r."""
import itertools
import os
import subprocess
import sys

import branches

# A stream of hundreds of laps takes no branch that the others leave, and an hour without optimization.
REPEATS = "^stream_laps"
AREAS = ("unit", "oracle", "workers", "kernels", "formats", "planning")
GOLDEN_WAYS = ([], ["--arena", "min", "--tasks", "reverse", "--workers", "3"], ["--moved"], ["--cpu-mask", "all"])

HEADS = ("none", "analytic", "tiny", "small")
ALLOCATIONS = ("density", "paper", "pixel", "uniform", "random")
WAVELETS = ("db2", "haar", "cdf53")


def quiet(*command, cwd=None):
    ended = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: status {ended.returncode}\n{ended.stdout[-4000:]}{ended.stderr[-4000:]}")
    return ended.stdout


def build(folder):
    jobs = str(os.cpu_count())
    options = {"T3R_COVERAGE": "ON", "T3R_TESTS": "ON", "T3R_SHARED": "OFF", "T3R_PYTHON_PACKAGE": "OFF", "T3R_LIBCAMERA": "OFF",
               "T3R_OPENCV": "OFF", "T3R_POSES": "OFF", "CMAKE_BUILD_TYPE": "None",
               "CMAKE_C_FLAGS": "-O1 -U__OPTIMIZE__ -DT3R_CHECKS_APART"} # no variants that only an optimized runtime has
    quiet("cmake", "-G", "Unix Makefiles", "-Wno-dev", "-S", branches.ROOT, "-B", folder,
          *(f"-D{name}={value}" for name, value in options.items()))
    for area in AREAS:
        quiet("make", "-C", folder / "tests" / area, "-j", jobs)
    quiet("cmake", "--build", folder, "--parallel", jobs, "--target", "golden_driver", "trim3r")


def forget(folder):
    """Deletes the counts of earlier runs."""
    for path in folder.rglob("*.gcda"):
        path.unlink()


def run_tests(folder):
    for area in AREAS:
        quiet("ctest", "--test-dir", folder / "tests" / area, "--label-regex", "program$", "--exclude-regex", REPEATS,
              "--no-tests=error", "--parallel", str(os.cpu_count()), "--timeout", "1200", "--output-on-failure")
    for way in GOLDEN_WAYS:
        quiet(folder / "golden_driver", *way)


def run_program(program, scratch):
    """Builds scenes of the built-in room in every setting that takes other branches."""
    def trim3r(*words):
        quiet(program, *words, cwd=scratch)

    trim3r("room", "--size", "48x40", "-o", "room.mcap")
    trim3r("room", "--size", "64x64", "--frames", 10, "-o", "walk.mcap")
    base = ("build", "room.mcap", "--force", "-o", "scene.ply")
    for head, allocation in itertools.product(HEADS, ALLOCATIONS):
        trim3r(*base, "--keep", "10%", "--head", head, "--allocate", allocation, "--cpu-mask", "none")
    for wavelet, levels in itertools.product(WAVELETS, (1, 2, 5)):
        trim3r(*base, "--keep", "20%", "--head", "analytic", "--wavelet", wavelet, "--levels", levels)
    for words in (("--keep", "100%", "--context", "0,1,2,3", "--threads", 3),
                  ("--keep", "1%", "--arena", "min", "--context", "5"),
                  ("--auto", "--max-loss", 0.5),
                  ("--auto", "--max-loss", 0.5, "--context", 0),
                  ("--keep", "5%", "--fit-passes", "on", "--refine", 16),
                  ("--keep", "20%", "--fit-widths", "on", "--head", "analytic"),
                  ("--keep", "5%", "--structural", "on", "--context", "0,2"),
                  ("--keep", "5%", "--align", "on", "--context", "0,2"),
                  ("--auto", "--max-loss", 1, "--align", "off"),
                  ("--keep", "10%", "--exposure", "off", "--flying", "off", "--redundancy", "off"),
                  ("--keep", "10%", "--working", "64x64", "--depth", "stereo", "--context", "0,1,2")):
        trim3r(*base, *words)
    trim3r("room", "--size", "512x512", "--frames", 3, "-o", "large.mcap")
    trim3r("build", "large.mcap", "--keep", "1%", "--refine", 1, "--context", "0,2", "-o", "large.ply")
    trim3r("render", "scene.ply", "room.mcap", "--view", 1, "-o", "view.png")
    for head in ("analytic", "small"):
        trim3r("plan", "--size", "64x48", "--views", 2, "--arena", "400K", "--head", head)
    trim3r("replay", "walk.mcap", "--stream", "--gaussians", 500, "--every", 2, "--half-life", 2, "--overlap", "70%")
    for warm in ("off", "on"):
        trim3r("replay", "walk.mcap", "--slide", "--keep", "10%", "--warm", warm)
    trim3r("stress", "--working", "48x48", "--strengths", 3, "--captures", 0)
