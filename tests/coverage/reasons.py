# SPDX-License-Identifier: Apache-2.0
"""uncovered.txt: the branches that no test takes, and the reasons.

A reason is above its places, which are indented: `FILE FUNCTION BRANCHES: TEXT OF THE LINE`. An empty line ends it.
"""
import collections
import pathlib
import re

import branches

FILE = pathlib.Path(__file__).resolve().parent / "uncovered.txt"
PLACE = re.compile(r"  (\S+) (\w+) (\d+): (.+)")


class Malformed(Exception):
    pass


def read(text):
    """Returns {place: how many of its branches the text explains}."""
    explained, reason = collections.Counter(), False
    for number, line in enumerate(text.splitlines(), 1):
        if not line.startswith(" "):
            reason = line != "" and not line.startswith("#")
            continue
        place = PLACE.fullmatch(line)
        if place is None:
            raise Malformed(f"uncovered.txt:{number}: not FILE FUNCTION BRANCHES: TEXT")
        if not reason:
            raise Malformed(f"uncovered.txt:{number}: no reason stands above it")
        explained[branches.Place(place[1], place[2], place[4])] += int(place[3])
    return explained


def line_for(place, count):
    return f"  {place.file} {place.function} {count}: {place.text}"


def disagreements(uncovered, explained):
    """Returns branches without a reason, and reasons without a branch; a sentence for each place."""
    found = []
    for place in sorted(set(uncovered) | set(explained)):
        count, known = uncovered.get(place, 0), explained.get(place, 0)
        if count > known:
            found.append(f"{count} branches are not taken, {known} explained:{line_for(place, count)}")
        elif known > count:
            found.append(f"{known} branches are explained, {count} not taken:{line_for(place, known)}")
    return found
