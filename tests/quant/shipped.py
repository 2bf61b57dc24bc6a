#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""shipped.py TRIM3R HEADS: tools/study/train/ship makes the C arrays in HEADS of the float heads next to them."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

trim3r, heads = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
ship = heads.parent.parent / "tools" / "study" / "train" / "ship"


def integers(path):
    return [int(n) for n in re.findall(r"\d+", path.read_text().split("= {", 1)[1].split("}", 1)[0])]


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


with tempfile.TemporaryDirectory() as folder:
    # a separate tree, so that nothing in the repository is written
    tree = pathlib.Path(folder)
    (tree / "tools" / "study" / "train").mkdir(parents=True)
    (tree / "quant" / "heads").mkdir(parents=True)
    (tree / "tools" / "study" / "train" / "ship").write_bytes(ship.read_bytes())
    names = sorted(path.stem for path in heads.glob("*.safetensors"))
    check(names == ["small", "tiny"], f"float heads: {names}")
    for name in names:
        (tree / "quant" / "heads" / f"{name}.safetensors").write_bytes((heads / f"{name}.safetensors").read_bytes())

    def run(*arguments, expected=0):
        done = subprocess.run(["bash", tree / "tools" / "study" / "train" / "ship", *arguments], capture_output=True, text=True,
                              env={**os.environ, "TRIM3R": trim3r})
        check(done.returncode == expected, f"ship {arguments}: status {done.returncode}: {done.stdout}{done.stderr}")

    run()
    for name in names:
        made, shipped = integers(tree / "quant" / "heads" / f"{name}.c"), integers(heads / f"{name}.c")
        check(made == shipped, f"{name}.c is not what {name}.safetensors becomes: tools/study/train/ship")
        check(made[:4] == list(b"T3RW"), f"{name}.c holds no weight file")
    other = tree / "other.safetensors"
    other.write_bytes((heads / "small.safetensors").read_bytes())
    run("tiny", other)
    check((tree / "quant" / "heads" / "tiny.safetensors").read_bytes() == other.read_bytes(), "the float copy")
    check(bytes(integers(tree / "quant" / "heads" / "tiny.c")[32:36]) == b"tiny", "the name is the shipped one")
    run("large", expected=2)
print(f"{len(names)} heads")
