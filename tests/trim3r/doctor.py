#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""doctor.py TRIM3R: what a machine has is listed, and a self-check that gives other bits is an error."""
import json
import os
import shutil
import subprocess

from program import TRIM3R, check, expect, expect_json, in_scratch, room


def lists():
    found = expect_json("doctor")
    version = expect(0, "--version").strip()
    check(version == f"trim3r {found['version']}, bits epoch {found['bits_epoch']}", f"{version}: {found}")
    check(found["passed"] is True and found["hash"] == found["expected"], f"the self-check: {found['hash']}")
    used = set(found["cpu_used"].split())
    check(used == set(found["cpu_features"].split()), "not all features are used")
    check(found["kernels"] != {} and set(found["kernels"].values()) <= used | {"c"}, f"kernels: {found['kernels']}")
    check(found["processors"] >= 1 and found["memory_bytes"] > found["memory_free_bytes"] > 0, "threads and memory")
    check({"replay", "v4l2", "libcamera", "opencv"} == set(found["sources"]) and found["sources"]["replay"] is True,
          f"sources: {found['sources']}")
    check(found["formats"].split()[0] == "YUYV" and isinstance(found["cameras"], list), "formats and cameras")
    check(found["heif"] is None or found["heif"].startswith("libheif "), f"HEIC: {found['heif']}")
    check(found["poses"] is None or found["poses"].startswith("OpenCV "), f"poses: {found['poses']}")
    listed = expect(0, "capture", "--list")
    check(found["formats"] in listed, f"formats: {found['formats']} and {listed}")
    shown = expect(0, "doctor")
    for word in ("trim3r ", "processor", "features", "kernels", "threads", "memory", "sources", "formats", "cameras",
                 "pictures", "poses"):
        check(any(line.startswith(word) for line in shown.splitlines()), f"no {word} in {shown}")
    check(f"{found['hash']}, as on every machine" in shown, shown)
    check(max(map(len, (shown + listed).splitlines())) <= 80, f"lines of over 80 columns: {shown}{listed}")


def away_from_its_modules():
    """A copy of the program has no modules next to it, like a build without OpenCV."""
    shutil.copy(TRIM3R, "alone")
    recording, hint = room(), "tools/setup --poses"
    ended = subprocess.run([os.path.abspath("alone"), "doctor"], capture_output=True, text=True)
    check(ended.returncode == 0 and hint in ended.stdout, f"doctor without modules: {ended}")
    ended = subprocess.run([os.path.abspath("alone"), "import", recording, "--poses", "estimate", "-o", "posed.mcap"],
                           capture_output=True, text=True)
    check(ended.returncode == 1 and hint in ended.stderr and not os.path.exists("posed.mcap"),
          f"poses without modules: {ended}")


def without_libheif():
    """libheif is loaded for its pictures alone; where it does not load, they are refused by its name."""
    os.makedirs("empty")
    open("empty/libheif.so.1", "wb").close() # found first, and no library
    environment = {**os.environ, "LD_LIBRARY_PATH": os.path.abspath("empty")}

    def run(*arguments):
        return subprocess.run([TRIM3R, *arguments], env=environment, capture_output=True, text=True)

    check(run("--version").returncode == 0, "libheif is loaded to print a version")
    if expect_json("doctor")["heif"] is None:
        return
    os.makedirs("photos")
    for i in range(2):
        with open(f"photos/{i}.heic", "wb") as file:
            file.write(b"\0\0\0\x18ftypheic")
    for ended, status in ((run("import", "photos", "--poses", "estimate", "-o", "no.mcap"), 1), (run("doctor"), 0)):
        said = " ".join((ended.stdout + ended.stderr).split())
        check(ended.returncode == status and "libheif does not load" in said and "Debian: libheif1" in said,
              f"without libheif: {ended}")
    check(json.loads(run("doctor", "--json").stdout)["heif"] is None, "doctor has a libheif that does not load")


def the_same_bits_whatever_is_used():
    hashes = {expect_json("doctor", *given)["hash"] for given in
              ([], ["--cpu-mask", "none"], ["--cpu-mask", "avx2"], ["--threads", 3], ["--threads", 2, "--cpu-mask", "none"])}
    check(len(hashes) == 1, f"hashes: {hashes}")
    plain = expect_json("doctor", "--cpu-mask", "none")
    check(set(plain["kernels"].values()) <= {"c"} and plain["cpu_used"] == "none", "--cpu-mask none leaves variants")


def other_bits_are_an_error():
    wrong = "0123456789abcdef"
    hash = expect_json("doctor")["hash"]
    expect(0, "doctor", "--expect", hash)
    expect(1, "doctor", "--expect", wrong, err=f"gives {hash}, not {wrong}; plain C on one thread gives a wrong one, too")
    expect(1, "doctor", "--expect", wrong, out=f"{hash}, wrong")
    expect(2, "doctor", "--expect", "hash", err="--expect")
    expect(2, "doctor", "more", err="too many")
    expect(2, "doctor", "--cpu-mask", "avx9", err="--cpu-mask")


in_scratch(lists, away_from_its_modules, without_libheif, the_same_bits_whatever_is_used, other_bits_are_an_error)
