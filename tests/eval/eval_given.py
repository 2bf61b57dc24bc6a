#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_given.py TRIM3R: given points: by pictures (`--allocate given --importance`), and by rivals (`+head`), on the
built-in room. Scenes of the head `none`, which leaves points in place, show the retained points."""
import json
import os
import sys
import tempfile

from checks import check, done, near, run
from common import need_numpy

numpy, cv2 = need_numpy()
trim3r = sys.argv[1]
RIVALS = ["random", "eagles", "lightgaussian", "pup", "efficientgs"]
SIDE = 32
SMALL = ["--context", "0,2", "--working", f"{SIDE}x{SIDE}"]
BARE = ["--head", "none", "--refine", "0", "--rim", "off"]
random = numpy.random.default_rng(4)


def gaussians(path):
    """Returns a scene as rows of floats, x y z first."""
    data = open(path, "rb").read()
    head, body = data.split(b"end_header\n", 1)
    fields = [line for line in head.split(b"\n") if line.startswith(b"property")]
    check(all(field.startswith(b"property float") for field in fields) and fields[0].endswith(b" x"), "the format")
    return numpy.frombuffer(body, "<f4").reshape(-1, len(fields))


def build(room, *more, out):
    run(trim3r, "build", room, *SMALL, *more, "-o", out)
    return gaussians(out)


def given(folder, room, pictures, *more):
    return build(room, *BARE, *more, "--allocate", "given", "--importance", pictures, out=f"{folder}/given.ply")


def pictures_choose(folder, room):
    """Checks 16 bits: exactly the brightest points, in the order of views and rows."""
    every = build(room, *BARE, "--keep", "100", out=f"{folder}/every.ply")
    check(len(every) == 2 * SIDE * SIDE, "the room has depth everywhere")
    importance = random.permutation(65536)[:len(every)].astype(numpy.uint16).reshape(2, SIDE, SIDE)
    names = [f"{folder}/first.png", f"{folder}/second.png"]
    os.mkdir(f"{folder}/frames")
    for name, frame, picture in zip(names, (0, 2), importance):
        cv2.imwrite(name, picture)
        cv2.imwrite(f"{folder}/frames/{frame}.png", picture)
    for count in (1, 300, len(every) - 1, len(every)):
        highest = numpy.sort(numpy.argsort(importance.ravel())[::-1][:count])
        for pictures in (",".join(names), f"{folder}/frames"):
            found = given(folder, room, pictures, "--gaussians", count)
            check(numpy.array_equal(found, every[highest]), f"the {count} brightest of {pictures} and no others")
    swapped = given(folder, room, ",".join(reversed(names)), "--gaussians", 300)
    highest = numpy.sort(numpy.argsort(importance[::-1].ravel())[::-1][:300])
    check(numpy.array_equal(swapped, every[highest]), "pictures belong to the context views in their order")

    text = ["--keep", "10", "--allocate", "given", "--importance"]
    hashes = [json.loads(run(trim3r, "replay", room, *SMALL, *text, p, "--json").stdout)["hash"]
              for p in (",".join(names), f"{folder}/frames", ",".join(reversed(names)))]
    check(hashes[0] == hashes[1] != hashes[2], "replay has a hash of it")
    rows = [json.loads(run(trim3r, "eval", room, *SMALL, *text, p, "--target", "1", "--json").stdout)["rows"][0]
            for p in (f"{folder}/frames", ",".join(reversed(names)))]
    check(all((r["method"], r["allocate"], r["gaussians"]) == ("trim3r", "given", round(len(every) / 10)) for r in rows),
          "rows tell the allocation")
    check("importance-" in rows[0]["settings"] and rows[0]["settings"] != rows[1]["settings"], "and which pictures")
    return every, names


def no_more_than_needed(folder, room, names):
    """Checks --auto: as many of the given points as the loss needs, the same in all commands."""
    pictures = ["--allocate", "given", "--importance", ",".join(names)]
    auto = [*pictures, "--auto", "--max-loss", "3"]
    scene = build(room, *auto, out=f"{folder}/auto.ply")
    check(0 < len(scene) < 2 * SIDE * SIDE, f"fewer than all: {len(scene)}")
    exact = build(room, *pictures, "--gaussians", len(scene), out=f"{folder}/exact.ply")
    check(numpy.array_equal(scene, exact), "the scene of so many of the brightest points")
    hashes = [json.loads(run(trim3r, "replay", room, *SMALL, *more, "--json").stdout)["hash"]
              for more in (auto, [*auto, "--threads", "2"], [*auto, "--gaussians", "9"])]
    check(hashes[0] == hashes[1] != hashes[2], "replay has a hash of it")
    row = json.loads(run(trim3r, "eval", room, *SMALL, *auto, "--target", "1", "--json").stdout)["rows"][0]
    check((row["allocate"], row["gaussians"]) == ("given", len(scene)), f"eval takes another number: {row}")
    check(len(build(room, *auto, "--gaussians", "9", out=f"{folder}/few.ply")) == 9, "--gaussians is the most")


def levels_are_spread(folder, room, every):
    """Checks 8 bits: whole levels first; within a level evenly, not row by row."""
    ground = numpy.zeros((SIDE, SIDE), numpy.uint8)
    ground[:, SIDE // 2:] = 200
    ground[:8, :8] = 201
    cv2.imwrite(f"{folder}/ground.png", ground)
    cv2.imwrite(f"{folder}/dark.png", numpy.zeros_like(ground))
    found = given(folder, room, f"{folder}/ground.png,{folder}/dark.png", "--gaussians", 64 + 128)
    rows = {row.tobytes(): i for i, row in enumerate(every)}
    mask = numpy.zeros(len(every), bool)
    mask[[rows[row.tobytes()] for row in found]] = True
    first, second = mask.reshape(2, SIDE, SIDE)
    check(first[:8, :8].all() and not second.any() and first[:, :SIDE // 2].sum() == 64, "the brighter level whole")
    cells = first[:, SIDE // 2:].reshape(4, 8, 2, 8).sum(axis=(1, 3))
    check(cells.min() >= 11 and cells.max() <= 21 and cells.sum() == 128, f"the next one a quarter, everywhere: {cells}")


def errors(folder, room, names):
    def refused(pictures, status, text, *more):
        found = run(trim3r, "build", room, *SMALL, "--keep", "10", *(more or ("--allocate", "given")), "--importance",
                    pictures, "-o", f"{folder}/no.ply", expect=status)
        check(text in found.stderr, f"{pictures}: {found.stderr}")

    cv2.imwrite(f"{folder}/colour.png", random.integers(0, 255, (SIDE, SIDE, 3), numpy.uint8))
    cv2.imwrite(f"{folder}/large.png", numpy.zeros((SIDE, SIDE + 1), numpy.uint8))
    refused(names[0], 2, "1 picture, there are 2 context views")
    refused(",".join(names * 2), 2, "4 pictures")
    refused(f"{names[0]},{folder}/large.png", 1, f"large.png has {SIDE + 1}x{SIDE} pixels")
    refused(f"{names[0]},{folder}/colour.png", 1, "not a grey picture")
    refused(f"{names[0]},{folder}/none.png", 1, "none.png")
    refused(f"{names[0]},", 1, "--importance")
    refused(folder, 1, "0.png")
    refused(",".join(names), 2, "belong together", "--allocate", "density")
    common = ["--keep", "10", "--allocate", "given"]
    check("belong together" in run(trim3r, "build", room, *SMALL, *common, "-o", f"{folder}/no.ply", expect=2).stderr,
          "given needs pictures")
    check("belong together" in run(trim3r, "eval", room, *common, expect=2).stderr, "in an evaluation too")
    check("of its own" in run(trim3r, "stress", *common, "--importance", folder, expect=2).stderr, "not in stress")
    check("not known" in run(trim3r, "build", room, "--prune", f"{folder}/every.ply", "--keep", "10", "--method",
                            "eagles+head", "-o", f"{folder}/no.ply", expect=2).stderr, "a file tells no pixels")


def rivals_choose(folder, room):
    """Checks X+head: exactly the points of X. A head that leaves points in place makes the same scene as X; a disc
    is wider at the same place."""
    for method in ("trim3r", *RIVALS):
        for keep in (3, 25, 100):
            if method == "trim3r" and keep == 100:
                continue
            plain, head = (build(room, *BARE, "--keep", keep, "--method", m, out=f"{folder}/{m}.ply")
                           for m in (method, f"{method}+head"))
            check(numpy.array_equal(plain, head), f"{method}+head at {keep} %: the points of {method}")
            check(len(head) == round(2 * SIDE * SIDE * keep / 100), "exactly Z of them")
    disc = ["--head", "analytic", "--refine", "0", "--keep", "10", "--rim", "off"]
    for rival in RIVALS:
        plain, head = (build(room, *disc, "--method", m, out=f"{folder}/{m}.ply") for m in (rival, f"{rival}+head"))
        check(numpy.array_equal(plain[:, :3], head[:, :3]), f"{rival}+head: the same places")
        check(numpy.median(head[:, -7]) > numpy.median(plain[:, -7]) + 0.3, f"{rival}+head: wider")


def another_head_ranks(folder, room):
    """Checks --mask-head: the points are those of the other head's scene, for any head that then works on them."""
    def chosen(head, *more):
        options = ["--head", head, "--refine", "0", "--keep", "10", "--method", "pup+head"]
        return build(room, *options, *more, out=f"{folder}/masked.ply")[:, :3]

    small = chosen("small")
    own, others = chosen("none"), chosen("none", "--mask-head", "small")
    check(len(own) == len(others) and not numpy.array_equal(own, others), "another scene, other points")
    check(numpy.array_equal(chosen("small", "--mask-head", "small"), small), "the head's own is the default")
    check(numpy.array_equal(others, chosen("analytic", "--mask-head", "small")), "the same points, whichever head")

    text = ["eval", room, *SMALL, "--target", "1", "--keep", "10", "--head", "analytic", "--json", "--methods"]
    rows = [json.loads(run(trim3r, *text, "pup+head", *more).stdout)["rows"][0] for more in ([], ["--mask-head", "small"])]
    check([(r["head"], "mask-head-small" in r["settings"].split()) for r in rows] ==
          [("analytic", False), ("analytic", True)], f"rows tell it: {rows}")
    for methods in ("pup", "trim3r+head", "pup+head,pup+finetune"):
        found = run(trim3r, *text, methods, "--mask-head", "small", expect=2)
        check("--mask-head belongs to rivals with +head" in found.stderr, methods)
    found = run(trim3r, "build", room, "--keep", "10", "--method", "pup", "--mask-head", "small", "-o",
                f"{folder}/no.ply", expect=2)
    check("--mask-head belongs to rivals with +head, not to pup" in found.stderr, "in a build too")


