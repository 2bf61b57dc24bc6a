#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""paper.py TRIM3R TOOLS/PAPER DATA: `tools/study/scripts/paper --quick` on the recorded scenes: every part has its table, cells are the
means of eval's rows, and what was measured is not measured again."""
import csv
import glob
import json
import os
import re
import shutil
import statistics
import sys
import tempfile
import xml.dom.minidom

from checks import check, done, near, run, skip

trim3r, paper, data = map(os.path.abspath, sys.argv[1:])
if not os.path.exists(data):
    skip(f"{data} is not there")
try:
    import matplotlib  # noqa: F401: the pictures
except ImportError as error:
    skip(str(error))
SCENES = ("hololens_b", "icl_livingroom_synth", "icl_livingroom_noisy_synth", "apc_shelf")
METHODS = ("trim3r", "random", "eagles", "lightgaussian", "pup", "efficientgs")
PRESETS = [f"trim3r, {name}" for name in ("fast", "balanced", "best", "balanced, no rim", "best, no rim")]
TUNED = [f"{method}+finetune, 3" for method in METHODS]
MEASURES = ("psnr_all", "psnr", "ssim_all", "perceptual_all")


def tables(text):
    """Returns {heading: its tables, each a list of rows of cells}."""
    found = {}
    for section in text.split("## ")[1:]:
        blocks = re.findall(r"(?:^\|.*\n)+", section + "\n", re.M)
        found[section.split("\n")[0]] = [[[c.strip() for c in line[1:-1].split("|")] for line in block.splitlines()]
                                         for block in blocks]
    return found


def filled(rows):
    """Returns the rows with the first column repeated where it is empty."""
    title = ""
    for row in rows[2:]:
        title = row[0] or title
        yield title, row[1], row[2:]


def rows_of(cache, pattern):
    (path,) = glob.glob(f"{cache}/*/{pattern}")
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def tells(cell, row):
    numbers = list(map(float, cell.split(" / ")))
    for number, column, step in zip(numbers, MEASURES, (0.005, 0.005, 0.0005, 0.0005), strict=True):
        near(number, float(row[column]), step * 1.001, f"{column} of {row['scene']}, {row['method']}")


def check_quality(cache, found):
    rows = {(s, m): cells for s, m, cells in filled(found["Quality against budget"][0])}
    check(list(rows) == [(s, m) for s in (*SCENES, "mean of the scenes") for m in METHODS], "a row a scene and method")
    check(found["Quality against budget"][0][0] == ["scene", "method", "0 %", "90 %"], "shares pruned across")
    for scene in SCENES:
        measured = {(r["method"], r["keep"]): r for r in rows_of(cache, f"{scene}.*.quality.*.csv")}
        for method in METHODS:
            tells(rows[scene, method][0], measured[method, "100"])
            tells(rows[scene, method][1], measured[method, "10"])
    for method in METHODS:
        each = [float(rows[s, method][1].split(" / ")[0]) for s in SCENES]
        near(float(rows["mean of the scenes", method][1].split(" / ")[0]), statistics.fmean(each), 0.011, "each scene once")
    psnr = {m: float(rows["mean of the scenes", m][1].split(" / ")[0]) for m in METHODS}
    check(all(psnr["trim3r"] > psnr[m] + 8 for m in METHODS[1:]), f"pruning alone leaves holes: {psnr}")


def check_others(cache, found):
    rows = {(s, m): cells for s, m, cells in filled(found["With fine-tuning"][0])}
    check(list(rows) == [(s, n) for s in (*SCENES, "mean of the scenes") for n in PRESETS + TUNED], f"{list(rows)}")
    for name in TUNED[2:]:
        tells(rows["apc_shelf", name][0], rows_of(cache, f"apc_shelf.*.{name.replace(', ', '-')}.1.*.csv")[0])
    seeds = [rows_of(cache, f"apc_shelf.*.random+finetune-3.{seed}.*.csv")[0] for seed in (1, 2)]
    near(float(rows["apc_shelf", TUNED[1]][0].split(" / ")[0]), statistics.fmean(float(r["psnr_all"]) for r in seeds), 0.0051,
         "the mean of the seeds")
    check(seeds[0]["psnr_all"] != seeds[1]["psnr_all"], "seeds differ")
    spread = {row[0]: float(row[1]) for row in found["With fine-tuning"][1][2:]}
    check(list(spread) == PRESETS + TUNED[1:2] and spread[TUNED[1]] > 0, f"the spread of what depends on a seed: {spread}")
    choices = {(m, c): cells for m, c, cells in filled(found["Choices of fine-tuning"][0])}
    check(len(choices) == 15, f"choices of fine-tuning: {list(choices)}")
    tells(choices["pup+finetune", "1 round"][0], rows_of(cache, "hololens_a.*.choices.pup.1-round.*.csv")[0])
    views = [(s, n, cells[0], cells[1:]) for s, n, cells in filled(found["More input views"][0])]
    check([v[:3] for v in views] == [(s, *row) for s in SCENES for n in ("2", "3") for row in ((n, "trim3r"), ("", TUNED[1]))],
          "input views")
    for name, row in (("trim3r", views[2]), ("random+finetune-3", views[3])):
        three = rows_of(cache, f"hololens_b.*.3-views.{name}.*.csv")
        tells(row[3][1], three[-1])
        check(len(three[-1]["context"].split(",")) == 3, "of three frames")
    build, slow, frames = found["Latency and frames a second"]
    timed = [rows_of(cache, f"{s}.*.timed.*.csv") for s in SCENES]
    ours = statistics.median(float(r["render_ms"]) for rows in timed for r in rows
                             if (r["method"], r["keep"]) == ("trim3r", "10"))
    near(float(frames[2][2]), 1000 / ours, 0.51, "frames a second")
    check([row[0] for row in build[2:]] == list(METHODS), "every method is timed")
    check([row[0] for row in slow[2:]] == PRESETS + TUNED and slow[3][2] == "1", "and what takes longer, by the default's time")
    scales = found["Splat scales"][0]
    check([row[0] for row in scales[2:]] == list(SCENES), "scales of every scene")
    for row in scales[2:]:
        medians = [float(c.split(" ")[0]) for c in row[1:]]
        check(medians[1] > 2 * medians[0] and medians[1] > 2 * medians[3], f"{row[0]}: pruned ones are wider: {medians}")


