# SPDX-License-Identifier: Apache-2.0
"""Branches of the runtime, all and taken, from gcov of all objects in a build folder."""
import collections
import concurrent.futures
import json
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RUNTIME = ROOT / "runtime"
VECTORS = frozenset(("x86", "arm", "wasm", "lanes"))

INLINED = "inlined" # gcov has no name for a function that the compiler must inline

# Places of branches: two equal lines of a function are one place.
Place = collections.namedtuple("Place", "file function text")


def gcov(objects):
    """Yields gcov's data of these objects: a dictionary each."""
    said = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", *map(str, objects)],
                          capture_output=True, text=True, check=True)
    return [json.loads(line) for line in said.stdout.splitlines() if line]


def place_of(folder, file, root):
    """Returns a source file's path below `root`, or None if it is outside. The build names files from the top of the
    tree, ccache from the folder in which the compiler ran."""
    for start in folder, root.parent:
        path = pathlib.Path(os.path.normpath(pathlib.Path(start, file)))
        if path.is_relative_to(root) and path.exists():
            return path
    return None


def counted(folder, root=RUNTIME):
    """Returns {(file, function, line, number of branches): how often each branch there was taken}, added up over all
    objects of the folder. An inlined line has fewer branches where a constant decides some: it counts for each number."""
    objects = [path for path in sorted(folder.rglob("*.gcda")) if VECTORS.isdisjoint(path.parts)]
    groups = [objects[at:at + 8] for at in range(0, len(objects), 8)]
    taken = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for folder_of, source in ((known["current_working_directory"], source)
                                  for found in pool.map(gcov, groups) for known in found for source in known["files"]):
            path = place_of(folder_of, source["file"], root)
            if path is None:
                continue
            for line in source["lines"]:
                ways = [branch["count"] for branch in line["branches"]]
                if ways:
                    key = (str(path.relative_to(root)), line.get("function_name", INLINED), line["line_number"], len(ways))
                    before = taken.setdefault(key, [0] * len(ways))
                    taken[key] = [a + b for a, b in zip(before, ways)]
    return taken


def uncovered(taken, root=RUNTIME):
    """Returns {place: how many of its branches were never taken}."""
    lines, found = {}, collections.Counter()
    for (file, function, line, _), ways in taken.items():
        missing = sum(count == 0 for count in ways)
        if missing:
            if file not in lines:
                lines[file] = (root / file).read_text().splitlines()
            found[Place(file, function, lines[file][line - 1].strip())] += missing
    return found


def version():
    said = subprocess.run(["gcov", "--version"], capture_output=True, text=True, check=True).stdout
    return said.splitlines()[0].split()[-1]
