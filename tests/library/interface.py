#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""interface.py LIBRARY: programs and the library agree on the structs of trim3r.h, or the program gets an error.

The structs are the same with short enumerations and without, for gcc and clang. A program with short ones uses the
library and gets its hash. A program compiled with another layout, or with other features, gets a specific status from
every call with which it may start, and nothing is written.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from library import CONSUMERS, HASH, HEADS, HERE, ROOT, WARNINGS, there, without

from checks import check, done, run

INCLUDE = ROOT / "runtime" / "include"
MISMATCH = -14
SHORT = ("-fshort-enums", "-fno-short-enums")
COMPILERS = {"x86-64": (["gcc"], ["clang"]),
             "Cortex-M55": (["arm-none-eabi-gcc", "-mcpu=cortex-m55", "-ffreestanding"],
                            ["clang", "--target=arm-none-eabi", "-mcpu=cortex-m55", "-ffreestanding"])}
# Differences that another version of the header could have.
PLANTED = {
    "a field more": ("typedef struct t3r_config {", "typedef struct t3r_config {\n    uint32_t planted;"),
    "a wider field": ("uint32_t rgb_stride_bytes;", "uint64_t rgb_stride_bytes;"),
    "a setting of another name": ("X(fill_radius,", "X(fill_reach,"),
    "two fields in another order": ("    int8_t factor_exponent;\n", "    uint8_t planted;\n    int8_t factor_exponent;\n"),
}
ENUM = ("typedef uint32_t t3r_head;", "typedef enum t3r_planted { T3R_PLANTED } t3r_head;")


def header(folder, change=None):
    """Copies the headers to a folder, and changes one of them."""
    shutil.copytree(INCLUDE, folder)
    if change:
        texts = {path: path.read_text() for path in folder.glob("*.h")}
        changed = [path for path, text in texts.items() if change[0] in text]
        check(len(changed) == 1 and texts[changed[0]].count(change[0]) == 1, f"not one '{change[0]}' in the headers")
        changed[0].write_text(texts[changed[0]].replace(*change))
    return folder


def layout(include, compiler, short, folder):
    """Returns the constants of interface_layout.c."""
    made = folder / "layout.o"
    run(*compiler, "-std=c11", "-w", short, "-I", include, "-c", HERE / "interface_layout.c", "-o", made)
    run("objcopy", "-O", "binary", "--only-section=.rodata*", "-I", "elf32-little" if "arm" in " ".join(compiler) else
        "elf64-x86-64", made, made.with_suffix(".bin"))
    return made.with_suffix(".bin").read_bytes()


def layouts(include, compilers, folder):
    return {layout(include, compiler, short, folder) for compiler in compilers for short in SHORT}


def fields_of(text):
    """Returns [type, field] for every struct in the header, in order."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    for name, body in re.findall(r"^typedef struct (\w+) \{$(.*?)^\} \1;$", text, flags=re.M | re.S):
        for declaration in re.sub(r"\[\w*\]", "", body).split(";"):
            called = re.search(r"\(\*(\w+)\)\(", declaration)
            names = [called[1]] if called else re.findall(r"(\w+)\s*(?:,|$)", declaration.strip())
            yield from ((name, field) for field in names)


def check_rows():
    """Checks that each struct and each field has its row in trim3r_interface.h, and settings in trim3r_settings.h."""
    header = (INCLUDE / "trim3r.h").read_text()
    fields = list(fields_of(header))
    rows = (INCLUDE / "trim3r_interface.h").read_text()
    check(len(fields) > 60, f"blind: {len(fields)} fields found")
    check(re.findall(r"X\((t3r_\w+), (\w+)\)", rows) == fields,
          f"trim3r_interface.h lacks rows, or has others: {set(re.findall(r'X.(t3r_.+), (.+?).[ )]', rows)) ^ set(fields)}")
    check(re.findall(r"X\((t3r_\w+)\)", rows) == re.findall(r"^typedef struct (\w+) \{$", header, flags=re.M), "rows of structs")


def answers(include, library, folder, *words):
    """Returns the results of a program compiled with these headers, line by line."""
    program = folder / "driver"
    run("cc", "-std=c11", "-O1", *WARNINGS, *words, "-I", include, HERE / "interface_driver.c", library, "-o", program)
    ended = subprocess.run([program], capture_output=True, text=True, check=False)
    check(ended.returncode == 0, f"the program ends with {ended.returncode}: {ended.stdout}")
    return dict(line.split(": ", 1) for line in ended.stdout.splitlines())


def check_mismatches(library, folder):
    plain = answers(INCLUDE, library, folder)
    del plain["reason"]
    agreed = {name: "0, nothing written" if name == "plan_within" else "0, written" for name in plain}
    agreed["default_config"], agreed["attach"] = "defaults", plain["attach"]
    check(plain == agreed and plain["attach"].startswith("0"), f"with the library's header: {plain}")
    refused = {name: "zeros" if name == "default_config" else f"{MISMATCH}, nothing written" for name in plain}
    for number, (what, change) in enumerate(PLANTED.items()):
        found = answers(header(folder / f"planted{number}", change), library, folder)
        check("compiled with another trim3r.h" in found.pop("reason") and found == refused, f"{what}: {found}")
    for lacking, switches in (("stereo", {"STEREO"}), ("comparison", {"COMPARISON", "STEREO", "STREAMS"})):
        found = answers(INCLUDE, library, folder, without(lacking))
        named = set(re.findall(r"T3R_FEATURE_(\w+)=1", found.pop("reason")))
        check(found == refused and named == switches, f"without {lacking}: {found}, which names {named}")


def main():
    library = pathlib.Path(sys.argv[1])
    if not there("cc", "objcopy"):
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="trim3r-interface-") as folder:
        folder = pathlib.Path(folder)
        check_rows()
        enums = header(folder / "enums", ENUM)
        for machine, compilers in COMPILERS.items():
            compilers = [compiler for compiler in compilers if there(compiler[0])]
            check(len(layouts(INCLUDE, compilers, folder)) <= 1, f"{machine}: structs depend on how enumerations are laid out")
            check(not compilers or len(layouts(enums, compilers, folder)) == 2, f"{machine}: blind to an enumeration")
        program = folder / "program"
        run("cc", "-std=c11", SHORT[0], "-I", INCLUDE, "-I", HEADS, CONSUMERS / "main.c", CONSUMERS / "scene.c",
            HEADS / "small.c", library, "-o", program)
        said = run(program).stdout.split()
        check(said[:2] == [HASH, HASH], f"with short enumerations: {said}, not {HASH}")
        check_mismatches(library, folder)
    done()


if __name__ == "__main__":
    main()
