#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""product.py TRIM3R STUDY_LIBRARY...: the program without the study does a user's work, contains none of the study,
and names the build with the requested commands."""
import shutil
import subprocess
import sys

from program import HEADS, TRIM3R, check, expect, expect_json, in_scratch, room, write

LIBRARIES = sys.argv[2:]
POSED = ('{"fl_x": 60, "fl_y": 60, "cx": 32, "cy": 32, "frames": [{"file_path": "a.png", "transform_matrix": '
         '[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}')


def every_command():
    expect(0, "capture", "--source", f"replay:{room()}", "-o", "again.mcap")
    built = expect_json("build", "again.mcap", "--context", "0,2", "--keep", "10%", "-o", "scene.ply", "--profile")
    check(built["method"] == "trim3r" and "hash" in built, f"built: {built}")
    expect(0, "info", "scene.ply")
    expect(0, "info", "again.mcap")
    expect(0, "convert", "scene.ply", "-o", "scene.spz")
    expect(0, "render", "scene.ply", "room.mcap", "--view", 1, "-o", "view.png")
    expect(0, "view", "scene.ply", "-o", "page.html")
    rows = expect_json("eval", "room.mcap", "--context", "0,2", "--target", 1, "--keep", "20,10", "--heads", "none,small",
                       "--html", "scores.html", "--images", "posed", "--csv", "scores.csv")["rows"]
    check([(row["method"], row["head"]) for row in rows] == [("trim3r", "none")] * 2 + [("trim3r", "small")] * 2,
          f"scored: {rows}")
    expect(0, "eval", "room.mcap", "--scene", "scene.ply")
    shutil.copy("posed/1/target.png", "posed/a.png")
    write("posed/transforms.json", POSED)
    expect(0, "import", "posed", "-o", "posed.mcap")
    hashes = expect(0, "replay", "room.mcap", "--json")
    expect(0, "replay", "room.mcap", "--expect", write("hashes.json", hashes))
    expect(0, "diff", "scene.ply", "scene.ply")
    expect(0, "plan", "--size", "64x64", "--gaussians", 9)
    expect(0, "bench", "--runs", 1, "--stages", "texture_ns_per_pixel")
    expect(0, "doctor")
    expect(0, "head-info", f"{HEADS}/small.safetensors")
    expect(0, "completion", "bash", out="trim3r")


def the_study_is_named():
    listed = expect(0, "--commands")
    for command in ("chart", "stress", "quantize"):
        check(f"{command}\t" not in listed, f"{command} is listed")
        expect(2, command, "--help", err="-DT3R_STUDY=ON")
    for option in ("--method", "--mask-head", "--finetune-iterations"):
        expect(2, "build", "room.mcap", "--keep", 10, "-o", "x.ply", option, "pup", err=option)
    for option in ("--methods=pup", "--ablate"):
        expect(2, "eval", "room.mcap", "--keep", 10, option, err=option.split("=")[0])


def functions(*files):
    """Returns the functions and data that the files define, by name."""
    listed = subprocess.run(["nm", "--defined-only", "--extern-only", "--format=posix", *files], capture_output=True,
                            text=True, check=True).stdout
    return {fields[0] for fields in map(str.split, listed.splitlines()) if len(fields) > 1 and fields[1] in "TDBR"}


def nothing_of_it_is_linked():
    study, product = functions(*LIBRARIES), functions(TRIM3R)
    check(len(study) > 100 and "rival_build" in study and "t3r_render" in product, f"{len(study)} names of the study")
    check(study & product == set(), f"linked into the product: {sorted(study & product)}")


in_scratch(every_command, the_study_is_named, nothing_of_it_is_linked)
