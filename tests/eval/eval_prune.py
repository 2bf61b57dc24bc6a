#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_prune.py TRIM3R: `build` and `eval` with `--prune`: a pixel-aligned scene made elsewhere, here the unpruned
scene of the built-in room, pruned by trim3r and by its rivals."""
import json
import os
import sys
import tempfile

from checks import check, done, near, run
from common import need_numpy

numpy, cv2 = need_numpy()
trim3r = sys.argv[1]
SIDE = 64
CONTEXT = ["--context", "0,2"]
CASE = [*CONTEXT, "--target", "1"]
BARE = ["--head", "none", "--refine", "0", "--keep", "100", "--rim", "off"]
SCORES = ("gaussians", "psnr", "ssim", "sharp", "holes", "context_psnr", "perceptual")
# Means are rounded to other depth steps than the measured ones, and at edges a mean of the other view may be in front
# of a pixel's own, so a few points differ.
NEAR_DB = 0.4
FAINT = -4.0  # logit of an opacity of 0.018


class Ply:
    """A scene file: its header and its rows of floats."""

    def __init__(self, path):
        self.header, body = open(path, "rb").read().split(b"end_header\n", 1)
        self.names = [line.split()[2].decode() for line in self.header.split(b"\n") if line.startswith(b"property float")]
        self.rows = numpy.frombuffer(body, "<f4").reshape(-1, len(self.names))

    def write(self, path, rows):
        count = b"element vertex %d"
        header = self.header.replace(count % len(self.rows), count % len(rows))
        with open(path, "wb") as file:
            file.write(header + b"end_header\n" + numpy.ascontiguousarray(rows, "<f4").tobytes())
        return path


def build(*arguments, out):
    return json.loads(run(trim3r, "build", *arguments, "--json", "-o", out).stdout)


def evaluate(*arguments):
    return json.loads(run(trim3r, "eval", *arguments, "--json").stdout)["rows"]


def exact_counts(folder, room, theirs, ply):
    """The budget refers to the file's Gaussians, for every way of retaining points or Gaussians."""
    count = len(ply.rows)
    text = [room, *CONTEXT, "--prune", theirs]
    for method in ("trim3r", "trim3r+head", "trim3r+finetune", "random", "eagles+finetune"):
        told = build(*text, "--keep", "10%", "--method", method, "--finetune-iterations", "1", out=f"{folder}/less.ply")
        check(told["gaussians"] == told["requested"] == (count + 5) // 10, f"{method}: a tenth of {count}: {told}")
        check(len(Ply(f"{folder}/less.ply").rows) == told["gaussians"], f"{method}: so many are written")
        check(told["pruned"] == theirs and told["context"] == [0, 2] and "depth" not in told, f"{method}: what was pruned")
        check(("head" in told) == method.startswith("trim3r"), f"{method}: whether a head made it")
    plain, small = (build(*text, "--gaussians", "333", *more, out=f"{folder}/{name}.ply")
                    for name, more in (("full", []), ("min", ["--arena", "min", "--threads", "2"])))
    check(plain["hash"] == small["hash"] and plain["gaussians"] == 333, "whatever the arena")
    check(numpy.array_equal(*(Ply(f"{folder}/{name}.ply").rows for name in ("full", "min"))), "the same file")

    # three Gaussians a pixel, as in pixelSplat: more than there are pixels
    triple = ply.write(f"{folder}/triple.ply", numpy.tile(ply.rows, (3, 1)))
    told = build(room, *CONTEXT, "--prune", triple, "--keep", "10%", out=f"{folder}/less.ply")
    check(told["gaussians"] == (3 * count + 5) // 10, "percents are of the file's Gaussians")
    all_of_them = run(trim3r, "build", room, *CONTEXT, "--prune", triple, "--keep", "100", "-o", f"{folder}/less.ply").stderr
    check(f"{3 * count} Gaussians are more than the views have: all {2 * SIDE * SIDE} valid points are used" in all_of_them, f"the most: {all_of_them}")
    check(len(Ply(f"{folder}/less.ply").rows) == 2 * SIDE * SIDE, "a point a pixel")


def as_good_as_direct(folder, room, theirs, ply):
    text = [room, *CASE, "--keep", "100,10", "--fit-passes", "off"]  # a file's points are always refined in this way
    direct = {row["keep"]: row for row in evaluate(*text, "--rim", "off")}  # the file has none
    rows = evaluate(*text, "--prune", theirs, "--methods", "trim3r,random,eagles", "--images", f"{folder}/pictures")
    by = {(row["method"], row["keep"]): row for row in rows}
    check(list(by) == [(m, k) for m in ("trim3r", "random", "eagles") for k in (100, 10)], "one row a method and budget")
    for keep in (100, 10):
        near(by["trim3r", keep]["psnr"], direct[keep]["psnr"], NEAR_DB, f"at {keep} % as from the recording")
        near(by["trim3r", keep]["context_psnr"], direct[keep]["context_psnr"], NEAR_DB, f"at {keep} %, context")
        check(len({by[m, keep]["gaussians"] for m in ("trim3r", "random", "eagles")}) == 1, "all have the same count")
    for rival in ("random", "eagles"):
        check(by["trim3r", 10]["psnr"] > by[rival, 10]["psnr"] + 8, f"far ahead of {rival}: {by}")
        check(by["trim3r", 10]["holes"] < 0.05 < by[rival, 10]["holes"], f"without the holes of {rival}")
    check([by["random", 100][s] for s in SCORES] == [by["eagles", 100][s] for s in SCORES], "100 % is the file itself")
    run(trim3r, "render", theirs, room, "--view", "1", "-o", f"{folder}/theirs.png")
    check(numpy.array_equal(cv2.imread(f"{folder}/theirs.png"), cv2.imread(f"{folder}/pictures/{by['random', 100]['picture']}")),
          "drawn as `render` draws it")

    told = {row["settings"] for row in rows}
    check(len(told) == 1 and "prune-" in told.pop() and {row["depth"] for row in rows} == {"scene"}, "rows tell it")
    check(all((row["head"] or "", row["allocate"] or "") == (("small", "density") if row["method"] == "trim3r" else ("", ""))
              for row in rows), f"no head made a file: {rows}")
    shared = evaluate(*text, "--prune", theirs, "--methods", "trim3r,eagles", "--jobs", "2")
    check([[row[s] for s in SCORES] for row in shared] == [[row[s] for s in SCORES] for row in rows if row["method"] != "random"],
          "on two processes")
    return by


def moved_cameras(folder, room, ply):
    """The recording's last views, rotated against the first ones; and a set that is pruned by other views than its
    own."""
    context, case = ["--context", "3,5"], ["--context", "3,5", "--target", "4"]
    build(room, *context, *BARE, out=f"{folder}/last.ply")
    direct = evaluate(room, *case, "--keep", "10")[0]
    found = evaluate(room, *case, "--keep", "10", "--prune", f"{folder}/last.ply")[0]
    near(found["psnr"], direct["psnr"], NEAR_DB, "of the last views")
    check(found["gaussians"] == direct["gaussians"], "and as many")
    others = evaluate(room, "--context", "1,3", "--target", "2", "--keep", "10", "--prune", f"{folder}/first.ply",
                      "--methods", "trim3r,random")
    check(others[0]["psnr"] > others[1]["psnr"] + 8, f"by views beside its own: {others}")


def unseen_do_not_count(folder, room, theirs, ply):
    """Checks that means behind the cameras and faint ones in front change nothing; a scene that no view sees is
    refused."""
    at = [ply.names.index(name) for name in "xyz"]
    opacity = ply.names.index("opacity")
    told = build(room, *CONTEXT, "--prune", theirs, "--gaussians", "500", out=f"{folder}/plain.ply")
    centre = numpy.array(told["origin"])
    behind, faint = ply.rows[::3].copy(), ply.rows[::2].copy()
    behind[:, at] = 2 * centre - behind[:, at]
    faint[:, at] = centre + 0.5 * (faint[:, at] - centre)
    faint[:, opacity] = FAINT
    more = ply.write(f"{folder}/more.ply", numpy.concatenate([behind, faint, ply.rows]))
    again = build(room, *CONTEXT, "--prune", more, "--gaussians", "500", out=f"{folder}/again.ply")
    check(again["hash"] == told["hash"] and again["valid_points"] == told["valid_points"], "unseen means change nothing")
    check(numpy.array_equal(Ply(f"{folder}/plain.ply").rows, Ply(f"{folder}/again.ply").rows), "nor the file")
    faint[:, opacity] = 1
    more = ply.write(f"{folder}/more.ply", numpy.concatenate([faint, ply.rows]))
    again = build(room, *CONTEXT, "--prune", more, "--gaussians", "500", out=f"{folder}/again.ply")
    check(again["hash"] != told["hash"], "opaque ones before everything do")

    for name, rows in (("behind", behind), ("faint", ply.rows.copy())):
        if name == "faint":
            rows[:, opacity] = FAINT
        path = ply.write(f"{folder}/{name}.ply", rows)
        for command in (["build", room, *CONTEXT, "--keep", "10", "-o", f"{folder}/no.ply"],
                        ["eval", room, *CASE, "--keep", "10"]):
            error = run(trim3r, *command, "--prune", path, expect=1).stderr
            check(f"{name}.ply: frame 0 of {room} sees none of its {len(rows)} Gaussians" in error, error)
    right = SIDE * SIDE // 2 + SIDE - 1  # from the first view's middle row, outside the second view
    one = ply.write(f"{folder}/one.ply", ply.rows[right:right + 1])
    check("frame 2" in run(trim3r, "build", room, *CONTEXT, "--keep", "10", "--prune", one, "-o", f"{folder}/no.ply",
                           expect=1).stderr, "the view is told that sees none")
    one = ply.write(f"{folder}/one.ply", ply.rows[:1])
    told = build(room, *CONTEXT, "--prune", one, "--keep", "100", out=f"{folder}/again.ply")
    check((told["gaussians"], told["valid_points"]) == (1, 2), "one that both see is enough")


def without_depth(folder, room, theirs, by):
    """Checks source views alone, as such networks provide them: pictures and poses."""
    model, views = f"{folder}/model", f"{folder}/views"
    run(trim3r, "build", room, "--context", "0,1,2", "--keep", "5", "--colmap", model)
    camera = [line.split() for line in open(f"{model}/sparse/0/cameras.txt") if line[0] != "#"][0]
    check(camera[1] == "PINHOLE", "the model's camera")
    fx, fy, cx, cy = map(float, camera[4:])
    frames = []
    for line in [line for line in open(f"{model}/sparse/0/images.txt") if line[0] != "#"][::2]:
        w, x, y, z, *t = map(float, line.split()[1:8])
        turn = numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
        pose = numpy.eye(4)
        pose[:3, :3] = turn.T @ numpy.diag([1, -1, -1])  # y up, z back
        pose[:3, 3] = -turn.T @ t
        frames.append({"file_path": f"images/{line.split()[-1]}", "transform_matrix": pose.tolist()})
    frames.sort(key=lambda frame: frame["file_path"])
    with open(f"{model}/transforms.json", "w") as file:
        json.dump({"fl_x": fx, "fl_y": fy, "cx": cx, "cy": cy, "w": SIDE, "h": SIDE, "frames": frames}, file)
    run(trim3r, "import", model, "-o", f"{views}.mcap")
    text = [f"{views}.mcap", *CASE, "--keep", "10"]
    check("has no depth" in run(trim3r, "eval", *text, expect=1).stderr, "without a scene there is no depth")
    rows = evaluate(*text, "--prune", theirs, "--methods", "trim3r,random")
    near(rows[0]["psnr"], by["trim3r", 10]["psnr"], NEAR_DB, "as well as with depth beside it")
    near(rows[1]["psnr"], by["random", 10]["psnr"], NEAR_DB, "random too")
    check(rows[0]["gaussians"] == rows[1]["gaussians"] == by["trim3r", 10]["gaussians"], "as many")


def resumes(folder, room, theirs):
    table = f"{folder}/rows.csv"
    text = [room, *CASE, "--keep", "10", "--prune", theirs, "--csv", table, "--resume"]
    os.utime(theirs, (1, 1))
    first = evaluate(*text)
    kept = open(table).read()
    check(evaluate(*text)[0]["psnr"] == first[0]["psnr"] and open(table).read() == kept, "a known row is kept")
    os.utime(theirs, (4e9, 4e9))
    check(f"is older than {theirs}" in run(trim3r, "eval", *text, expect=1).stderr, "a new scene is told")
    os.utime(theirs, (1, 1))


def errors(folder, room, theirs, ply):
    def refused(status, words, *command):
        found = run(trim3r, *command, expect=status)
        check(words in found.stderr and found.stdout == "", f"{command}: '{words}' is not in: {found.stderr}")
        check(not os.path.exists(f"{folder}/no.ply"), f"{command}: a scene all the same")

    one = ["eval", room, *CASE, "--keep", "10", "--prune"]
    made = ["build", room, *CONTEXT, "--keep", "10", "-o", f"{folder}/no.ply", "--prune"]
    other = f"{folder}/other.mcap"
    run(trim3r, "room", "--size", "32x32", "--seed", "2", "-o", other)
    refused(2, "--context and --target", "eval", room, "--keep", "10", "--prune", theirs)
    refused(2, "one context", "eval", room, other, *CASE, "--keep", "10", "--prune", theirs)
    refused(2, "--views", *one, theirs, "--views", "3")
    refused(2, "--planar", "eval", "--planar", f"{folder}/theirs.png", "--keep", "10", "--prune", theirs)
    for command in (one, made):
        refused(2, "not to --prune", *command, theirs, "--depth", "stereo")
        refused(1, "none.ply", *command, f"{folder}/none.ply")
        cut = f"{folder}/cut.ply"
        with open(theirs, "rb") as source, open(cut, "wb") as file:
            file.write(source.read()[:-5])
        refused(1, "cut.ply", *command, cut)
        refused(1, "not.ply", *command, ply.write(f"{folder}/not.ply", ply.rows * numpy.float32("nan")))
        refused(1, "holds no Gaussians", *command, ply.write(f"{folder}/empty.ply", ply.rows[:0]))
    refused(2, "+head", *one, theirs, "--methods", "trim3r,eagles+head")
    refused(2, "+head", *made, theirs, "--method", "eagles+head")
    refused(1, "no frame 99", "build", room, "--context", "0,99", *made[4:], theirs)


with tempfile.TemporaryDirectory() as folder:
    room, theirs = f"{folder}/room.mcap", f"{folder}/first.ply"
    run(trim3r, "room", "--size", f"{SIDE}x{SIDE}", "-o", room)
    # its frame is named, so that a file added next to it later does not move it
    build(room, *CONTEXT, *BARE, "--comments", out=theirs)
    ply = Ply(theirs)
    check(len(ply.rows) == 2 * SIDE * SIDE, "the room has depth everywhere")
    exact_counts(folder, room, theirs, ply)
    by = as_good_as_direct(folder, room, theirs, ply)
    moved_cameras(folder, room, ply)
    unseen_do_not_count(folder, room, theirs, ply)
    without_depth(folder, room, theirs, by)
    resumes(folder, room, theirs)
    errors(folder, room, theirs, ply)
done()
