#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_ablate.py TRIM3R: `trim3r eval --ablate` on the built-in room, small: the rows and their settings, and the
table."""
import csv
import json
import math
import os
import re
import sys
import tempfile

from checks import check, done, run

trim3r = sys.argv[1]
NAMES = ["full", "no-adaptation", "no-mask", "random", "random-clusters", "paper-random-clusters", "uniform", "paper",
         "pixel", *(f"k-{k}" for k in (5, 25, 50, 100, 200, 300, 400)), *(f"n-{n}" for n in (5, 10, 15, 20)),
         "no-refinement", "no-flying", "no-redundancy", "no-exposure"]
SCORES = ("gaussians", "psnr", "ssim", "sharp", "holes", "psnr_all", "psnr_seen", "context_psnr", "perceptual")
KEEPS = (30, 5)


def rows_of(*arguments):
    return json.loads(run(trim3r, "eval", *arguments, "--json").stdout)["rows"]


def scores(row):
    return [row[s] for s in SCORES]


def cells(text):
    """Returns {(scene, ablation): cells} of a Markdown table, and its keeps."""
    lines = [[cell.strip() for cell in line.strip("|\n").split("|")] for line in text.splitlines()]
    check(all(len(line) == len(lines[0]) for line in lines), "a table has as many cells in every line")
    check(lines[0][:2] == ["scene", "ablation"] and set("".join(lines[1])) == {"-"}, "a heading")
    table, scene = {}, ""
    for line in lines[2:]:
        scene = line[0] or scene
        check((scene, line[1]) not in table, "no line stands twice")
        table[scene, line[1]] = line[2:]
    return table, lines[0][2:]


def tells(cell, psnr, ssim):
    """Whether a cell shows these figures, which were already rounded to 4 and 5 places."""
    shown = [float(part) for part in cell.split(" / ")]
    return abs(shown[0] - float(psnr)) < 0.0052 and abs(shown[1] - float(ssim)) < 0.00052


def what_each_row_is(room, one):
    """Compares each row with the evaluation by the option for its setting, if there is one."""
    rows = rows_of(*one, "--ablate", "--keep", ",".join(map(str, KEEPS)))
    check([(r["ablation"], r["keep"]) for r in rows] == [(n, k) for n in NAMES for k in KEEPS], "all, in order")
    by = {(r["ablation"], r["keep"]): r for r in rows}
    whole = rows_of(*one, "--keep", "100")[0]["gaussians"]
    for r in rows:
        check(r["gaussians"] == math.floor(whole * r["keep"] / 100 + 0.5), f"the budget is met exactly: {r}")
        check((r["method"], r["head"]) == ("trim3r", "small"), "the head chosen")
    options = {"full": []}
    options |= {a: ["--allocate", a] for a in ("random", "uniform", "paper", "pixel")}
    options |= {f"k-{k}": ["--clusters", k] for k in (5, 25, 50, 100, 200, 300, 400)}
    options |= {f"n-{n}": ["--allocate", "paper", "--keep-percent", n] for n in (5, 10, 15, 20)}
    options |= {f"no-{a}": [f"--{a}", "off"] for a in ("flying", "redundancy", "exposure")}
    options["no-refinement"] = ["--refine", "0"]
    for name, option in options.items():
        for row in rows_of(*one, "--keep", ",".join(map(str, KEEPS)), *option):
            check(row["ablation"] is None, "a plain evaluation ablates nothing")
            same = by[name, row["keep"]]
            check(scores(row) == scores(same), f"{name} is the evaluation with {option}")
            check((row["allocate"], row["refine"]) == (same["allocate"], same["refine"]), "and says so")
    check({*NAMES} - {*options} == {"no-adaptation", "no-mask", "random-clusters", "paper-random-clusters"}, "the rest")

    for keep in KEEPS:
        full, paper = by["full", keep], by["paper", keep]
        for name in ("no-adaptation", "no-mask", "random", "random-clusters", "uniform", "paper", "k-5", "no-refinement"):
            check(scores(by[name, keep]) != scores(full), f"{name} changes something at {keep} %")
        check(by["no-adaptation", keep]["psnr"] < full["psnr"] - 3, "adapting is worth much")
        check(by["no-adaptation", keep]["holes"] > full["holes"], "and fills holes")
        check(by["no-refinement", keep]["psnr"] < full["psnr"] - 1, "so is refining")
        # with 10 % of all clusters kept, 5 % in all are the same share of each, in any order
        check((scores(by["paper-random-clusters", keep]) != scores(paper)) == (keep > 10), "the paper's order")
    check(scores(by["n-5", 30]) != scores(by["n-20", 30]), "N")
    check(scores(by["no-redundancy", 5]) != scores(by["full", 5]), "redundancy counts at small budgets")

    base = rows_of(*one, "--ablate=full,random-clusters", "--keep", "30", "--seed", "2")[1]
    check(scores(base) != scores(by["random-clusters", 30]), "the seed shuffles")
    check(base["gaussians"] == by["random-clusters", 30]["gaussians"], "and the budget stays")


def closed_forms(one):
    """Without adaptation the head `analytic` is the head `none`; a head without weights has no mask to hide."""
    for refine in ("0", "1"):
        rows = rows_of(*one, "--keep", "100,10", "--ablate=no-adaptation", "--head", "analytic", "--refine", refine)
        none = rows_of(*one, "--keep", "100,10", "--head", "none", "--refine", refine)
        check([scores(r) for r in rows] == [scores(r) for r in none], "nothing adapted")
    rows = rows_of(*one, "--ablate", "--head", "analytic", "--keep", "5")
    check([r["ablation"] for r in rows] == [n for n in NAMES if n != "no-mask"], "analytic has no weights")
    by = {r["ablation"]: r for r in rows}
    check(by["no-adaptation"]["psnr"] < by["full"]["psnr"] - 3, "analytic adapts")
    rows = rows_of(*one, "--ablate", "--head", "none", "--keep", "5", "--working", "32x32")
    check([r["ablation"] for r in rows] == [n for n in NAMES if n not in ("no-mask", "no-adaptation")], "nor adapts none")


def defaults_and_table(folder, room, one):
    table_file = f"{folder}/ablations.csv"
    named = "--ablate=no-mask,full"
    shown = run(trim3r, "eval", *one, named, "--csv", table_file, "--images", f"{folder}/pictures", "--html",
                f"{folder}/page.html").stdout
    with open(table_file, newline="") as file:
        rows = list(csv.DictReader(file))
    check([(r["ablation"], r["keep"]) for r in rows] == [(n, k) for n in ("no-mask", "full")
                                                         for k in ("60", "40", "20", "10", "5")], "the default keeps")
    table, keeps = cells(shown)
    check(keeps == ["60 %", "40 %", "20 %", "10 %", "5 %"], f"the columns: {keeps}")
    check(list(table) == [("room", "no-mask"), ("room", "full")], "the lines, as named")
    for name in ("no-mask", "full"):
        expected = [r for r in rows if r["ablation"] == name]
        for cell, row in zip(table["room", name], expected, strict=True):
            check(tells(cell, row["psnr"], row["ssim"]), f"the table tells the rows: {cell}, {row}")
    check({f"{n}_{k}.png" for n in ("no-mask", "full") for k in (60, 5)} <= set(os.listdir(f"{folder}/pictures/1")),
          "pictures are named after the ablation")
    page = open(f"{folder}/page.html").read()
    check("no-mask" in page and "<th>ablation" in re.sub(r"\s", "", page), "so is the page")

    # several recordings: a block each, then the mean of the recordings' means; several triplets: means of decibels
    other = f"{folder}/other.mcap"
    run(trim3r, "room", "--size", "48x48", "-o", other)
    both = [room, other, "--ablate=full,uniform", "--keep", "10", "--refine", "0"]
    answer = json.loads(run(trim3r, "eval", *both, "--json").stdout)
    means = {(m["scene"], m["ablation"]): m for m in answer["means"]}
    check(list(means) == [(s, n) for s in ("room", "other") for n in ("full", "uniform")], "means a recording")
    for (scene, name), mean in means.items():
        values = [r["psnr"] for r in answer["rows"] if (r["scene"], r["ablation"]) == (scene, name)]
        check(len(values) > 1 and abs(mean["psnr"] - sum(values) / len(values)) < 1e-3, "means of decibels")
    table, keeps = cells(run(trim3r, "eval", *both).stdout)
    check(list(table) == [*means, ("mean", "full"), ("mean", "uniform")] and keeps == ["10 %"], "blocks")
    for (scene, name), mean in means.items():
        check(tells(table[scene, name][0], mean["psnr"], mean["ssim"]), "a recording's means")
    for name in ("full", "uniform"):
        psnr = float(table["mean", name][0].split(" / ")[0])
        check(abs(psnr - (means["room", name]["psnr"] + means["other", name]["psnr"]) / 2) < 0.006, "their mean")


def planar(folder, room):
    run(trim3r, "eval", room, "--context", "0", "--target", "1", "--keep", "5", "--images", f"{folder}/plain")
    image = f"{folder}/plain/1/target.png"
    common = ["--planar", image, "--size", "32x32", "--ablate", "--keep", "10"]
    rows = rows_of(*common)
    check([r["ablation"] for r in rows] == NAMES[:-3], "one view: nothing between views")
    check(len({r["gaussians"] for r in rows}) == 1, "one budget")
    table, _ = cells(run(trim3r, "eval", *common).stdout)
    for row in rows:
        check(tells(table["mean", row["ablation"]][0], row["planar_psnr"], row["ssim"]), "planar_psnr in the table")


with tempfile.TemporaryDirectory() as folder:
    room = f"{folder}/room.mcap"
    run(trim3r, "room", "--size", "40x40", "-o", room)
    one = [room, "--context", "0,2", "--target", "1"]
    what_each_row_is(room, [*one, "--rim", "off"])
    closed_forms([*one, "--rim", "off"])
    defaults_and_table(folder, room, one)
    planar(folder, room)
    text = re.sub(r"\s+", " ", run(trim3r, "eval", "--help").stdout)
    for name in NAMES:
        check(re.search(rf"[ ,]{name}[,:. ]", text), f"the help says what {name} is")
    # named ablations that do not apply
    for head, name in (("analytic", "no-mask"), ("none", "no-adaptation")):
        check("does not apply" in run(trim3r, "eval", *one, f"--ablate={name}", "--head", head, expect=2).stderr, name)
    check("does not apply" in run(trim3r, "eval", "--planar", f"{folder}/plain/1/target.png", "--ablate=no-flying",
                                  expect=2).stderr, "no-flying of a plane")
done()
