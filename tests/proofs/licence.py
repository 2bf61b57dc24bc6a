#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""licence.py: each source file that git tracks, except generated ones, names its licence in its first lines."""
import subprocess
import sys

import proof
from format import WRITTEN

LINE, WITHIN = "SPDX-License-Identifier: Apache-2.0", 4
# Files of others, which keep their licence.
OTHERS = {proof.ROOT / "tools/viewer/page/fzstd/fzstd.js": "SPDX-License-Identifier: MIT"}
ENDINGS = {".bash", ".bb", ".c", ".cmake", ".cpp", ".css", ".fish", ".h", ".hpp", ".html", ".in", ".js", ".ld", ".mjs", ".py",
           ".pyi", ".sh", ".toml", ".xml", ".yml", ".zsh"}
NAMES = {"CMakeLists.txt", "Snakefile"}


def is_source(path):
    return path.suffix in ENDINGS or path.name in NAMES or not path.suffix and path.read_bytes()[:2] == b"#!"


def check(paths):
    lines = {path: OTHERS.get(path, LINE) for path in paths}
    return [f"{path}: no line '{line}'" for path, line in lines.items() if line not in "".join(path.read_text().splitlines()[:WITHIN])]


def main():
    with proof.scratch() as folder:
        planted = folder / "planted.c"
        planted.write_text("\n" * WITHIN + f"/* {LINE} */\n")
        proof.must_find(check([planted]), "planted.c", "a file whose licence stands too far down")
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=proof.ROOT, capture_output=True, text=True, check=False)
    if tracked.returncode != 0:
        print("SKIPPED: no checkout of git")
        sys.exit(77)
    names = [name for name in tracked.stdout.split("\0") if name and name not in WRITTEN and "/seeds/" not in name]
    paths = [path for path in map(proof.ROOT.joinpath, names) if path.is_file() and is_source(path)]
    proof.verdict(f"{len(paths)} source files name their licence", check(paths))


if __name__ == "__main__":
    sys.exit(main())
