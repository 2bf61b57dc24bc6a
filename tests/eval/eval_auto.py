#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_auto.py TRIM3R [SHARED_DATA]: `--auto` takes neither too few Gaussians nor too many: what it loses against all points
in a view that it has not seen, and the share of the points that it takes, on the built-in room and on drawn scenes of
`trim3r stress`; with SHARED_DATA on recorded training scenes instead. Held to what was measured."""
import json
import os
import statistics
import sys
import tempfile

from checks import check, done, run, skip

TRIM3R = os.path.abspath(sys.argv[1])
LOSSES = (0.5, 2)  # dB asked for
SLACK = 0.25  # dB above what was asked for, of the worst recorded view
UNSEEN = 40  # dB: better than this a loss is not to be seen

# The largest share of the points, percent, for each loss. Measured: the room 57, 33 %; the plane 91, 69 %. Foliage keeps
# all. None loses more than asked.
DRAWN = {"room": (65, 40), "scene-plane": (99, 80), "scene-foliage": None}
# Training scenes: every triplet within this, most of them within what was asked for, and the mean share. Measured of the
# 20: all within it, 0.48 dB at most, 50 and 11 %.
RECORDED = ("hololens_a", "7scenes_redkitchen")
WITHIN, SHARES = 0.9, (55, 14)


def rows(*command):
    return json.loads(run(TRIM3R, *command, "--json").stdout)["rows"]


class Choice:
    """The number of Gaussians that `--auto` took of a view's points, and the loss of PSNR."""

    def __init__(self, whole, chosen):
        self.share = chosen["gaussians"] / whole["gaussians"] * 100
        self.psnr, self.lost = chosen["psnr"], whole["psnr"] - chosen["psnr"]

    def __repr__(self):
        return f"{self.share:.2f} % of the points, {self.psnr:.2f} dB, {self.lost:.2f} lost"


def choices(command, *options):
    """Returns a Choice for every view and each loss; the larger the loss allowed, the fewer Gaussians."""
    whole = rows(command, *options, "--keep", "100")
    every = ["--keep", "100"] if command == "stress" else []  # its --keep applies to the methods without --auto
    found = []
    for most in LOSSES:
        chosen = rows(command, *options, *every, "--auto", "--max-loss", str(most))
        names = [[(row["context"], row["target"]) for row in table] for table in (whole, chosen)]
        check(names[0] == names[1] and names[0], f"the same views: {names}")
        found.append([Choice(*pair) for pair in zip(whole, chosen)])
        print(options, most, found[-1])
    check(all(few.share <= many.share for many, few in zip(*found)), f"more may be lost, more are taken: {found}")
    return found


def drawn_scenes(folder):
    def drawn(name):
        return [views[0] for views in choices("stress", "--rows", name, "--strengths", "2", "--captures", "0")]

    run(TRIM3R, "room", "-o", f"{folder}/room.mcap")
    found = {"room": [views[0] for views in choices("eval", f"{folder}/room.mcap", "--context", "0,2", "--target", "1")]}
    found |= {name: drawn(name) for name in DRAWN if name not in found}
    for name, shares in DRAWN.items():
        for i, choice in enumerate(found[name]):
            check(choice.lost <= LOSSES[i], f"{name} within {LOSSES[i]} dB: {choice}")
            check(shares is None or choice.share <= shares[i], f"{name} within {LOSSES[i]} dB of few points: {choice}")
    for wall, foliage in zip(drawn("scene-wall"), found["scene-foliage"]):
        check(wall.share < 1 and wall.psnr > UNSEEN, f"a blank wall: {wall}")
        check(foliage.share > 10 * wall.share, f"foliage needs more than a wall: {foliage}, {wall}")


def recorded_scenes(folder, data):
    views = [[], []]
    for name in RECORDED:
        run(TRIM3R, "import", os.path.join(data, name), "--size", "256x256", "-o", f"{folder}/{name}.mcap")
        for every, some in zip(views, choices("eval", f"{folder}/{name}.mcap")):
            every += some
    for some, asked, most_share in zip(views, LOSSES, SHARES):
        within = statistics.fmean(view.lost <= asked for view in some)
        check(within >= WITHIN, f"{within * 100:.0f} % of {len(some)} views within {asked} dB")
        worst = max(some, key=lambda view: view.lost)
        check(worst.lost <= asked + SLACK, f"the worst, within {asked} dB: {worst}")
        share = statistics.fmean(view.share for view in some)
        check(share <= most_share, f"{share:.2f} % of the points for {asked} dB")


with tempfile.TemporaryDirectory() as scratch:
    if len(sys.argv) > 2:
        if not os.path.isdir(sys.argv[2]):
            skip(f"{sys.argv[2]} is not there")
        recorded_scenes(scratch, sys.argv[2])
    else:
        drawn_scenes(scratch)
done()
