# SPDX-License-Identifier: Apache-2.0
"""The firmware as a program of Linux: for this processor, or for another that QEMU emulates."""
import pathlib
import re

import objects
from firmware import BAREMETAL, INCLUDE, READER, ROOT, RUNTIME, run, said_by, words

FLAGS = ("-std=c11", "-O2", "-static", "-Wall", "-Wextra", "-Werror")
CPU = {name: 1 << int(bit) for name, bit in
       re.findall(r"#define T3R_CPU_(\w+) \(1u << (\d+)\)", (RUNTIME / "include" / "trim3r.h").read_text())}
# Processor, compiler with its flags, emulator, and the instruction sets to run with after plain C.
TARGETS = (
    ("x86-64", ("gcc",), None, (("SSE4.1", ("SSE41",)), ("AVX2", ("SSE41", "AVX2")),
                                ("AVX-512", ("SSE41", "AVX2", "AVX512", "VNNI")))),
    ("x86-64", ("clang",), None, (("AVX-512", ("SSE41", "AVX2", "AVX512", "VNNI")),)),
    ("i686", ("i686-linux-gnu-gcc",), None, ()),
    ("aarch64", ("aarch64-linux-gnu-gcc",), "qemu-aarch64-static",
     (("NEON", ("NEON",)), ("NEON, dot products", ("NEON", "DOTPROD")))),
    ("armv7, hard float", ("arm-linux-gnueabihf-gcc", "-mcpu=cortex-a15"), "qemu-arm-static", ()),
    ("armv5, soft float", ("arm-linux-gnueabi-gcc",), "qemu-arm-static", ()),
    ("riscv64", ("riscv64-linux-gnu-gcc",), "qemu-riscv64-static", ()),
    ("ppc64, big-endian", ("powerpc64-linux-gnu-gcc",), "qemu-ppc64-static", ()),
    ("s390x, big-endian", ("s390x-linux-gnu-gcc",), "qemu-s390x-static", ()),
)


def absent(target):
    """Returns a missing tool, or None."""
    _, compiler, emulator, _ = target
    return objects.absent(compiler[0], emulator)


def sources():
    port = [path for path in BAREMETAL.glob("*.c") if path.stem != "frames_planes"]
    return [*sorted(port), *sorted((BAREMETAL / "linux").glob("*.c")),
            ROOT / "quant" / "heads" / "small.c", *(ROOT / "platform" / f"{name}.c" for name in READER)]


def program(target, options):
    _, compiler, _, _ = target
    made = options.out / f"firmware-{compiler[0]}"
    run(*compiler, *FLAGS, *INCLUDE, "-DHEAD=t3r_head_small", "-DHEAD_BYTES=t3r_head_small_bytes", *sources(),
        *objects.compiled([*compiler, "-O2"]), "-o", made)
    return made


def lacks(needed, options):
    """Returns an instruction set that this processor lacks, or None; an emulated processor has all."""
    has = run(options.program, "doctor").replace("sse4.1", "sse41").split("features", 1)[1].splitlines()[0].split()
    return next((name for name in needed if name.lower() not in has), None)


def hashes(made, target, needed, path, options):
    """Returns what the firmware prints with these instruction sets, {stage: hash}; `final` is the hash of the whole
    build."""
    processor, _, emulator, _ = target
    said = said_by(processor, *([emulator] if emulator else []), pathlib.Path(made), *words(path, options), "hashes=1",
                   f"cpu={sum(CPU[name] for name in needed)}")
    return {name[5:]: text for name, text in said.items() if name.startswith("hash ")}
