#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""installed.py LIBRARY BUILD: `cmake --install` and pip put the complete package into a folder, and it works after a
move."""
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from common import PACKAGE, check, trim3r

from checks import done, run

USE = """
import pathlib, trim3r
made = trim3r.Reconstructor(32, 32, views=1, head="tiny")
made.add_view(trim3r.room(1, 32, 32)[0])
made.build(100)
print(pathlib.Path(trim3r.__file__).parent, trim3r.run_hash(made.stage_hashes))
"""


def by_cmake(there):
    run("cmake", "--install", sys.argv[2], "--prefix", there, "--component", "python")


def by_pip(there):
    source = there.with_name("source") # pip leaves build folders there
    shutil.copytree(PACKAGE.parent, source)
    run(sys.executable, "-m", "pip", "install", "--no-deps", "--no-index", "--no-build-isolation", "--target", there,
        source)


def check_installed(install, folder):
    install(folder / "there")
    installed = next((folder / "there").rglob("trim3r"))
    files = {path.name for path in installed.iterdir() if path.is_file()}
    check(files == {path.name for path in PACKAGE.iterdir() if path.is_file()}, f"files: {sorted(files)}")
    check(not any(path.is_symlink() for path in installed.iterdir()), "no links into the tree")
    moved = folder / "moved" / "trim3r"
    shutil.copytree(installed, moved)
    shutil.rmtree(folder / "there")
    said = subprocess.run([sys.executable, "-B", "-c", USE], env={**os.environ, "PYTHONPATH": str(moved.parent)},
                          capture_output=True, text=True, check=True).stdout.split()
    with trim3r.Reconstructor(32, 32, views=1, head="tiny") as made:
        made.add_view(trim3r.room(1, 32, 32)[0])
        made.build(100)
        check(said == [str(moved), trim3r.run_hash(made.stage_hashes)], f"{said}")


def main():
    ways = [by_cmake, by_pip]
    if not all(map(importlib.util.find_spec, ("pip", "setuptools", "wheel"))):
        print("no pip (Debian: python3-pip): cmake alone")
        ways.pop()
    for way in ways:
        with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
            check_installed(way, pathlib.Path(folder).resolve())
    done()


if __name__ == "__main__":
    main()
