#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""files.py LIBRARY: a path that cannot be used raises what open() raises, and a scene that could not be read again is
refused before there is a file."""
import errno
import pathlib
import tempfile
import warnings

from common import check, np, refused, small, trim3r, with_views
from trim3r.scene import GAUSSIAN

from checks import done

SUFFIXES = (".ply", ".compressed.ply", ".splat", ".spz", ".glb", ".sog")
FLAGS = ({}, {"local": True}, {"comments": True})
COUNT = 5


def gaussians(count=COUNT, **fields):
    """Returns Gaussians side by side, with these fields changed."""
    made = np.zeros(count, GAUSSIAN)
    made["position_q20"][:, 0] = np.arange(count) << 20
    made["factor"][:, [0, 4, 8]] = 1 << 14
    made["factor_exponent"] = -20
    made["opacity_q15"] = 30000
    for name, value in fields.items():
        made[name] = value
    return made


def check_paths(folder, scene):
    recording, head = trim3r.Recording, lambda path: small(head=path)
    readers = ((recording, ".mcap"), (trim3r.Scene.read, ".ply"), (head, ".t3w"))
    for read, suffix in readers:
        for path in (folder / f"nowhere{suffix}", folder / "nowhere" / f"at{suffix}", str(folder / f"nowhere{suffix}")):
            with refused(FileNotFoundError, "nowhere"):
                read(path)
        try:
            read(folder / f"nowhere{suffix}")
        except OSError as error:
            check(error.errno == 2 and str(error.filename).endswith(f"nowhere{suffix}"), f"{error!r}")
        (folder / f"folder{suffix}").mkdir()
        with refused(IsADirectoryError, "folder"):
            read(folder / f"folder{suffix}")
    for call, suffix in (*readers, *((scene.save, suffix) for suffix in SUFFIXES)):
        for path in (f"{folder}/a\0b{suffix}", f"{folder}/a{suffix}\0{suffix}", f"{folder}/a\0{suffix}".encode()):
            with refused(ValueError, "null byte"):
                call(path)
    with refused(FileNotFoundError, "nowhere"):
        scene.save(folder / "nowhere" / "at" / "all.ply")
    for name in ("scene.obj", "scene", "scene.ply.gz"):
        with refused(trim3r.InputError, name, "scenes are written as .ply"):
            scene.save(folder / name)
    (folder / "full.spz").symlink_to("/dev/full")
    for path, code in ((folder / "full.spz", errno.ENOSPC), (folder / "nowhere" / "at.glb", errno.ENOENT),
                       (folder / f"{'a' * 300}.ply", errno.ENAMETOOLONG)):
        try:
            scene.save(path)
            check(False, f"{path} is written")
        except OSError as error:
            check((error.errno, error.filename) == (code, str(path)), f"{error!r}")
    check(not (folder / "a").exists(), "the name is not cut at the zero byte")


def written(scene, path, **flags):
    """Whether a scene is written; then it must read back, with its positions."""
    path.unlink(missing_ok=True)
    try:
        scene.save(path, **flags)
    except trim3r.InputError:
        check(not path.exists(), f"{path.name}: refused, and yet a file")
        return False
    read = trim3r.Scene.read(path)
    away = np.abs(read.positions - scene.positions).max() / np.ldexp(1.0, scene.exponent)
    check(len(read) == len(scene) and (away < 0.01 or "local" in flags), f"{path.name}: {away} units away")
    return True


def check_scenes(folder):
    """Scenes with a fault each, in all formats: refused, the place of the fault named, and what is there stays."""
    origin = (1 << 32, 0, -5 << 32)
    for what, scene in (("no Gaussians", trim3r.Scene(gaussians(0), origin, 0)),
                        ("a position", trim3r.Scene(gaussians(position_q20=2**31 - 1), origin, 0)),
                        ("an exponent", trim3r.Scene(gaussians(factor_exponent=99), origin, 0)),
                        ("a colour", trim3r.Scene(gaussians(colour_q7=65535), origin, 0)),
                        ("an opacity", trim3r.Scene(gaussians(opacity_q15=65535), origin, 0)),
                        ("a reserved byte", trim3r.Scene(gaussians(reserved=1), origin, 0)),
                        ("scales beyond all", trim3r.Scene(gaussians(1, factor_exponent=15), origin, 24)),
                        ("a point of no size", trim3r.Scene(gaussians(1, factor=0), origin, 0))):
        for suffix in SUFFIXES:
            for flags in FLAGS:
                path = folder / f"faulty{suffix}"
                check(not written(scene, path, **flags), f"{what} is written as {suffix} with {flags}")
                path.write_bytes(b"there")
                with refused(trim3r.InputError, path.name):
                    scene.save(path, **flags)
                check(path.read_bytes() == b"there", f"{what}, {suffix}: what was there is gone")
    one = gaussians()
    one["factor_exponent"][3] = 16
    with refused(trim3r.InputError, "Gaussian 3"):
        trim3r.Scene(one, origin, 0).save(folder / "one.ply")
    for exponent in (-20, -4, 0, 10, 20):
        near = tuple(int(np.ldexp(units, 32 + exponent)) for units in (1, 0, -5))
        for suffix in SUFFIXES:
            for flags in FLAGS:
                check(written(trim3r.Scene(gaussians(), near, exponent), folder / f"good{suffix}", **flags),
                      f"2^{exponent} as {suffix} with {flags}")
    edited = trim3r.Scene(gaussians(), origin, 0)
    edited.exponent = 1 << 40
    with refused(ValueError, "exponent", "-24..24"):
        edited.save(folder / "edited.ply")
    with small(0, gaussians=COUNT) as made, refused(ValueError, "exponent", "-24..24"):
        made.load(edited)


def main():
    warnings.simplefilter("ignore") # of formats that cut widths off
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder, with_views() as made:
        check_paths(pathlib.Path(folder), made.build(50))
        check_scenes(pathlib.Path(folder))
    done()


if __name__ == "__main__":
    main()