def check_masks(found, retrained):
    title = "Our head on others' points"
    rows = {(s, m): cells for s, m, cells in filled(found[title][0])}
    own = [name for m in METHODS[1:] for name in (f"{m}+head", *([f"{m}+head, retrained"] if m in retrained else []))]
    first = ["trim3r", *(["trim3r, retrained"] if "trim3r" in retrained else [])]
    check(list(rows) == [(s, m) for s in (*SCENES, "mean of the scenes") for m in first + own], f"{title}: {list(rows)}")
    return rows


def check_trained_heads(folder, call, cache, heads):
    """A folder as tools/study/train/retrain leaves it: a head for the points of eagles, one of one kind of scenes."""
    os.mkdir(f"{folder}/heads")
    for name, kind, mask in (("eagles", "all", "eagles"), ("rooms", "rooms", "trim3r")):
        run(trim3r, "quantize", f"{heads}/tiny.safetensors", "--name", name, "-o", f"{folder}/heads/{name}.t3w")
        told = {"name": name, "head": "tiny", "kind": kind, "mask": mask, "start": "tiny" if kind == "all" else None,
                "shipped": kind == "all", "steps": 7, "batch": 4, "crop": 128, "rate": 0.001, "seed": 1,
                "data": ["hololens_a"] * (kind == "all")}
        with open(f"{folder}/heads/{name}.json", "w", encoding="utf-8") as file:
            json.dump(told, file)
    printed = run(*call, "masks", "transfer").stdout
    masks, kinds = tables("## a\n" + printed)["a"]
    rows = check_masks({"Our head on others' points": [masks]}, ("eagles",))
    shipped = rows_of(cache, "hololens_b.*.masks.*.csv")
    own = rows_of(cache, "hololens_b.*.retrained.eagles.t3w.*.csv")
    check([(r["method"], r["head"], r["settings"]) for r in own] == [("eagles+head", "eagles", "mask-head-small")],
          "its head on the points that it was trained for")
    tells(rows["hololens_b", "eagles+head, retrained"][0], own[0])
    tells(rows["hololens_b", "eagles+head"][0], next(r for r in shipped if r["method"] == "eagles+head"))
    for text in ("`eagles`: from the shipped `tiny`, 7 steps of 4", "points of eagles", "`rooms`: `tiny` from nothing",
                 "points of trim3r; made-up rooms\n", "made-up and recorded scenes (hololens_a)"):
        check(text in printed, f"how it was trained: {text}")
    kinds = [(s, k) for s, k, _ in filled(kinds)]
    check(kinds == [(s, k) for s in (*SCENES, "room") for k in ("small, shipped", "made-up rooms")], f"kinds: {kinds}")


with tempfile.TemporaryDirectory() as folder:
    cache, out = f"{folder}/cache", f"{folder}/out"
    os.mkdir(out)
    shutil.copy(os.path.join(os.path.dirname(paper), "..", "..", "..", "docs", "study", "paper.md"), out)
    call = (sys.executable, "-B", paper, "--quick", "--program", trim3r, "--cache", cache, "--heads", f"{folder}/heads", "--pages", out)
    first = run(*call, "--write")
    check("paper: 1 measured" in first.stderr, "what is going on")
    with open(f"{out}/paper.md", encoding="utf-8") as file:
        found = tables(file.read())
    check_quality(cache, found)
    check_others(cache, found)
    check_masks(found, ())
    for picture in ("paper.svg", "paper-scales.svg"):
        xml.dom.minidom.parse(f"{out}/{picture}")

    os.remove(glob.glob(f"{cache}/*/apc_shelf.*.quality.*.csv")[0])
    again = run(*call, "quality")
    check("paper: 1 measured" in again.stderr and "2 measured" not in again.stderr, f"the others are kept: {again.stderr}")
    check(tables("## a\n" + again.stdout)["a"] == found["Quality against budget"], "the same table")

    # heads of other scenes
    head = f"{folder}/mine.t3w"
    heads = os.path.join(os.path.dirname(paper), "..", "..", "..", "quant", "heads")
    run(trim3r, "quantize", f"{heads}/tiny.safetensors", "--name", "mine", "-o", head)
    rows = tables("## a\n" + run(*call, "transfer", "--head-of", f"indoor={head}").stdout)["a"][0]
    check([(s, k) for s, k, _ in filled(rows)] ==
          [(s, k) for s in (*SCENES, "room") for k in ("small, shipped", "indoor")], "heads")
    tells(list(filled(rows))[1][2][1], rows_of(cache, "hololens_b.*.head.mine.t3w.*.csv")[1])

    for words, *wrong in (("heads of tools/study/train/retrain", "transfer"), ("no part is called", "speed"),
                          ("no part transfer", "transfer", "--write"),
                          ("is not KIND=FILE.t3w", "--head-of", "indoor"),
                          ("is not KIND=FILE.t3w", "--head-of", "indoor=absent.t3w")):
        check(words in run(*call, *wrong, expect=2).stderr, f"{wrong}: {words}")
    check_trained_heads(folder, call, cache, heads)
    check("absent is not there" in run(*call, "--program", "absent", expect=1).stderr, "a missing program is told")
done()
