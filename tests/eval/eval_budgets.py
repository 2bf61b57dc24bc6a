#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_budgets.py TRIM3R: `--gaussians` and `--poses` work in `trim3r eval` as in `trim3r build`."""
import json
import os
import pathlib
import shutil
import sys
import tempfile

from checks import check, done, near, run

trim3r = os.path.abspath(sys.argv[1])
ONE = ("--context", "0,2", "--target", 1)


def rows(*options):
    return json.loads(run(trim3r, "eval", "room.mcap", *map(str, options), "--json").stdout)["rows"]


def built(*options):
    """Returns the PSNR of the view from a scene of `build`, over all pixels."""
    run(trim3r, "build", "room.mcap", "--context", "0,2", *map(str, options), "-o", "scene.ply")
    run(trim3r, "render", "scene.ply", "room.mcap", "--view", "1", "-o", "view.png")
    if not os.path.exists("recorded"):
        run(trim3r, "eval", "room.mcap", *map(str, ONE), "--keep", "1", "--refine", "0", "--images", "recorded")
    return json.loads(run(trim3r, "diff", "view.png", "recorded/1/target.png", "--json", expect=1).stdout)["psnr"]


def counts():
    run(trim3r, "eval", "room.mcap", "--keep", "10", "--gaussians", "500,400", "--csv", "rows.csv", "--images", "dir")
    with open("rows.csv", encoding="utf-8") as file:
        table = file.read()
    found = rows("--keep", 10, "--gaussians", "500,400")
    check([(r["keep"], r["requested"], r["gaussians"]) for r in found[:3]] ==
          [(10, None, 819), (None, 500, 500), (None, 400, 400)], f"budgets: {found[:3]}")
    check(os.path.exists("dir/1/trim3r_10.png") and os.path.exists("dir/1/trim3r_gaussians-500.png"), "no pictures")
    near(found[1]["psnr_all"], built("--gaussians", 500), 0.05, "a count is not that of build")
    run(trim3r, "eval", "room.mcap", "--keep", "10", "--gaussians", "500,400", "--csv", "rows.csv", "--resume",
        "--images", "dir")
    with open("rows.csv", encoding="utf-8") as file:
        check(file.read() == table, "rows with a count are made again")
    means = json.loads(run(trim3r, "eval", "room.mcap", "--gaussians", "500,400", "--refine", "0", "--json").stdout)["means"]
    check([m["requested"] for m in means] == [500, 400], f"means of counts: {means}")
    over = run(trim3r, "eval", "room.mcap", *map(str, ONE), "--gaussians", "9999", "--json")
    row = json.loads(over.stdout)["rows"][0]
    check((row["requested"], row["gaussians"]) == (9999, 8192) and "all 8192 valid points" in over.stderr, over.stderr)
    picture = run(trim3r, "chart", "rows.csv", "-o", "chart.html", "--svg", "chart.svg")
    check(picture.returncode == 0, picture.stderr)
    with open("chart.svg", encoding="utf-8") as file:
        text = file.read()
    check("trim3r, 500 Gaussians: " in text and "10 % kept" in text and "Gaussians %" not in text, "chart of counts")
    table = run(trim3r, "eval", "room.mcap", *map(str, ONE), "--ablate=full,random", "--gaussians", "300", "--refine", "0")
    check("|           300 |" in table.stdout, table.stdout)


def poses():
    # OpenCV finds too few features in the smaller room
    run(trim3r, "room", "--size", "96x96", "-o", "room.mcap")
    shutil.rmtree("recorded")
    given, again = (rows(*ONE, "--gaussians", 500, "--images", "given", *more)[0] for more in ((), ("--poses", "given")))
    same = [key for key in given if key not in ("build_ms", "render_ms")]
    check([given[key] for key in same] == [again[key] for key in same], "--poses given changes rows")
    for source in ("estimate", "estimate-colour"):
        posed = rows(*ONE, "--gaussians", 500, "--images", source, "--poses", source)[0]
        masks = [pathlib.Path(folder, "1", "mask.png").read_bytes() for folder in ("given", source)]
        check(masks[0] == masks[1], f"{source}: the estimate moves the mask that it is scored on")
        check(posed["settings"] == f"poses-{source}" and posed["psnr"] != given["psnr"], f"{source}: nothing changes")
        check(source != "estimate" or posed["psnr"] > given["psnr"] - 1, f"{posed['psnr']} dB, given {given['psnr']} dB")
        near(posed["psnr_all"], built("--gaussians", 500, "--poses", source), 0.05, f"{source} is not that of build")
    # a context view of one case is the target of another, with its recorded pose
    alone = {r["target"]: r["psnr"] for r in rows("--gaussians", 500, "--poses", "estimate")}
    check(alone["1"] == rows(*ONE, "--gaussians", 500, "--poses", "estimate")[0]["psnr"], "cases change each other")


def refused():
    for options, words in ((("--gaussians", "0"), "--gaussians"), (("--gaussians", "5,x"), "--gaussians"),
                           ((), "budget is missing"), (("--keep", "5", "--poses", "guess"), "guess"),
                           (("--planar", "--keep", "5", "--poses", "estimate"), "--poses")):
        answer = run(trim3r, "eval", "room.mcap", *options, expect=2)
        check(words in answer.stderr, f"{options}: {answer.stderr}")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    run(trim3r, "room", "--size", "64x64", "-o", "room.mcap")
    counts()
    refused()
    poses()
done()
