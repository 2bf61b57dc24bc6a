#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_room.py TRIM3R SCORE.PY: `trim3r eval` on the built-in room, small: rows, columns, masks, pictures, and the
independent scorer's figures of the written pictures (if the scorer is there)."""
import csv
import json
import os
import re
import shutil
import sys
import tempfile

from checks import check, done, near, run
from common import load_scorer, need_numpy

numpy, cv2 = need_numpy()
trim3r = sys.argv[1]
scorer = load_scorer(sys.argv[2])
COLUMNS = ("scene context target method head bits refine allocate depth ablation wavelet levels clusters settings keep requested gaussians "
           "psnr_all ssim_all perceptual_all psnr ssim sharp holes psnr_seen context_psnr perceptual build_ms render_ms arena_bytes "
           "scene_bytes planar_psnr loss picture bits_epoch").split()
SCORES = ("gaussians", "psnr_all", "ssim_all", "perceptual_all", "psnr", "ssim", "sharp", "holes", "psnr_seen", "context_psnr",
          "perceptual")


def read(path, grey=False):
    image = cv2.imread(path, cv2.IMREAD_GRAYSCALE if grey else cv2.IMREAD_COLOR)
    check(image is not None, f"{path} is missing")
    return image


def read_csv(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
        file.seek(0)
        check(next(csv.reader(file)) == COLUMNS, "the columns and their order")
    return rows


def check_scores(row, target, render, mask, pixels, psnr="psnr"):
    """Computes the row's figures of these pixels from the pictures alone."""
    error = ((target.astype(float) - render) ** 2)[mask].mean()
    near(float(row[psnr + pixels]), 10 * numpy.log10(255**2 / error) if error > 0 else 99, 0.02, psnr + pixels)
    if scorer is not None:
        figures = scorer.score(target.astype(float), render.astype(float), mask)
        near(float(row[psnr + pixels]), figures["psnr"], 0.02, psnr + pixels)
        near(float(row["ssim" + pixels]), figures["ssim"], 0.001, "ssim" + pixels)
        if pixels == "":
            near(float(row["sharp"]), figures["sharp"], 0.001, "sharp")
    check(0 < float(row["perceptual" + pixels]) < 1, "perceptual lies within 0..1")


def evaluate_triplet(folder, room):
    keeps = ["100", "20", "2.5"]
    pictures, table, page = f"{folder}/pictures", f"{folder}/a.csv", f"{folder}/page.html"
    shown = run(trim3r, "eval", room, "--context", "0,2", "--target", "1", "--keep", ",".join(keeps), "--methods",
                "trim3r,random", "--csv", table, "--images", pictures, "--html", page).stdout
    rows = read_csv(table)
    check([(r["method"], r["keep"]) for r in rows] == [(m, k) for m in ("trim3r", "random") for k in keeps],
          "one row a method and budget, in the order asked for")
    check(len(shown.splitlines()) == 1 + len(rows), "a heading and a line a row")
    check(sorted(os.listdir(f"{pictures}/1")) ==
          sorted(["target.png", "mask.png", "context_a.png", "context_b.png"] +
                 [f"{m}_{k}.png" for m in ("trim3r", "random") for k in keeps]), "the pictures' names")
    target, mask = read(f"{pictures}/1/target.png"), read(f"{pictures}/1/mask.png", grey=True)
    check(target.shape == (64, 64, 3), "pictures have the working size")
    check(set(numpy.unique(mask)) == {0, 255}, "the mask is black and white")
    mask = mask > 127
    check(0.5 < mask.mean() < 1, f"context views see much of the room: {mask.mean()}")
    for row in rows:
        check((row["scene"], row["context"], row["target"], row["depth"]) == ("room", "0,2", "1", "sensor"), "names")
        check((row["head"], row["allocate"]) ==
              ("small", "density" if row["method"] == "trim3r" else ""), "settings")
        check(row["planar_psnr"] == "" and row["bits"] == "8", "cells that do not apply are empty")
        check((row["wavelet"], row["levels"], row["clusters"]) == ("db2", "2", "auto" if row["method"] == "trim3r" else ""),
              "wavelet and SuperClusters")
        check(row["picture"] == f"1/{row['method']}_{row['keep']}.png", "where the picture is")
        check(int(row["scene_bytes"]) == 44 * int(row["gaussians"]), "bytes of the scene")
        render = read(f"{pictures}/1/{row['method']}_{row['keep']}.png")
        check_scores(row, target, render, mask, "")
        check_scores(row, target, render, numpy.ones_like(mask), "_all")
        check(row["psnr_seen"] == row["psnr"], "all frames have depth")
        check(0 <= float(row["holes"]) <= 1 and int(row["arena_bytes"]) > 0, "holes and arena")
        check(float(row["build_ms"]) > 0 and float(row["render_ms"]) > 0, "times")
    full = int(rows[0]["gaussians"])
    for row in rows:
        near(int(row["gaussians"]), full * float(row["keep"]) / 100, 0.5, "keep is percent of the valid points")
    by = {(r["method"], r["keep"]): r for r in rows}
    check(float(by["trim3r", "2.5"]["psnr"]) > float(by["random", "2.5"]["psnr"]) + 3, "adapting beats not adapting")
    check(float(by["random", "2.5"]["holes"]) > float(by["trim3r", "2.5"]["holes"]), "unadapted points leave holes")
    check(float(by["trim3r", "100"]["psnr"]) > float(by["trim3r", "2.5"]["psnr"]), "more points, more likeness")
    check(float(by["trim3r", "100"]["context_psnr"]) > 20, "the context views are met")
    text = open(page).read()
    check(text.count("<figure>") == 4 + len(rows) and not re.search(r"https?:|<script", text), "the page stands alone")
    check(text.count("class=\"view compared\"") == len(rows), "every render can show its error")


def evaluate_all(folder, room):
    triplets = json.loads(run(trim3r, "info", room, "--json").stdout)
    table = f"{folder}/all.csv"
    answer = json.loads(run(trim3r, "eval", room, "--keep", "10", "--csv", table, "--json").stdout)
    rows = read_csv(table)
    check(len(rows) >= 1 and len(rows) == len(answer["rows"]), f"one row a triplet: {triplets}")
    check(len({(r["context"], r["target"]) for r in rows}) == len(rows), "triplets differ")
    check(list(answer["rows"][0]) == COLUMNS, "JSON has the columns")
    mean = answer["means"][0]
    near(mean["psnr"], sum(r["psnr"] for r in answer["rows"]) / len(rows), 1e-3, "means are means of decibels")
    for row, other in zip(rows, answer["rows"]):
        check(int(row["gaussians"]) == other["gaussians"] and float(row["psnr"]) == other["psnr"], "CSV and JSON agree")


def evaluate_several(folder, room):
    other = f"{folder}/other.mcap"
    shutil.copy(room, other)
    answer = json.loads(run(trim3r, "eval", room, other, "--context", "0,2", "--target", "1", "--keep", "5,10",
                            "--images", f"{folder}/both", "--json").stdout)
    check([(r["scene"], r["keep"]) for r in answer["rows"]] == [(s, k) for s in ("room", "other") for k in (5, 10)],
          "scenes")
    check([m["scene"] for m in answer["means"]] == ["room", "room", "other", "other"], "means stay within a recording")
    for scene in ("room", "other"):
        check(os.path.exists(f"{folder}/both/{scene}/1/trim3r_5.png"), "a folder a recording")
    check([r["picture"] for r in answer["rows"]] ==
          [f"{s}/1/trim3r_{k}.png" for s in ("room", "other") for k in (5, 10)], "and the table tells")


def evaluate_names(folder, room):
    """Runs that differ in a column of the table may share a folder of pictures."""
    rows = []
    for more in ((), ("--refine", "0"), ("--wavelet", "haar", "--levels", "3"), ("--clusters", "50", "--allocate", "paper"),
                 ("--head", "analytic"), ("--context", "0,3"), ("--refine", "0", "--ablate=full,k-5")):
        context = () if "--context" in more else ("--context", "0,2")
        rows += json.loads(run(trim3r, "eval", room, *context, *more, "--target", "1", "--keep", "5", "--images",
                               f"{folder}/names", "--json").stdout)["rows"]
    names = [r["picture"] for r in rows]
    check(names == ["1/trim3r_5.png", "1/trim3r_refine-0_5.png", "1/trim3r_haar_levels-3_5.png",
                    "1/trim3r_clusters-50_paper_5.png", "1/trim3r_analytic_5.png", "1/trim3r_5.png", "1/full_refine-0_5.png",
                    "1/k-5_refine-0_5.png"], f"names: {names}")
    check(all(os.path.exists(f"{folder}/names/{name}") for name in names), "and the files")
    check((rows[2]["wavelet"], rows[2]["levels"], rows[3]["clusters"], rows[7]["clusters"]) == ("haar", "3", "50", "5"),
          "columns")


def evaluate_one_target_twice(folder):
    """Checks two triplets of a recording with the same target and different contexts."""
    made = f"{folder}/made"
    os.mkdir(made)
    random = numpy.random.default_rng(1)
    frames = []
    for i in range(4):
        cv2.imwrite(f"{made}/{i}.png", random.integers(0, 255, (32, 32, 3), dtype=numpy.uint8))
        cv2.imwrite(f"{made}/{i}.depth.png", numpy.full((32, 32), 2000, dtype=numpy.uint16))
        pose = numpy.eye(4)
        pose[0, 3] = i / 50
        frames.append({"file_path": f"{i}.png", "depth_path": f"{i}.depth.png", "transform_matrix": pose.tolist()})
    with open(f"{made}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"fl_x": 32, "fl_y": 32, "cx": 16, "cy": 16, "w": 32, "h": 32, "integer_depth_scale": 0.001,
                   "frames": frames, "trim3r_triplets": [{"context": [0, 2], "target": 1},
                                                         {"context": [0, 3], "target": 1}]}, file)
    run(trim3r, "import", made, "--size", "32x32", "-o", f"{made}.mcap")
    rows = json.loads(run(trim3r, "eval", f"{made}.mcap", "--keep", "50", "--head", "analytic", "--refine", "0", "--images",
                          f"{folder}/twice", "--json").stdout)["rows"]
    check([(r["context"], r["picture"]) for r in rows] == [("0,2", "1/trim3r_analytic_refine-0_50.png"),
                                                           ("0,3", "1_from_0_3/trim3r_analytic_refine-0_50.png")],
          f"a folder each: {[r['picture'] for r in rows]}")
    check(os.path.exists(f"{folder}/twice/1_from_0_3/target.png"), "with its recorded views")


