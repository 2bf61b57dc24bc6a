#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stress_room.py TRIM3R: `trim3r stress` on the built-in room, small: rows, columns, agreement with eval on the same
frames, the page, the same figures twice, exit codes."""
import csv
import json
import os
import re
import sys
import tempfile

from checks import check, done, near, run

trim3r = sys.argv[1]
COLUMNS = ("scene context target perturbation strength unit method keep status reason budget gaussians psnr ssim holes "
           "perceptual psnr_unpruned psnr_lost ssim_lost flicker flicker_unpruned mask_changed motion build_ms build_ratio "
           "arena_bytes").split()
TIMES = ("build_ms", "build_ratio")
SMALL = ["--working", "48x48"]


def rows_of(*arguments, expect=0):
    return json.loads(run(trim3r, "stress", *arguments, "--json", expect=expect).stdout)["rows"]


def timeless(row):
    return {key: value for key, value in row.items() if key not in TIMES}


def table_and_page(folder):
    table, page = f"{folder}/a.csv", f"{folder}/a.html"
    shown = run(trim3r, "stress", *SMALL, "--rows", "noise,depth-all,scene-bars", "--strengths", "1,3", "--methods",
                "trim3r,random", "--keep", "20,5", "--csv", table, "--html", page, "--worst", "2").stdout
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
        file.seek(0)
        check(next(csv.reader(file)) == COLUMNS, "the columns and their order")
    cells = [("unperturbed", "0"), ("noise", "4"), ("noise", "32"), ("depth-all", "99"), ("depth-all", "100"),
             ("scene-bars", "8"), ("scene-bars", "2")]
    check([(r["perturbation"], r["strength"], r["keep"], r["method"]) for r in rows] ==
          [(*cell, k, m) for cell in cells for k in ("20", "5") for m in ("trim3r", "random")], "the rows in order")
    for row in rows:
        refused = (row["perturbation"], row["strength"]) == ("depth-all", "100")
        check(row["status"] == ("refused" if refused else "measured"), f"{row}")
        check(("no valid depth" in row["reason"]) == refused, "a refusal has a reason")
        budget = round(2 * 48 * 48 * float(row["keep"]) / 100)
        near(int(row["budget"]), budget, 1, "the budget is that of the unperturbed frames")
        if not refused:
            fewer = row["perturbation"] == "depth-all"
            check(int(row["gaussians"]) < budget if fewer and row["keep"] == "20" else
                  int(row["gaussians"]) <= budget if fewer else row["gaussians"] == row["budget"], "exactly Z")
            check(float(row["flicker"]) > 0 and float(row["psnr"]) > 0, "figures")
            check((row["mask_changed"] == "") == (row["perturbation"] in ("noise", "depth-all")), "still scenes")
    lines = [line for line in shown.splitlines() if line.startswith("noise ")]
    check(len(lines) == 2 * 4 * 2, "a line a strength in a table a budget and measure")
    check("28 rows: 24 measured, 4 refused with a reason, 0 with a broken invariant" in shown, shown)
    check("refused  depth-all 100 %: " in shown and "noise at its middle strength" not in shown, "the verdict")
    text = open(page).read()
    check(text.count("<section") == 2 and not re.search(r"https?:|<script", text), "the worst two, on a page alone")
    return {(r["perturbation"], r["strength"], r["keep"], r["method"]): r for r in rows}


def against_eval(folder, by):
    """Unperturbed frames, developed and recorded again, give the figures of the recording."""
    room = f"{folder}/room.mcap"
    run(trim3r, "room", "--size", "48x48", "-o", room)
    answer = json.loads(run(trim3r, "eval", room, "--context", "0,2", "--target", "1", "--keep", "20,5", "--methods",
                            "trim3r,random", "--json").stdout)["rows"]
    for row in answer:
        mine = by["unperturbed", "0", f"{row['keep']:g}", row["method"]]
        for name in ("gaussians", "psnr", "ssim", "holes", "arena_bytes"):
            near(float(mine[name]), row[name], 1e-3, f"{name} of {row['method']} at {row['keep']} %")
        check(float(mine["psnr_lost"]) == 0, "nothing is lost against itself")
    noisy = by["noise", "32", "20", "trim3r"]
    plain = by["unperturbed", "0", "20", "trim3r"]
    near(float(noisy["psnr_lost"]), float(plain["psnr"]) - float(noisy["psnr"]), 1e-3, "a loss is a difference")
    check(float(noisy["psnr_lost"]) > 1, "noise costs")
    recorded = rows_of(room, "--rows", "noise", "--strengths", "3", "--methods", "trim3r,random", "--keep", "20,5")
    for row in recorded:
        mine = by[row["perturbation"], f"{row['strength']:g}", f"{row['keep']:g}", row["method"]]
        check((row["psnr"], row["flicker"]) == (float(mine["psnr"]), float(mine["flicker"])), "the recording is the room")
    return room


def again(room):
    arguments = [room, "--rows", "pose,depth-noise", "--strengths", "2", "--triplets", "2", "--methods", "trim3r,eagles"]
    first, second = rows_of(*arguments), rows_of(*arguments)
    check([timeless(r) for r in first] == [timeless(r) for r in second], "the same figures every time")
    check(len(first) == 2 * 3 * 2 and len({(r["context"], r["target"]) for r in first}) == 2, "two triplets")
    alone = rows_of(*arguments, "--captures", "0", "--methods", "eagles")
    check([r["psnr"] for r in alone] == [r["psnr"] for r in first if r["method"] == "eagles"], "alone as beside others")
    check(all(r["flicker"] is None for r in alone), "no captures, no flicker")


def errors(folder):
    for arguments, text in ((["--rows", "noise,sunburn"], "sunburn"), (["--strengths", "4"], "--strengths"),
                            (["--captures", "1"], "--captures"), (["--methods", "magic"], "magic")):
        said = run(trim3r, "stress", *SMALL, *arguments, expect=2).stderr
        check(text in said, said)
    twins = [f"{folder}/{place}/x.mcap" for place in "ab"]
    for twin in twins:
        os.makedirs(os.path.dirname(twin))
        run(trim3r, "room", "--size", "48x48", "-o", twin)
    said = run(trim3r, "stress", *SMALL, *twins, "--rows", "noise", expect=2).stderr
    check("would have the same name" in said and all(twin in said for twin in twins), said)
    said = run(trim3r, "stress", *SMALL, "--csv", f"{folder}/no/where.csv", expect=1).stderr
    check("where.csv" in said, said)
    said = run(trim3r, "stress", *SMALL, "--arena", "1000", "--rows", "noise", expect=1).stderr
    check("too small" in said, said)


def with_a_backdrop():
    """A backdrop is of no view, so it is in no mask and does not move."""
    rows = rows_of(*SMALL, "--rows", "noise", "--strengths", "3", "--methods", "trim3r,random", "--keep", "20", "--backdrop", "on")
    for row in rows:
        check(row["status"] == "measured" and row["gaussians"] == 922, f"{row}")
    still = {row["method"]: row["mask_changed"] for row in rows if row["perturbation"] == "unperturbed"}
    check(0 < still["trim3r"] < 0.1 and 0 <= still["random"] <= 1, f"masks of a still scene: {still}")


with tempfile.TemporaryDirectory() as folder:
    figures = table_and_page(folder)
    again(against_eval(folder, figures))
    errors(folder)
with_a_backdrop()
done()
