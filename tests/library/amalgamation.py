#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""amalgamation.py [--all]: tools/amalgamate writes the same two files every time, each compiler accepts them in one
call, and programs with them have the library's bits.

gcc and clang find no shadowed name in them and no conversion that changes a number. gcc links a consumer with them. With --all, gcc and clang link the golden driver: every stage's hash. clang for
WebAssembly links a consumer that Node.js runs, and arm-none-eabi-gcc links one for a Cortex-M7. A missing compiler is
named.
"""
import functools
import pathlib
import re
import sys
import tempfile

from library import CONSUMERS, HASH, HEADS, ROOT, WARNINGS, amalgamate, at_once, ended, there

from checks import check, done, run

GOLDEN = ROOT / "tests" / "golden"
STAGES = (GOLDEN / "stages.txt").read_text()
STRICT = ["-std=c11", *WARNINGS, "-Wpedantic", "-Wconversion", "-fsyntax-only"]
FREESTANDING = ["-ffreestanding", "-nostdlib"]
CORTEX_M7 = ["-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=soft"]
NODE = """
const fs = require("fs");
WebAssembly.instantiate(fs.readFileSync(process.argv[1])).then(({ instance }) =>
    console.log(BigInt.asUintN(64, instance.exports.build_scene(0)).toString(16).padStart(16, "0")));
"""


def check_same_files(folder):
    """Compares two runs with different orders of Python's sets."""
    said = [amalgamate(folder / name, seed) for name, seed in (("made", "1"), ("again", "2"))]
    check(said[0] == said[1] and len(re.findall(r"CRC-32 [0-9a-f]{8}$", said[0], flags=re.M)) == 2,
          f"two runs differ: {said}")
    for name in ("trim3r.c", "trim3r.h"):
        check((folder / "made" / name).read_bytes() == (folder / "again" / name).read_bytes(), f"{name} differs")
    print(said[0], end="")
    return folder / "made"


def compile_one(made, compiler, *flags):
    """Compiles in one call, without a warning; returns the object."""
    words, target = compiler.split(), made / (re.sub(r"\W+", "_", compiler) + ".o")
    run(*words, "-std=c11", *WARNINGS, *flags, "-c", made / "trim3r.c", "-o", target)
    return target


def check_strict(made, compiler):
    if not there(compiler):
        return
    run(compiler, *STRICT, made / "trim3r.c")
    shadowed = made / f"shadowed_{compiler}.c"
    shadowed.write_text('#include "trim3r.c"\nint planted;\nint twice(int planted);\nint twice(int planted) { return planted; }\n')
    check("planted" in ended(compiler, *STRICT, shadowed).stderr, f"blind: {compiler} does not see a shadowed name")


def check_consumer(made):
    if not there("gcc"):
        return
    program = made / "consumer"
    run("gcc", "-std=c11", "-O0", *WARNINGS, "-I", made, "-I", HEADS, made / "trim3r.c", HEADS / "small.c",
        CONSUMERS / "main.c", CONSUMERS / "scene.c", "-o", program)
    check(run(program).stdout.split()[:2] == [HASH, HASH], "gcc: other bits than the library")


def check_golden(made, compiler):
    if not there(compiler):
        return
    made_object, driver = compile_one(made, compiler, "-O1"), made / f"golden_{compiler}"
    includes = [word for folder in (made, ROOT / "runtime", ROOT / "platform", ROOT / "tools", ROOT / "tests", HEADS)
                for word in ("-I", folder)]
    run(compiler, "-std=gnu11", "-O1", *includes, GOLDEN / "golden_driver.c", ROOT / "tests" / "weights_maker.c",
        ROOT / "platform" / "host" / "cpu.c", HEADS / "small.c", *sorted((ROOT / "tools" / "room").glob("*.c")), made_object,
        "-o", driver)
    printed = run(driver).stdout
    check(printed == STAGES, f"{compiler}: other bits than the library")
    check(printed.replace("a", "b", 1) != STAGES, "blind: another digit is not noticed")


def consumer_of(made, compiler, *flags):
    """Compiles and links the consumer without a C library and the two files in one call."""
    words, program = compiler.split(), made / (re.sub(r"\W+", "_", compiler) + ".elf")
    memory = made / f"{program.stem}_memory.c"
    memory.write_text('#include "memory.h"\n')
    run(*words, "-std=c11", *WARNINGS, *FREESTANDING, *flags, "-I", made, "-I", HEADS,
        "-I", ROOT / "tests" / "proofs" / "freestanding", made / "trim3r.c", CONSUMERS / "scene.c", memory,
        HEADS / "small.c", *(["-lgcc"] if "gcc" in compiler else []), "-o", program)
    return program


def check_arm(made):
    if not there("arm-none-eabi-gcc"):
        return
    program = consumer_of(made, "arm-none-eabi-gcc", "-Os", *CORTEX_M7, "-Wl,--gc-sections", "-ffunction-sections",
                          "-fdata-sections", "-Wl,-e,build_scene")
    text, data, bss = run("arm-none-eabi-size", program).stdout.splitlines()[1].split()[:3]
    print(f"a consumer on a Cortex-M7: {text} bytes of code and constants, {data} of data, {bss} of bss")


def check_wasm(made):
    if not there("clang", "wasm-ld"):
        return
    program = consumer_of(made, "clang --target=wasm32", "-O1", "-Wl,--no-entry", "-Wl,--export=build_scene")
    if there("node"):
        said = run("node", "-e", NODE, program).stdout.strip()
        check(said == HASH, f"WebAssembly: {said}, not {HASH}")
    print(f"a consumer in WebAssembly: {program.stat().st_size} bytes")


def main():
    with tempfile.TemporaryDirectory(prefix="trim3r-amalgamation-") as folder:
        made = check_same_files(pathlib.Path(folder))
        broken = made.parent / "broken"
        broken.mkdir()
        (broken / "trim3r.h").write_bytes((made / "trim3r.h").read_bytes())
        (broken / "trim3r.c").write_text((made / "trim3r.c").read_text() + "static int twice;\nstatic char twice;\n")
        check(ended("cc", "-fsyntax-only", broken / "trim3r.c").returncode != 0, "blind: a name twice is not noticed")
        jobs = [functools.partial(check_strict, made, "gcc"), functools.partial(check_strict, made, "clang"),
                functools.partial(check_consumer, made)]
        if "--all" in sys.argv:
            jobs += [functools.partial(check_golden, made, "gcc"), functools.partial(check_golden, made, "clang"),
                     functools.partial(check_arm, made), functools.partial(check_wasm, made)]
        at_once(lambda job: job(), jobs)
    done()


if __name__ == "__main__":
    sys.exit(main())
