#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stress_all.py TRIM3R ours|rivals|settings: every perturbation and drawn scene in every strength, small: no crash,
no broken invariant, and no finding of sanitizers. ours: with noisy captures and still scenes, from as many
Gaussians as SuperClusters up; rivals: as published, fine-tuned, and as points for our head; settings: budgets in
other ways, `--auto`, depth by stereo."""
import json
import sys

from checks import check, done, run

trim3r, part = sys.argv[1:]
PERTURBATIONS, SCENES, STRENGTHS = 20, 5, 3
MAY_REFUSE = {("depth-all", 99.9), ("depth-all", 100)}  # with few pixels a view may have none
RIVALS = ("random", "eagles", "lightgaussian", "pup", "efficientgs")
SMALL = ("--working", "24x24", "--clusters", "40")
HARD = ("--rows", "noise,depth-blobs,pose,black,near,scene-foliage", "--strengths", "3")


def cells(*arguments, may_refuse=MAY_REFUSE):
    answer = json.loads(run(trim3r, "stress", "--json", *arguments).stdout)
    check(answer["broken"] == 0, f"{arguments}: broken invariants")
    for row in answer["rows"]:
        check(row["status"] in ("measured", "refused"), f"{arguments}: {row}")
        if row["status"] == "refused":
            check((row["perturbation"], row["strength"]) in may_refuse and row["reason"], f"{arguments}: {row}")
    return answer["rows"]


def all_of(rows, methods, strengths=STRENGTHS):
    expected = (1 + (PERTURBATIONS + SCENES) * strengths) * methods
    check(len(rows) == expected, f"every cell: {len(rows)} rows of {expected}")
    return rows


def ours():
    rows = all_of(cells(*SMALL), 1)
    still = [r for r in rows if r["mask_changed"] is not None]
    check(len(still) == 1 + SCENES * STRENGTHS, "still scenes")
    check(all(r["gaussians"] >= 40 and r["mask_changed"] > 0 for r in still), "the invariant covers these rows")
    check(sum(r["flicker"] is not None for r in rows) >= len(rows) - 2, "flicker")


def rivals():
    all_of(cells(*SMALL, "--captures", "0", "--methods", ",".join(RIVALS)), len(RIVALS))
    for way in ("head", "finetune"):
        methods = [f"{m}+{way}" for m in (*RIVALS, *(("trim3r",) if way == "finetune" else ()))]
        rows = cells(*SMALL, *HARD, "--finetune-iterations", "3", "--methods", ",".join(methods))
        check(len(rows) == 7 * len(methods) and {r["method"] for r in rows} == set(methods), f"every rival with +{way}")


def settings():
    for options in (("--keep", "8,100", "--head", "analytic"), ("--allocate", "paper", "--head", "tiny"),
                    ("--allocate", "pixel", "--threads", "2", "--arena", "min")):
        cells(*SMALL, "--captures", "0", "--strengths", "1,3", *options)
    rows = all_of(cells(*SMALL, "--captures", "0", "--strengths", "2", "--auto", "--max-loss", "1"), 1, 1)
    check(len({r["gaussians"] for r in rows}) > 3, "budgets that the program chose")
    # pairs that cannot be matched are refused, with a reason
    every = {(r["perturbation"], r["strength"]) for r in rows}
    rows = all_of(cells("--working", "40x40", "--clusters", "40", "--captures", "0", "--strengths", "2", "--depth",
                        "stereo", may_refuse=every), 1, 1)
    check(sum(r["status"] == "measured" for r in rows) > len(rows) / 2, "most pairs are matched")


{"ours": ours, "rivals": rivals, "settings": settings}[part]()
done()