def rows_of_rivals(folder, room):
    methods = ["trim3r", "trim3r+head", *RIVALS, *(f"{rival}+head" for rival in RIVALS)]
    keeps = [100, 20, 5]
    settings = [*SMALL, "--target", "1", "--rim", "off", "--refine", "4"]
    rows = json.loads(run(trim3r, "eval", room, *settings, "--keep", ",".join(map(str, keeps)), "--methods", ",".join(methods),
                          "--images", f"{folder}/pictures", "--json").stdout)["rows"]
    by = {(row["method"], row["keep"]): row for row in rows}
    check(list(by) == [(m, k) for m in methods for k in keeps], "one row a method and budget")
    scores = ("gaussians", "psnr", "ssim", "holes", "context_psnr")
    for (name, keep), row in by.items():
        check(row["gaussians"] == by["trim3r", keep]["gaussians"], f"{name} at {keep} %: the count of trim3r")
        named = row["picture"]
        check(named.startswith(f"1/{name}_") and named.endswith(f"_{keep}.png") and os.path.exists(f"{folder}/pictures/{named}"),
              f"the picture {named}")
    for rival in RIVALS:
        check([by[f"{rival}+head", 100][s] for s in scores] == [by["trim3r+head", 100][s] for s in scores],
              f"{rival}+head at 100 %: all points, whoever chose them")
        for keep in (20, 5):
            plain, head = by[rival, keep], by[f"{rival}+head", keep]
            check(head["psnr"] > plain["psnr"] + 0.5, f"{rival} at {keep} %: our head is better than none")
            check(head["psnr"] < by["trim3r", keep]["psnr"] - 0.5, f"{rival} at {keep} %: our points are better")
            check(head["build_ms"] > plain["build_ms"] * 0.5, "the scores are part of the time")
    near(by["trim3r+head", 5]["psnr"], by["trim3r", 5]["psnr"], 0.5, "counting the spacing costs little")
    again = json.loads(run(trim3r, "eval", room, *settings, "--keep", "5", "--methods", "eagles+head", "--json").stdout)["rows"][0]
    check([again[s] for s in scores] == [by["eagles+head", 5][s] for s in scores], "alone as beside others")


with tempfile.TemporaryDirectory() as folder:
    room = f"{folder}/room.mcap"
    run(trim3r, "room", "--size", "64x64", "-o", room)
    every, names = pictures_choose(folder, room)
    no_more_than_needed(folder, room, names)
    levels_are_spread(folder, room, every)
    errors(folder, room, names)
    rivals_choose(folder, room)
    another_head_ranks(folder, room)
    rows_of_rivals(folder, room)
done()
