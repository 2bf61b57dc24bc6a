#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""host.py BUILD TRIM3R: the host library is installed and moved, and the programs of tools/examples are built with it: by
find_package and by pkg-config, with its static and its shared form. All write the same scene. Both forms show exactly what
the headers declare. A program compiled for other features is refused, and so is a component that is not installed."""
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile

from library import ROOT, SERIES, VERSION, ended, there, without

from checks import check, done, near, run

EXAMPLES = ROOT / "tools" / "examples"
HEADERS = [ROOT / "platform" / f"trim3r_{name}.h" for name in ("host", "capture", "program")]
LIBRARIES = [f"libtrim3r{name}.so.{SERIES}" for name in ("", "_host")]
# A program's own functions, with names that functions inside the library have, too.
CLASH = """#include <stdio.h>
#include "trim3r_host.h"
int t3r_reason(void) { return 7; }
int scene_file_read(void) { return 7; }
int quaternion_of(void) { return 7; }
int main(int count, char **words)
{
    char error[256];
    t3r_scene_file scene;
    if (t3r_scene_read(words[count - 1], 0, &scene, error, sizeof error) != T3R_OK) {
        printf("%s\\n", error);
        return 1;
    }
    printf("%u %d\\n", scene.count, t3r_reason() + scene_file_read() + quaternion_of());
    t3r_scene_free(&scene);
    return 0;
}
"""

# A program with the numbers of its user's language, which reads a scene and writes it again.
GERMAN = """#include <locale.h>
#include <stdio.h>
#include "trim3r_host.h"
int main(int count, char **words)
{
    char error[256], comma[8];
    t3r_scene_file read;
    if (count != 3 || setlocale(LC_ALL, "") == NULL || snprintf(comma, sizeof comma, "%.1f", 0.5) != 3 || comma[1] != ',') {
        return 2;
    }
    if (t3r_scene_read(words[1], 0, &read, error, sizeof error) != T3R_OK) {
        return 1;
    }
    const t3r_scene scene = {.frame = read.frame, .gaussians = read.gaussians, .count = read.count};
    const t3r_status status = t3r_scene_write(words[2], &scene, 0, error, sizeof error);
    t3r_scene_free(&read);
    return status != T3R_OK || snprintf(comma, sizeof comma, "%.1f", 0.5) != 3 || comma[1] != ',';
}
"""
# A scene as text, whose numbers are no whole ones.
FIELDS = ("x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2",
          "rot_3")
TEXT = "".join(["ply\nformat ascii 1.0\nelement vertex 3\n", *(f"property float {name}\n" for name in FIELDS), "end_header\n",
                *(f"0.2{i} 1.{i}5 2.5 0.1 0.2 0.3 1.5 -2.5 -2.25 -3.5 1 0 0 0\n" for i in range(3))])


def declared(text):
    """Returns the functions that a header declares, except inline ones."""
    text = re.sub(r"^\s*#.*$", "", re.sub(r"/\*.*?\*/", "", text, flags=re.S), flags=re.M)
    return set(re.findall(r"^(?!static |typedef )[a-z][\w *]*?\b(t3r_\w+)\(", text, flags=re.M))


def defined(library, *options):
    lines = run("nm", "--defined-only", "--format=posix", *options, library).stdout.splitlines()
    return {line.split()[0] for line in lines if len(line.split()) > 2}


def install(build, prefix, *components):
    for component in components:
        run("cmake", "--install", build, "--prefix", prefix, "--component", component)


def loads(program):
    """Returns which of our libraries a program loads, with their folders."""
    return dict(re.findall(r"^\s*(libtrim3r\S*) => (\S+)/\S+", run("ldd", program).stdout, flags=re.M))


def builds_of(installed, folder):
    """Builds the examples in each way; yields the way, the folder of the programs and whether they load the libraries."""
    for kind, shared in (("static", "OFF"), ("shared", "ON")):
        built = folder / kind
        run("cmake", "-S", EXAMPLES, "-B", built, f"-DCMAKE_PREFIX_PATH={installed}", f"-DTRIM3R_EXAMPLES_SHARED={shared}",
            "-DCMAKE_C_FLAGS=-Wall -Wextra -Wpedantic -Werror")
        run("cmake", "--build", built)
        yield f"find_package, {kind}", built, shared == "ON"
    os.environ["PKG_CONFIG_PATH"] = str(installed / "lib" / "pkgconfig")
    names = ("trim3r-host", "trim3r-heads")
    check(run("pkg-config", "--modversion", names[0]).stdout.strip() == VERSION, "pkg-config: the version")
    for kind, options in (("static", ("--static",)), ("shared", ())):
        built = folder / f"pkg_{kind}"
        built.mkdir()
        flags = run("pkg-config", *options, "--cflags", "--libs", *names).stdout.split()
        if options: # pkg-config leaves it to the linker which form it takes
            flags = [str(installed / "lib" / f"lib{flag[2:]}.a") if flag.startswith("-ltrim3r") else flag for flag in flags]
        for source in EXAMPLES.glob("*.c"):
            run("cc", source, *flags, f"-Wl,-rpath,{installed}/lib", "-o", built / f"example_{source.stem}")
        yield f"pkg-config, {kind}", built, not options


def check_ways(installed, folder, trim3r):
    room, scenes = folder / "room.mcap", {}
    run(trim3r, "room", "--size", "64x64", "--frames", "2", "-o", room)
    for way, built, is_shared in builds_of(installed, folder):
        programs = {path.name for path in built.glob("example_*")}
        check(programs == {f"example_{path.stem}" for path in EXAMPLES.glob("*.c")}, f"{way}: {programs}")
        scene = folder / "scene.spz"
        said = run(built / "example_scene_to_spz", room, scene).stdout
        check("Gaussians" in said, f"{way}: {said}")
        scenes[way] = scene.read_bytes()
        said = run(built / "example_two_threads", room).stdout.splitlines()
        check([line.split()[0] for line in said] == ["1", "2"], f"{way}: {said}")
        found = loads(built / "example_scene_to_spz")
        check(found == (dict.fromkeys(LIBRARIES, str(installed / "lib")) if is_shared else {}), f"{way} loads {found}")
    check(len(set(scenes.values())) == 1, f"the scenes differ: { {way: len(scene) for way, scene in scenes.items()} }")
    return scene


def check_program(installed, folder, source, *options):
    """Compiles a program with the static library; returns its path."""
    flags = run("pkg-config", "--static", "--cflags", "--libs", "trim3r-host").stdout.split()
    flags = [str(installed / "lib" / f"lib{flag[2:]}.a") if flag.startswith("-ltrim3r") else flag for flag in flags]
    run("cc", *options, source, *flags, "-o", folder / "program")
    return folder / "program"


def check_language(installed, folder):
    """Checks that a program whose numbers have commas reads and writes those of the files."""
    made = shutil.which("localedef") and ended("localedef", "-i", "de_DE", "-f", "UTF-8", folder / "de_DE.UTF-8")
    if not made or made.returncode != 0:
        print("without a locale whose numbers have commas: not here")
        return
    (folder / "german.c").write_text(GERMAN)
    (folder / "text.ply").write_text(TEXT)
    program = check_program(installed, folder, folder / "german.c")
    environment = {**os.environ, "LOCPATH": str(folder), "LC_ALL": "de_DE.UTF-8"}
    failed = ended(program, folder / "text.ply", folder / "german.glb", env=environment)
    check(failed.returncode == 0, f"in German: {failed.returncode}")
    failed = ended(program, folder / "text.ply", folder / "english.glb", env={**environment, "LC_ALL": "C"})
    check(failed.returncode == 2, "blind: the locale of C has commas")
    data = (folder / "german.glb").read_bytes()
    found = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])["accessors"][0]
    near(-found["min"][0], 0.22, 1e-6, "a number with a comma, read from text and written to JSON")


def check_absent(build, folder):
    """Checks that a component that is not installed is missed by its name."""
    install(build, folder / "bare", "dev", "shared")
    failed = ended("cmake", "-S", EXAMPLES, "-B", folder / "none", f"-DCMAKE_PREFIX_PATH={folder / 'bare'}")
    check(failed.returncode != 0 and "component host lacks the host library" in " ".join(failed.stderr.split()),
          f"without the component: {failed.stderr}")


def main():
    if not there("cmake", "pkg-config", "cc", "ldd", "nm"):
        sys.exit(77)
    build, trim3r = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    check(declared("int t3r_planted(int);\nstatic inline int t3r_inline(void)\n{\n}\n") == {"t3r_planted"}, "blind")
    wanted = set().union(*(declared(header.read_text()) for header in HEADERS))
    with tempfile.TemporaryDirectory(prefix="trim3r-host-") as folder:
        folder = pathlib.Path(folder).resolve()
        check_absent(build, folder)
        install(build, folder / "first", "dev", "shared", "host", "host_dev")
        installed = folder / "moved"
        shutil.move(folder / "first", installed) # the installation can be moved
        for library, *options in (("libtrim3r_host.so", "--dynamic"), ("libtrim3r_host.a", "--extern-only")):
            found = defined(installed / "lib" / library, *options)
            check(found == wanted, f"{library} shows or hides {sorted(found ^ wanted)}")
        scene = check_ways(installed, folder, trim3r)
        (folder / "clash.c").write_text(CLASH)
        said = run(check_program(installed, folder, folder / "clash.c"), scene).stdout.split()
        check(len(said) == 2 and int(said[0]) > 0 and said[1] == "21", f"names of a program: {said}")
        check_language(installed, folder)
        other = check_program(installed, folder, EXAMPLES / "two_threads.c", without("stereo"))
        failed = ended(other, folder / "room.mcap")
        check(failed.returncode == 1 and f"trim3r {VERSION} without stereo" in failed.stderr, f"features: {failed.stderr}")
    done()


if __name__ == "__main__":
    main()