def evaluate_variants(folder, room):
    """Checks that settings have an effect exactly where they should."""
    common = [trim3r, "eval", room, "--context", "0,2", "--target", "1", "--keep", "20", "--json"]

    def row(*more):
        return json.loads(run(*common, *more).stdout)["rows"][0]

    plain = row()
    least = row("--arena", "min")
    check([least[s] for s in SCORES] == [plain[s] for s in SCORES], "the smallest arena scores the same")
    check(least["arena_bytes"] < plain["arena_bytes"], "and is smaller")
    check(row("--context", "2,2")["context"] == "2", "a context frame named twice counts once")
    near(row("--from-file")["psnr"], plain["psnr"], 0.05, "the exported file looks like the memory it came from")
    analytic = row("--head", "analytic", "--allocate", "uniform")
    check((analytic["head"], analytic["allocate"]) == ("analytic", "uniform") and analytic["psnr"] != plain["psnr"],
          "settings count")


def evaluate_heads(folder, room):
    """Checks that each head's rows equal those of that head alone; weight files next to shipped heads."""
    heads = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "quant", "heads")
    for bits in ("8", "16"):
        run(trim3r, "quantize", f"{heads}/tiny.safetensors", "--calibrate", room, "--name", "mine", "--weights", "8",
            "--activations", bits, "-o", f"{folder}/mine{bits}.t3w")
    common = ["--context", "0,2", "--target", "1", "--keep", "20,5"]
    names = ["analytic", "tiny", "small", f"{folder}/mine8.t3w", f"{folder}/mine16.t3w"]
    labels = ["analytic", "tiny", "small", "mine", "mine_w8a16"]
    answer = json.loads(run(trim3r, "eval", room, *common, "--heads", ",".join(names), "--methods", "random,trim3r",
                            "--images", f"{folder}/heads", "--html", f"{folder}/heads.html", "--json").stdout)
    rows = answer["rows"]
    check([(r["method"], r["head"], r["bits"], r["keep"]) for r in rows] ==
          [("random", "small", "8", k) for k in (20, 5)] +
          [("trim3r", n, b, k) for n, b in zip(["analytic", "tiny", "small", "mine", "mine"],
                                              [None, "8", "8", "8", "8/16"]) for k in (20, 5)],
          f"rows a head: {rows}")
    check({f"{label}_{k}.png" for label in ["random", *labels] for k in (20, 5)} <= set(os.listdir(f"{folder}/heads/1")),
          "pictures a head")
    page = open(f"{folder}/heads.html").read()
    check(all(label in page for label in labels), "the page tells the heads")
    for name, alone in zip(names, range(2, len(rows), 2)):
        row = json.loads(run(trim3r, "eval", room, *common, "--head", name, "--json").stdout)["rows"][0]
        check([row[s] for s in SCORES] == [rows[alone][s] for s in SCORES], f"{name} alone and beside others")
    tiny, mine = ([r["psnr"] for r in rows if (r["head"], r["bits"]) == (name, "8")] for name in ("tiny", "mine"))
    check(tiny == mine, "the shipped head is what its float file gives")
    check(len({tuple(r[s] for s in SCORES) for r in rows}) == len(rows) - len(tiny), "all others differ")


