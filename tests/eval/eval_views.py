#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_views.py TRIM3R: `trim3r eval --views` takes the frames that its help describes, makes scenes of them, and
reports them; a recording with too few is reported. A target among views whose poses and exposure drift is drawn as its
camera saw it."""
import csv
import json
import math
import os
import sys
import tempfile

from checks import check, done, run
from common import need_numpy
from stepped_wall import stepped_wall

numpy, cv2 = need_numpy()
trim3r = sys.argv[1]


def rows_of(*arguments):
    return json.loads(run(trim3r, "eval", *arguments, "--json").stdout)["rows"]


def refuse(status, words, *arguments):
    result = run(trim3r, "eval", *arguments, expect=status)
    check(words in result.stderr, f"eval {arguments}: '{words}' is not in: {result.stderr}")


def made_recording(folder):
    """Makes frames along x, rotated about the vertical, 2 m before a wall; frame 5 has no depth."""
    made = f"{folder}/made"
    os.mkdir(made)
    random = numpy.random.default_rng(1)
    #          0            1            2            3             4             5            6
    places = [(0.4, 0.0), (0.0, 0.0), (0.2, 0.0), (-0.2, 0.0), (0.0, 20.0), (0.02, 0.0), (0.0, 3.0)]
    frames = []
    for i, (x, degrees) in enumerate(places):
        cv2.imwrite(f"{made}/{i}.png", random.integers(0, 255, (32, 32, 3), dtype=numpy.uint8))
        cv2.imwrite(f"{made}/{i}.depth.png", numpy.full((32, 32), 2000, dtype=numpy.uint16))
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        frame = {"file_path": f"{i}.png", "transform_matrix": [[c, 0, s, x], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1]]}
        frames.append(frame if i == 5 else {**frame, "depth_path": f"{i}.depth.png"})
    with open(f"{made}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"fl_x": 32, "fl_y": 32, "cx": 16, "cy": 16, "w": 32, "h": 32, "integer_depth_scale": 0.001,
                   "frames": frames, "trim3r_triplets": [{"context": [0, 2], "target": 1},
                                                         {"context": [1, 1], "target": 4}]}, file)
    run(trim3r, "import", made, "--size", "32x32", "-o", f"{made}.mcap")
    return f"{made}.mcap"


def the_rule(folder):
    made = made_recording(folder)
    quick = (made, "--keep", "50", "--head", "analytic", "--refine", "0")
    contexts = {2: ["0,2", "1"], 3: ["0,2,6", "1,6,2"], 4: ["0,2,6,3", "1,6,2,3"], 5: ["0,2,6,3,4", "1,6,2,3,0"]}
    for views, expected in contexts.items():
        rows = rows_of(*quick, "--views", views)
        check([r["context"] for r in rows] == expected, f"{views} views: {[r['context'] for r in rows]}")
        check([r["target"] for r in rows] == ["1", "4"], "targets stay")
        check({r["settings"] for r in rows} == {"default" if views == 2 else f"views-{views}"}, "the settings tell")
        check([r["gaussians"] for r in rows] == [512 * len(e.split(",")) for e in expected], "half of the points of all")
    refuse(1, "--views 6 is too much", *quick, "--views", "6")
    refuse(1, "made.mcap", *quick, "--views", "16")


def the_room(folder):
    room, table = f"{folder}/room.mcap", f"{folder}/a.csv"
    run(trim3r, "room", "--size", "48x48", "--frames", "12", "-o", room)
    quick = (room, "--keep", "10", "--head", "analytic", "--refine", "0")
    plain = rows_of(*quick)
    two = rows_of(*quick, "--views", "2")
    untimed = lambda row: {k: v for k, v in row.items() if not k.endswith("_ms")}
    check([untimed(r) for r in plain] == [untimed(r) for r in two], "two views are the triplet's own")
    many = (*quick, "--views", "10", "--images", f"{folder}/ten", "--csv", table)
    ten = rows_of(*many)
    check([r["context"].split(",")[:2] for r in ten] == [r["context"].split(",") for r in plain], "the own two first")
    for few, row in zip(plain, ten):
        frames = row["context"].split(",")
        check(len(set(frames)) == 10 and row["target"] not in frames, f"ten others than the target: {frames}")
        check(4.9 < row["gaussians"] / few["gaussians"] < 5.1, "five times the points")
        check(row["psnr"] > 15 and row["context_psnr"] > 15, f"a scene of them: {row['psnr']} dB")
        name = f"{row['target']}/trim3r_analytic_refine-0_views-10_10.png"
        check(row["picture"] == name and os.path.exists(f"{folder}/ten/{name}"), f"a name of its own: {row['picture']}")
        check(os.path.exists(f"{folder}/ten/{row['target']}/context_j.png"), "all context views are written")
    # a truncated table is continued
    one = (*quick, "--context", "0,2", "--target", "1")
    run(trim3r, "eval", *many, "--resume")
    with open(table, newline="", encoding="utf-8") as file:
        check(len(list(csv.DictReader(file))) == len(ten), "resumed without a row more")
    given = rows_of(*one, "--views", "10")
    check([untimed(r) for r in given] == [{**untimed(ten[0]), "picture": None}], "a context that is given is filled, too")
    refuse(1, "--views 12 is too much", room, "--keep", "10", "--views", "12")
    for views in ("1", "17", "0", "many", "3,4", ""):
        refuse(2, "--views takes", room, "--keep", "10", f"--views={views}")
    refuse(2, "more frames than --views", room, "--context", "0,2,3,4", "--target", "1", "--keep", "10", "--views", "3")
    refuse(2, "not to --planar", "--planar", f"{folder}/ten/1/target.png", "--keep", "10", "--views", "3")


def walk(folder, degrees, exposure):
    """Makes a walk of seven frames along a wall with a step. Each recorded pose turns by so many degrees against the one
    before, and each picture is so much brighter; with 0 all are exact."""
    made = f"{folder}/walk-{degrees}-{exposure}"
    stepped_wall(made, axis=1, degrees=[degrees * i for i in range(7)], exposure=exposure, levels=(20, 150))
    run(trim3r, "import", made, "-o", f"{made}.mcap")
    return f"{made}.mcap"


def a_drifting_walk(folder):
    def scores(recording, *more):
        row = rows_of(recording, "--context", "0,1,2,4,6", "--target", "3", "--keep", "20", *more)[0]
        return row["psnr_all"], row["context_psnr"]

    exact = scores(walk(folder, 0, 0))
    check(min(exact) > 44, f"an exact walk: {exact}")
    for degrees, exposure in ((0, 0.06), (0.25, 0.06), (0.5, 0.1)):
        drifting = walk(folder, degrees, exposure)
        corrected, as_given = scores(drifting), scores(drifting, "--align", "off", "--exposure", "off")
        check(all(c > a + 5 for c, a in zip(corrected, as_given)), f"{degrees} {exposure}: {corrected} against {as_given}")
        check(corrected[1] > 43.5, f"each context view by its own correction: {corrected}")


with tempfile.TemporaryDirectory() as folder:
    the_rule(folder)
    the_room(folder)
    a_drifting_walk(folder)
done()
