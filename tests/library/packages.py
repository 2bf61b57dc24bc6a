#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""packages.py BUILD: cpack makes Debian packages of the build folder. Unpacked together into one folder, a program is
built with what lies there, and the packed program runs. Files, names and dependencies are as wanted."""
import pathlib
import re
import sys
import tempfile

from library import CONSUMERS, HASH, SERIES, VERSION, there

from checks import check, done, run

SHARED, HOST = f"libtrim3r{SERIES}", f"libtrim3r-host{SERIES}"
FILES = {
    SHARED: [f"lib/libtrim3r.so.{SERIES}", f"lib/libtrim3r.so.{VERSION}", f"share/sbom/{SHARED}.spdx.json"],
    "libtrim3r-dev": ["include/trim3r.h", "include/trim3r_arena.h", "include/trim3r_features.h", "include/trim3r_heads.h",
                      "include/trim3r_interface.h", "include/trim3r_settings.h",
                      "lib/cmake/trim3r/trim3r-config-version.cmake", "lib/cmake/trim3r/trim3r-config.cmake",
                      "lib/cmake/trim3r/trim3r-targets-release.cmake", "lib/cmake/trim3r/trim3r-targets.cmake", "lib/libtrim3r.a", "lib/libtrim3r.so",
                      "lib/libtrim3r_heads.a", "lib/pkgconfig/trim3r-heads.pc", "lib/pkgconfig/trim3r.pc",
                      "share/sbom/libtrim3r-dev.spdx.json"],
    HOST: [f"lib/libtrim3r_host.so.{SERIES}", f"lib/libtrim3r_host.so.{VERSION}", f"share/sbom/{HOST}.spdx.json"],
    "libtrim3r-host-dev": ["include/trim3r_capture.h", "include/trim3r_host.h", "include/trim3r_program.h",
                           "lib/cmake/trim3r/trim3r-host-targets-release.cmake",
                           "lib/cmake/trim3r/trim3r-host-targets.cmake", "lib/libtrim3r_host.a", "lib/libtrim3r_host.so",
                           "lib/pkgconfig/trim3r-host.pc", "share/sbom/libtrim3r-host-dev.spdx.json"],
    "trim3r": ["bin/trim3r", "share/bash-completion/completions/trim3r", "share/fish/vendor_completions.d/trim3r.fish",
               "share/man/man1/trim3r.1", "share/sbom/trim3r.spdx.json", "share/zsh/site-functions/_trim3r",
               "share/zsh/vendor-completions/_trim3r"],
}
NEEDS = {HOST: [f"{SHARED} (= {VERSION})", "libc6", "libzip4"],
         "libtrim3r-host-dev": [f"libtrim3r-dev (= {VERSION})", f"{HOST} (= {VERSION})", "libzip-dev"],
         SHARED: ["libc6"], "libtrim3r-dev": [f"{SHARED} (= {VERSION})"],
         "trim3r": ["libc6", "libcjson1", "libjpeg", "liblz4-1", "libpng16-16", "libzip4", "libzstd1"]}
if any(pathlib.Path(sys.argv[1]).glob("python/trim3r/*.so")): # where the Python package was built
    FILES["python3-trim3r"] = sorted(f"lib/python3/dist-packages/trim3r/{path.name}"
                                     for path in pathlib.Path(sys.argv[1]).glob("python/trim3r/*") if path.is_file())
    FILES["python3-trim3r"].append("share/sbom/python3-trim3r.spdx.json")
    NEEDS["python3-trim3r"] = ["libc6", "python3-cffi-backend", "python3-numpy", "libzstd1"]
MODULES = {"trim3r-cameras", "trim3r-poses"} # only where the libraries for them are


def fields_of(package):
    return dict(re.findall(r"^(\w[\w-]*): (.*)$", run("dpkg-deb", "--field", package).stdout, flags=re.M))


def files_in(package):
    """Returns paths below /usr; a multiarch folder counts as lib."""
    lines = run("dpkg-deb", "--contents", package).stdout.splitlines()
    paths = [line.split()[5] for line in lines if not line.startswith("d")]
    check(all(path.startswith("./usr/") for path in paths), f"{package.name}: outside /usr: {paths}")
    return sorted(re.sub(r"^\./usr/(lib/[a-z0-9_]+-linux-gnu\w*/)?", lambda m: "lib/" if m[1] else "", path)
                  for path in paths)


def check_package(package, fields):
    name = fields["Package"]
    check(fields["Version"] == VERSION, f"{name}: version {fields['Version']}")
    check(fields.get("Architecture") == run("dpkg", "--print-architecture").stdout.strip(), f"{name}: architecture")
    check(files_in(package) == FILES[name], f"{name} holds {files_in(package)}")
    for needed in NEEDS[name]:
        check(needed in fields.get("Depends", ""), f"{name}: needs {fields.get('Depends')}, and not {needed}")


def check_use(root, folder):
    """Runs a consumer of the unpacked library, and the unpacked program."""
    usr = root / "usr"
    library = next(usr.rglob("libtrim3r.so")).parent
    run("cmake", "-S", CONSUMERS, "-B", folder / "use", f"-DCMAKE_PREFIX_PATH={usr}", f"-DWANTED_VERSION={VERSION}")
    run("cmake", "--build", folder / "use")
    for kind in ("trim3r", "shared"):
        said = run(folder / "use" / f"consumer_{kind}").stdout
        check(said.split() == [HASH, HASH, VERSION], f"consumer, {kind}: {said}")
    program, room = usr / "bin" / "trim3r", folder / "room.mcap"
    check(str(library) not in run("ldd", program).stdout, "the program loads the library that it holds already")
    run(program, "room", "--size", "32x32", "-o", room)
    said = run(program, "replay", room).stdout
    check(re.search(r"^final +[0-9a-f]{16}$", said, flags=re.M), f"the packed program replays: {said}")


def main():
    if not there("cpack", "cmake", "dpkg-deb", "dpkg-shlibdeps"):
        sys.exit(77)
    build = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="trim3r-packages-") as folder:
        folder = pathlib.Path(folder).resolve()
        run("cpack", "--config", build / "CPackConfig.cmake", "-B", folder / "packages")
        packages = {}
        for path in (folder / "packages").glob("*.deb"):
            packages[fields_of(path)["Package"]] = path
        commands = [line.split("\t")[0] for line in run(build / "trim3r", "--commands").stdout.splitlines()]
        FILES["trim3r"] += [f"share/man/man1/trim3r-{command}.1" for command in commands]
        FILES["trim3r"].sort()
        check(set(packages) - MODULES == set(FILES), f"packages: {sorted(packages)}")
        for name in FILES:
            check_package(packages[name], fields_of(packages[name]))
            run("dpkg-deb", "--extract", packages[name], folder / "root")
        check_use(folder / "root", folder)
        total = {name: path.stat().st_size for name, path in sorted(packages.items())}
    print(", ".join(f"{name}: {size} bytes" for name, size in total.items()))
    done()


if __name__ == "__main__":
    main()
