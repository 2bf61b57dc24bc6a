#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""pages.py SCRIPTS DOCS: `pages` reads the epochs that pages name, continues after a page fails, records the time of
each, and the index of docs/study equals its output."""
import contextlib
import importlib.machinery
import importlib.util
import io
import os
import re
import sys
import tempfile

from checks import check, done

scripts, docs = sys.argv[1:3]
sys.path.insert(0, scripts)
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("pages", os.path.join(scripts, "pages"))
pages = importlib.util.module_from_spec(importlib.util.spec_from_loader("pages", loader))
loader.exec_module(pages)

HEADS = {
    "Made by `x --write`: bits epoch 6, 2 cores.": 6,
    "Made by\n`x`, bits\nepoch 12: the room": 12,
    "Nobody says when.": None,
}


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def epochs(folder):
    pages.PAGES = folder
    for head, expected in HEADS.items():
        write(f"{folder}/page.md", f"# Page\n\n{head}\n")
        check(pages.epoch_of("page") == expected, f"{head!r} is of {pages.epoch_of('page')}")


def made(folder):
    """One page is made, one fails: reported, recorded, and the third is still made."""
    pages.PAGES, pages.ROOT, pages.INDEX, pages.PROGRAM = folder, folder, f"{folder}/README.md", "/bin/true"
    pages.bits_epoch = lambda program: "6"
    script = "for page; do printf 'bits epoch 6.' >\"$page\"; done"
    pages.MADE = {
        "one": [["sh", "-c", script, "sh", "one.md"]],
        "fails": [["false"]],
        "three": [["sh", "-c", script, "sh", "three.md"]],
        "new": [["false"]],
    }
    for name, epoch in (("one", 5), ("fails", 5), ("three", 4), ("new", 6)):
        write(f"{folder}/{name}.md", f"bits epoch {epoch}.")
    write(pages.INDEX, "<!-- pages:begin -->\n| `one` | 5 | 70 |\n| `fails` | 5 | 3 |\n<!-- pages:end -->\n")

    said, warned = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(warned):
        sys.argv = ["pages", "--make"]
        status = pages.main()
    check(status == 1 and "2 of 3 made in 0 min; failed: fails" in said.getvalue(), f"{status}: {said.getvalue()}")
    check("one, 1 of 3; 0 min so far, left: 73 min and 1 whose time is not known" in warned.getvalue(), warned.getvalue())
    check(pages.epoch_of("three") == 6 and pages.epoch_of("fails") == 5, "the others go on")
    index = read(pages.INDEX)
    check("| `one` | 6 | 70 |\n| `fails` | 5 | 3 |\n| `three` | 6 | 0 |\n| `new` | 6 | - |" in index, f"what is noted: {index}")


def index():
    """The repository's index agrees with its pages."""
    told = read(os.path.join(docs, "study", "README.md"))
    stands = re.search(r"<!-- pages:begin -->\n(.*?)<!-- pages:end -->", told, re.DOTALL)[1].splitlines()
    check(stands == pages.lines(pages.minutes_told()), "docs/study/README.md: tools/study/scripts/pages --index")


index()
with tempfile.TemporaryDirectory() as scratch:
    epochs(scratch)
    made(scratch)
done()
