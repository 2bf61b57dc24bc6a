#!/usr/bin/env python3
"""stress_all.py TRIM3R: every cell of the built-in room, small, by every way of spreading a budget and by the rivals:
nothing crashes, no promise breaks. For the sanitizers."""
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from checks import check, done, run

trim3r = sys.argv[1]
MAY_REFUSE = {("depth-all", 99.9), ("depth-all", 100)}  # of so few pixels a view may be left without any


def cells(*arguments):
    answer = json.loads(run(trim3r, "stress", "--json", *arguments).stdout)
    check(answer["broken"] == 0, f"{arguments}: broken promises")
    for row in answer["rows"]:
        if row["status"] == "refused":
            check((row["perturbation"], row["strength"]) in MAY_REFUSE and row["reason"], f"{arguments}: {row}")
    return answer["rows"]


SMALL = ["--working", "32x32"]
check(len(cells(*SMALL, "--methods", "trim3r,random")) == 76 * 2, "every cell, with flicker and still scenes")
check(len(cells(*SMALL, "--captures", "0", "--methods", "eagles,lightgaussian,pup,efficientgs")) == 76 * 4,
      "every cell of the other rivals")
for keep, *settings in (("2,100", "--head", "moment"), ("10", "--allocate", "paper", "--head", "nano"),
                        ("10", "--allocate", "pixel", "--threads", "2", "--arena", "min")):
    cells("--working", "40x32", "--captures", "0", "--keep", keep, *settings)
done()
