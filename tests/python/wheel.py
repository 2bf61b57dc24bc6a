#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""wheel.py LIBRARY BUILD: tools/python/wheel makes a wheel that pip installs into a new environment without a network. It
works there as in the tree, and loads no library from outside but those of every system."""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

from common import ROOT, check, skip, trim3r

from checks import done, run

USE = """
import pathlib, trim3r, warnings
warnings.simplefilter("error")
made = trim3r.Reconstructor(32, 32, views=1, head="tiny")
made.add_view(trim3r.room(1, 32, 32)[0])
scene = made.build(100)
for suffix in (".ply", ".spz", ".glb", ".sog"):
    scene.save("scene" + suffix)
    print(len(trim3r.Scene.read("scene" + suffix)))
print(pathlib.Path(trim3r.__file__).parent, trim3r.run_hash(made.stage_hashes))
for line in open("/proc/self/maps"):
    if ".so" in line:
        print("loads", line.split()[-1])
"""
# Libraries that Python, NumPy and cffi bring themselves are theirs.
OURS = re.compile(r"/lib(trim3r_python|bz2|cjson|crypto|lz4|webp|z|zip|zstd|lzma|sharpyuv)\.so")
SYSTEM = ("libz.so", "libbz2.so", "liblzma.so", "libcrypto.so", "libzstd.so") # which Python itself may have loaded before


def main():
    lacks = [name for name in ("pip", "setuptools", "wheel", "ensurepip") if not importlib.util.find_spec(name)]
    lacks += [name for name in ("readelf", "ldd") if not shutil.which(name)]
    if lacks:
        skip(f"no {', '.join(lacks)} (Debian: python3-pip, python3-setuptools, python3-wheel, python3-venv, binutils)")
    with tempfile.TemporaryDirectory(prefix="trim3r-wheel-") as folder:
        folder = pathlib.Path(folder).resolve()
        made = run(sys.executable, ROOT / "tools" / "python" / "wheel", sys.argv[2], folder / "wheels").stdout
        (wheel,) = (folder / "wheels").glob("*.whl")
        check(re.fullmatch(rf"trim3r-{re.escape(trim3r.__version__)}-py3-none-manylinux_2_\d+_\w+\.whl", wheel.name), wheel.name)
        check(str(wheel) in made and "glibc" in made, made)
        names = zipfile.ZipFile(wheel).namelist()
        bundled = {pathlib.Path(name).name for name in names if "/libraries/" in name and not name.endswith(".copyright")}
        check({"libcjson.so.1", "libzip.so.4"} <= bundled and not any(name.startswith("libc.so") for name in bundled), f"{bundled}")
        check(any(name.endswith("/LICENSE") for name in names), "the licence")
        run(sys.executable, "-m", "venv", "--system-site-packages", folder / "new")
        clean = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "PIP_", "LD_"))}
        subprocess.run([folder / "new" / "bin" / "pip", "install", "--no-index", "--no-deps", wheel], check=True,
                       capture_output=True, env=clean, cwd=folder)
        said = subprocess.run([folder / "new" / "bin" / "python", "-c", USE], check=True, capture_output=True, text=True,
                              env=clean, cwd=folder).stdout.splitlines()
        check(said[:4] == ["100"] * 4, f"scenes of each format: {said[:4]}")
        place, result = said[4].split()
        with trim3r.Reconstructor(32, 32, views=1, head="tiny") as here:
            here.add_view(trim3r.room(1, 32, 32)[0])
            here.build(100)
            check(place.startswith(f"{folder / 'new'}/") and result == trim3r.run_hash(here.stage_hashes), f"{said[4]}")
        loaded = {line.split()[1] for line in said if line.startswith("loads")}
        ours = {path for path in loaded if OURS.search(path)}
        outside = [path for path in ours if not path.startswith(place) and not any(name in path for name in SYSTEM)]
        check(not outside and any("libzip" in path for path in ours), f"loads {outside} of {sorted(ours)}")
    done()


if __name__ == "__main__":
    main()
