#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_methods.py TRIM3R: methods and ablations of `trim3r eval`: refusals, and --views and --scene with them."""
import json
import sys
import tempfile

from checks import check, done, run

trim3r = sys.argv[1]
INPUT, USAGE, BUDGET = 1, 2, 3


def refuse(status, *words_and_arguments):
    """refuse(STATUS, "word", ..., [arguments]): expects every word on stderr."""
    *words, arguments = words_and_arguments
    result = run(trim3r, "eval", *arguments, expect=status)
    for word in words:
        check(word in result.stderr, f"eval {arguments}: '{word}' is not in: {result.stderr}")


with tempfile.TemporaryDirectory() as folder:
    room = f"{folder}/room.mcap"
    run(trim3r, "room", "--size", "64x64", "-o", room)
    one = [room, "--context", "0,2", "--target", "1"]

    for method in ("best", "", "eagle", "eaglesX", "eagles+", "eagles+finetuned", "+finetune", "EAGLES"):
        refuse(USAGE, f"'{method}' is not a method", "efficientgs", "+finetune",
               [*one, "--keep", "10", "--methods", f"trim3r,{method}"])
    refuse(USAGE, "trim3r twice", [*one, "--keep", "10", "--methods", "trim3r,random,trim3r"])
    refuse(USAGE, "pup+finetune twice", [*one, "--keep", "10", "--methods", "pup,pup+finetune,pup+finetune"])
    for iterations in ("0", "-1", "100001", "many", ""):
        refuse(USAGE, "--finetune-iterations", [*one, "--keep", "10", f"--finetune-iterations={iterations}"])
    refuse(BUDGET, "too small", [*one, "--keep", "10", "--methods", "eagles", "--arena", "1000"])
    refuse(INPUT, room, "no frame 999", [room, "--context", "0,999", "--target", "1", "--keep", "10", "--methods", "pup"])
    refuse(USAGE, "--ablate does not know 'texture'", [*one, "--ablate=full,texture"])
    refuse(USAGE, "--ablate does not know ''", [*one, "--ablate="])
    refuse(USAGE, "--ablate does not know ''", [*one, "--ablate=full,"])
    refuse(USAGE, "--ablate names k-5 twice", [*one, "--ablate=k-5,full,k-5"])
    refuse(USAGE, "excludes --methods and --heads", [*one, "--ablate", "--methods", "trim3r"])
    refuse(USAGE, "excludes --methods and --heads", [*one, "--ablate", "--heads", "small,tiny"])
    for more in (["--methods=random"], ["--ablate"]):
        refuse(USAGE, "--scene is scored as it is", [room, "--scene", f"{folder}/mine.ply", *more])
    rival = json.loads(run(trim3r, "eval", *one, "--keep", "10", "--working", "32x32", "--refine", "0", "--views", "4",
                           "--methods", "eagles", "--json").stdout)["rows"]
    check([len(row["context"].split(",")) for row in rival] == [4], "a rival sees all of --views, too")
done()
