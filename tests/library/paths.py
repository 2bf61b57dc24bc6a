#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""paths.py BUILD FILE...: no built file contains the path of the tree or of the build folder, not even in its run
path, and none looks for libraries in the current folder."""
import pathlib
import re
import sys
import tempfile

from library import ROOT, there

from checks import check, done, run


def run_paths(path):
    """Returns the places where the loader looks first; an empty one is the current folder."""
    found = re.search(r"\((?:RUNPATH|RPATH)\).*\[(.*)\]", run("readelf", "--dynamic", "--wide", path).stdout)
    return found[1].split(":") if found else []


def offences(path, folders):
    contents = path.read_bytes()
    held = [f"holds {folder}" for folder in folders if str(folder).encode() in contents]
    return held + [f"looks for libraries in '{place}'" for place in run_paths(path)
                   if not place.startswith(("/", "$ORIGIN"))]


def planted(folder):
    """Builds a program that contains its source's path, and looks for libraries in the current folder."""
    source, program = folder / "main.c", folder / "program"
    source.write_text('const char *where = __FILE__;\nint main(void) { return where[0]; }\n')
    run("cc", source, "-Wl,-rpath,::", "-o", program)
    return offences(program, [folder])


def main():
    if not there("cc", "readelf"):
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="trim3r-paths-") as folder:
        found = planted(pathlib.Path(folder))
        check(f"holds {folder}" in found, "blind: a path in a program is not noticed")
        check("looks for libraries in ''" in found, "blind: an empty run path is not noticed")
    folders = [ROOT, pathlib.Path(sys.argv[1])]
    for path in map(pathlib.Path, sys.argv[2:]):
        found = offences(path, folders)
        check(not found, f"{path.name}: {', '.join(found)}")
    done()


if __name__ == "__main__":
    main()
