# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder."""
import os

import browser  # noqa: F401
from checks import check, done, run, skip  # noqa: F401

HEADING = ("scene,context,target,method,head,bits,refine,wavelet,keep,gaussians,psnr,ssim,build_ms,render_ms,arena_bytes,"
           "scene_bytes,unknown\n")


def made_up(path, scenes=3, cases=2):
    """A table whose figures are known: `best` is on the front at every budget, `worse` nowhere, `fast` at the left."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(HEADING)
        for scene in range(scenes):
            for case in range(cases):
                for method, loss, times in (("best", 0, 1), ("worse", 3, 2), ("fast", 8, 0.1)):
                    for keep in (100, 10, 2):
                        z = 655 * keep
                        psnr = 30 - loss - 20 / keep + scene + case / 10
                        file.write(f"room{scene},\"{case},{case + 2}\",{case + 1},{method},small,8,4,db2,{keep},{z},{psnr},"
                                   f"{psnr / 40},{(100 + 5 * keep) * times * (1 + case / 10)},{(1 + keep / 10) * times},"
                                   f"{400000 + 100 * z},{44 * z},any\n")
    return path


def built_in(trim3r, folder):
    """Evaluates the built-in room twice, with pictures; returns the tables and folders."""
    tables = []
    run(trim3r, "room", "--size", "48x48", "-o", f"{folder}/room.mcap")
    run(trim3r, "room", "--size", "48x48", "--seed", "5", "-o", f"{folder}/den.mcap")
    for name, more in (("a", ("--methods", "trim3r,random")), ("b", ("--refine", "0"))):
        run(trim3r, "eval", f"{folder}/room.mcap", f"{folder}/den.mcap", "--keep", "100,20,5", "--csv", f"{folder}/{name}.csv",
            "--images", f"{folder}/{name}", *more)
        tables.append(os.path.join(folder, f"{name}.csv"))
    return tables, [f"{folder}/a", f"{folder}/b"]
