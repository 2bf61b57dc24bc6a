#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""page.py LIBRARY TRIM3R: the Python code on docs/python.md runs, block after block, and so does the code in the package's
docstring."""
import contextlib
import io
import os
import pathlib
import re
import sys
import tempfile
import textwrap

from common import ROOT, check, trim3r

from checks import done

sys.path[:0] = [str(ROOT / "tests" / "docs")]
from pages import blocks_of


def said(source, names):
    """Returns the code's output."""
    with contextlib.redirect_stdout(io.StringIO()) as out:
        exec(compile(source, "docs/python.md", "exec"), names)
    return out.getvalue()


def main():
    blocks = [block.body for block in blocks_of((ROOT / "docs" / "python.md").read_text()) if block.language == "python"]
    check(len(blocks) == 11, f"{len(blocks)} blocks of Python")
    names, before = {}, os.getcwd()
    os.environ["PATH"] = os.pathsep.join([str(pathlib.Path(sys.argv[2]).resolve().parent), os.environ["PATH"]])
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        os.chdir(folder)
        first = said(blocks[0], names).split()
        check(first[0] == "13107" and 25 < float(first[1]) < 35, f"the first scene: {first}")
        depth, alpha = map(float, said(blocks[1], names).split())
        check(1.9 < depth < 2.1 and alpha > 0.9, f"a wall two metres away: {depth}, {alpha}")
        check(said(blocks[2], names).split() == ["1000"], "a view by strips of rows")
        check(25 < float(said(blocks[3], names)) < 35, "a preset")
        said(blocks[4], names)
        check((pathlib.Path("room.html").read_bytes()[:15]).lower() == b"<!doctype html>", "a page")
        check("5000 Gaussians, harmonics of degree 1" in said(blocks[5], names), "a scene of arrays")
        check(len(trim3r.Scene.read("ball.spz")) == len(trim3r.Scene.read("ball.glb")) == 5000, "its files")
        keyframes = said(blocks[6], names).splitlines()
        check(2 < len(keyframes) < 10 and all(float(line.split()[3]) > 18 for line in keyframes[1:]), f"a stream: {keyframes}")
        check(len(trim3r.Scene.read("map.ply")) == 5000, "the map")
        hurried = [line.split() for line in said(blocks[7], names).splitlines()]
        check([line[0] for line in hurried] == ["1", "2", "3"] and hurried[0][1] == "1000", f"a hurried stream: {hurried}")
        check(re.findall(r"(\d+) keyframes", said(blocks[8], names)) == ["2", "4"], "a stream in two runs")
        drawn = said(blocks[9], names)
        check("256x256" in drawn and drawn.split()[-4:] == ["(256,", "256,", "3)", "True"], f"a picture: {drawn}")
        rows = said(blocks[10], names).splitlines()
        check([row.split()[1] for row in rows] == ["13107", "2621"], f"rows: {rows}")
        shown = re.search(r"::\n\n(.*?)\n\n[A-Z]", trim3r.__doc__, re.S)[1]
        check(25 < float(said(textwrap.dedent(shown), {})) < 35, "the docstring's")
        os.chdir(before)
    done()


if __name__ == "__main__":
    main()
