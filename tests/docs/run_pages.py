#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""run_pages.py TRIM3R [PAGE...]: the shell blocks of the pages (pages.py) run, and print the text on the pages.

The blocks of a page run in order in an empty folder with the files that the page names as given. A text block directly
after a shell block is its output, line by line; `...` stands for anything within a line, and alone in a line for any
lines. A page that needs a missing build output, as <!-- needs: build/release/NAME -->, is skipped.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from given import MAKERS, Given
from pages import ROOT, all_pages, blocks_of, given_in, needed_by

LIMIT = 300  # seconds for one block


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    chosen = [pathlib.Path(name).resolve() for name in sys.argv[2:]] or all_pages()
    with tempfile.TemporaryDirectory(prefix="trim3r-docs-") as folder:
        folder = pathlib.Path(folder)
        made = Given(program, folder / "given")
        find_what_is_planted(program, made, folder)
        count, findings = 0, []
        for page in chosen:
            began = time.monotonic()
            run, found = run_page(page.name, page.read_text(), program, made, folder)
            print(f"{page.relative_to(ROOT)}: {run} blocks, {time.monotonic() - began:.1f} s", flush=True)
            count, findings = count + run, findings + found
    for finding in findings:
        print("FAILED:", finding)
    if findings or count == 0:
        sys.exit(1)
    print(f"{count} blocks run as the pages say")


def find_what_is_planted(program, made, folder):
    """Checks that a failing command, a different output and a missing input are each found."""
    planted = {"exit status": "```sh\ntrim3r room -o room.mcap\ntrim3r info nowhere.mcap\n```\n",
               "the page says": "```sh\necho one; echo two; echo three\n```\n\n```text\none\n...\ntwo\n```\n",
               "unknown": "<!-- given: nothing.mcap -->\n"}
    for text, page in planted.items():
        _, found = run_page("planted.md", page, program, made, folder)
        if not any(text in finding for finding in found):
            sys.exit(f"blind: '{text}' planted in a page was not found: {found}")
    good = "```sh\necho one 1.5 ms; echo two; echo three\n```\n\n```text\none ... ms\n...\nthree\n```\n"
    if run_page("planted.md", good, program, made, folder) != (1, []):
        sys.exit("sees an offence where there is none")


def run_page(name, text, program, made, folder):
    """Returns the number of blocks that ran, and the findings."""
    findings = [f"{name}: a file of an unknown name is given: {wanted}" for wanted in given_in(text) if wanted not in MAKERS]
    if findings:
        return 0, findings
    with tempfile.TemporaryDirectory(prefix="page-", dir=folder) as place:
        place = pathlib.Path(place)
        link_the_tree(place, program)
        lacking = [needed for needed in needed_by(text) if not (place / needed).exists()]
        if lacking:
            print(f"{name}: left out, {', '.join(lacking)} was not built")
            return 0, []
        for wanted in given_in(text):
            made.put(wanted, place)
        blocks = [block for block in blocks_of(text) if block.runs]
        for block in blocks:
            finding = run_block(block, place, program)
            if finding:
                findings.append(f"{name}:{block.line}: {finding}")
    return len(blocks), findings


def link_the_tree(place, program):
    """Links the repository's folders that commands name."""
    for name in ("runtime", "quant", "tools"):
        (place / name).symlink_to(ROOT / name)
    (place / "build").mkdir()
    (place / "build" / "release").symlink_to(program.parent)


def run_block(block, place, program):
    path = f"{program.parent}:{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"
    environment = dict(os.environ, PATH=path, TERM="dumb")
    script = "set -e\n" + block.body
    try:
        ended = subprocess.run(["bash", "-c", script], cwd=place, env=environment, timeout=LIMIT, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    except subprocess.TimeoutExpired:
        return f"takes more than {LIMIT} s"
    if ended.returncode != 0:
        return f"exit status {ended.returncode}\n{ended.stdout[-2000:]}"
    if block.expected is not None and not re.fullmatch(pattern_of(block.expected), ended.stdout):
        return f"prints\n{ended.stdout}the page says\n{block.expected}"
    return None


def pattern_of(expected):
    lines = (r"(?:.*\n)*" if line == "..." else ".*".join(map(re.escape, line.split("..."))) + "\n"
             for line in expected.splitlines())
    return "".join(lines)


if __name__ == "__main__":
    main()
