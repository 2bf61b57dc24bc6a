#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""subproject.py BUILD TRIM3R: a project that has the tree as a subproject gets its libraries and nothing else, by
add_subdirectory() and by FetchContent; what it does not link is not built. Its program writes a scene. The build stays in
BUILD, so that only changes are built again."""
import pathlib
import shutil
import sys
import tempfile

from library import HERE, ROOT, there

from checks import check, done, run


def main():
    if not there("cmake", "pkg-config"):
        sys.exit(77)
    build, trim3r = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    user = build / "subproject"
    quick = "-O0 -U__SSE2__" # without SSE2 the runtime has no vectors, which take half of the time
    options = [f"-DTRIM3R={ROOT}", "-DCMAKE_BUILD_TYPE=Debug", f"-DCMAKE_C_FLAGS_DEBUG={quick}"]
    if shutil.which("ninja"):
        options.append("-GNinja")
    if shutil.which("ccache"):
        options.append("-DCMAKE_C_COMPILER_LAUNCHER=ccache")
    run("cmake", "-S", HERE / "subproject", "-B", user, *options)
    run("cmake", "--build", user)
    built = {path.name for path in user.rglob("*") if path.suffix in (".a", ".so") or path.name in ("user", "trim3r.o")}
    check({"libtrim3r.a", "libtrim3r_host.a", "libtrim3r_heads.a", "user"} <= built, f"built: {built}")
    check("libtrim3r.so" not in built and "libtrim3r_host.so" not in built, f"what is not linked is built: {built}")
    check(not list(user.glob("libtrim3r*")), "the libraries are in the user's own folder")
    with tempfile.TemporaryDirectory(prefix="trim3r-subproject-") as folder:
        folder = pathlib.Path(folder)
        run(trim3r, "room", "--size", "64x64", "--frames", "2", "-o", folder / "room.mcap")
        run(user / "user", folder / "room.mcap", folder / "scene.spz")
        said = run(trim3r, "info", folder / "scene.spz").stdout
        check("Gaussians" in said, f"the program's scene: {said}")
        run("cmake", "-S", HERE / "subproject", "-B", folder / "fetched", "-DBY_FETCH=ON", *options)
        alone = run("cmake", "-S", HERE / "subproject", "-B", folder / "without", "-DT3R_HOST=OFF", *options, expect=1)
        check("trim3r::host" in alone.stderr, f"without the host library: {alone.stderr}")
    done()


if __name__ == "__main__":
    main()
