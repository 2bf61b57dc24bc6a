#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""configure.py CMAKE: on a bare system the build lists all missing packages at once, and omits the tests."""
import os
import pathlib
import subprocess
import sys
import tempfile

from checks import check, done

CMAKE = sys.argv[1]
ROOT = pathlib.Path(__file__).resolve().parents[2]


def packages(folder, without):
    """Makes a folder with the packages of pkg-config, except some."""
    path = subprocess.run(["pkg-config", "--variable", "pc_path", "pkg-config"], capture_output=True, text=True,
                          check=True).stdout.strip()
    folder.mkdir()
    for here in path.split(":"):
        for file in pathlib.Path(here).glob("*.pc") if os.path.isdir(here) else []:
            if file.stem not in without and not (folder / file.name).exists():
                (folder / file.name).symlink_to(file)
    return str(folder)


def configure(folder, without, *options):
    """Returns the exit status and cmake's output."""
    name = f"build-{len(list(folder.iterdir()))}"
    environment = {**os.environ, "PKG_CONFIG_LIBDIR": packages(folder / f"{name}-packages", without)}
    environment.pop("PKG_CONFIG_PATH", None)
    ended = subprocess.run([CMAKE, "-S", ROOT, "-B", folder / name, "-DT3R_LIBCAMERA=OFF", "-DT3R_OPENCV=OFF",
                            "-DT3R_POSES=OFF", *options],
                           capture_output=True, text=True, env=environment)
    return ended.returncode, ended.stdout + ended.stderr


def main():
    with tempfile.TemporaryDirectory(prefix="trim3r-configure-") as scratch:
        folder = pathlib.Path(scratch)
        status, text = configure(folder, ["cmocka"])
        check(status == 0 and "they need cmocka (Debian: libcmocka-dev)" in text, f"without cmocka: {status} {text}")
        status, text = configure(folder, ["cmocka"], "-DT3R_TESTS=ON")
        check(status != 0 and "libcmocka-dev" in text and "-DT3R_TESTS=OFF" in text, f"tests without cmocka: {text}")
        status, text = configure(folder, ["libzip", "libpng"])
        check(status != 0 and "libzip-dev" in text and "libpng-dev" in text and "-DT3R_TOOLS=OFF" in text,
              f"without two libraries: {text}")
        status, text = configure(folder, ["cmocka", "libzip", "libcjson"], "-DT3R_TOOLS=OFF")
        check(status == 0, f"the runtime alone: {text}")
        status, text = configure(folder, ["cmocka"], "-DT3R_STUDY=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
        commands = (max(folder.glob("build-*/compile_commands.json"), key=os.path.getmtime)).read_text()
        check(status == 0 and "/tools/trim3r/main.c" in commands and "/tools/study/" not in commands,
              f"the product without its study: {text}")
    done()


if __name__ == "__main__":
    sys.exit(main())