def evaluate_rivals(folder, room):
    """Checks every method: exact counts, the unpruned scene at 100 %, a row with pictures and times."""
    rivals = ["random", "eagles", "lightgaussian", "pup", "efficientgs"]
    methods = ["trim3r", *rivals, "trim3r+finetune", *(f"{rival}+finetune" for rival in rivals)]
    keeps = [100, 30, 5]
    common = ["--context", "0,2", "--target", "1", "--working", "32x32", "--rim", "off", "--finetune-iterations", "25", "--json"]
    answer = json.loads(run(trim3r, "eval", room, *common, "--keep", ",".join(map(str, keeps)), "--methods",
                            ",".join(methods), "--images", f"{folder}/rivals").stdout)
    by = {(row["method"], row["keep"]): row for row in answer["rows"]}
    check(list(by) == [(m, k) for m in methods for k in keeps], "one row a method and budget, in the order asked for")
    for (name, keep), row in by.items():
        check(row["gaussians"] == by["trim3r", keep]["gaussians"], f"{name} at {keep} %: the count of trim3r")
        check((row["head"], row["bits"], row["refine"]) == ("small", "8", by["trim3r", keep]["refine"]), "settings")
        check((row["allocate"] is None) == (not name.startswith("trim3r")), "rivals have no allocation")
        check(row["picture"] == f"1/{name}_rim-off_working-32x32_iterations-25_{keep}.png", "pictures tell settings, or are confused")
        check(os.path.exists(f"{folder}/rivals/{row['picture']}"), "a picture a row")
    for rival in rivals:
        check([by[rival, 100][s] for s in SCORES] == [by["trim3r", 100][s] for s in SCORES],
              f"{rival} at 100 % is the unpruned scene, unchanged")
        check(by[rival, 100]["build_ms"] > by["trim3r", 100]["build_ms"] * 0.2, "scoring is part of the time")
        for keep in (30, 5):
            tuned, plain = by[f"{rival}+finetune", keep], by[rival, keep]
            check(plain["psnr"] < by["trim3r", keep]["psnr"] - 3, f"{rival} at {keep} %: nothing fills the holes")
            check(tuned["context_psnr"] > plain["context_psnr"] + 2, f"{rival} at {keep} %: fine-tuning fits the context")
            check(tuned["build_ms"] > plain["build_ms"], "fine-tuning is part of the time")
    check(by["trim3r+finetune", 30]["context_psnr"] > by["trim3r", 30]["context_psnr"] + 1, "trim3r can be tuned too")
    check(len({by[rival, 30]["psnr"] for rival in rivals}) == len(rivals), "the scores differ")
    again = json.loads(run(trim3r, "eval", room, *common, "--keep", "5", "--methods", "pup+finetune").stdout)["rows"][0]
    check([again[s] for s in SCORES] == [by["pup+finetune", 5][s] for s in SCORES], "alone as beside others")
    other = json.loads(run(trim3r, "eval", room, *common, "--keep", "30", "--methods", "random,eagles", "--head",
                           "analytic", "--refine", "0", "--seed", "2").stdout)["rows"]
    check(all(row["head"] == "analytic" and row["psnr"] != by[row["method"], 30]["psnr"] for row in other),
          "rivals prune the scene of the head that is named")


def evaluate_planar(folder):
    random = numpy.random.default_rng(2)
    image = cv2.GaussianBlur(random.integers(0, 256, (90, 120, 3)).astype(numpy.uint8), (0, 0), 2.5)
    image = cv2.normalize(image, None, 0, 255, cv2.NORM_MINMAX)
    cv2.imwrite(f"{folder}/photo.png", image)
    cv2.imwrite(f"{folder}/grey.png", image[..., 0])
    run(trim3r, "eval", "--planar", f"{folder}/photo.png", f"{folder}/grey.png", "--size", "48x48", "--keep", "100,10",
        "--csv", f"{folder}/planar.csv", "--images", f"{folder}/planar")
    rows = read_csv(f"{folder}/planar.csv")
    check([(r["scene"], r["keep"]) for r in rows] == [(s, k) for s in ("photo", "grey") for k in ("100", "10")],
          "planar rows")
    target = read(f"{folder}/planar/photo/target.png")
    check(target.shape == (48, 48, 3), "the size of planar pictures")
    expected = cv2.resize(image[:, 15:105], (48, 48), interpolation=cv2.INTER_AREA)
    check(numpy.abs(target.astype(int) - expected).max() <= 1, "the largest centred crop, averaged")
    for row in rows:
        check(row["context"] == row["target"] == row["psnr"] == row["context_psnr"] == "" and row["depth"] == "plane",
              "a plane has neither target nor mask")
        folder_of = f"{folder}/planar/{row['scene']}"
        render = read(f"{folder_of}/trim3r_{row['keep']}.png")
        check_scores(row, read(f"{folder_of}/target.png"), render, numpy.ones((48, 48), bool), "", "planar_psnr")
    check(int(rows[0]["gaussians"]) == 48 * 48 and int(rows[1]["gaussians"]) == 230, "every pixel is a point")
    check(float(rows[0]["planar_psnr"]) > 25 and float(rows[0]["planar_psnr"]) > float(rows[1]["planar_psnr"]),
          "likeness")


def evaluate_namesakes(folder):
    for name in ("one", "two"):
        os.mkdir(f"{folder}/{name}")
        shutil.copy(f"{folder}/photo.png", f"{folder}/{name}/photo.png")
    run(trim3r, "eval", "--planar", f"{folder}/one/photo.png", f"{folder}/two/photo.png", "--size", "48x48", "--keep", "10",
        "--csv", f"{folder}/namesakes.csv")
    check([r["scene"] for r in read_csv(f"{folder}/namesakes.csv")] == ["one-photo", "two-photo"],
          "images of one name are told apart by their folders")


with tempfile.TemporaryDirectory() as folder:
    room = f"{folder}/room.mcap"
    run(trim3r, "room", "--size", "64x64", "-o", room)
    evaluate_triplet(folder, room)
    evaluate_all(folder, room)
    evaluate_several(folder, room)
    evaluate_names(folder, room)
    evaluate_one_target_twice(folder)
    evaluate_variants(folder, room)
    evaluate_heads(folder, room)
    evaluate_rivals(folder, room)
    evaluate_planar(folder)
    evaluate_namesakes(folder)
if scorer is None:
    print(f"without the scorer: nothing at {sys.argv[2]}")
done()
