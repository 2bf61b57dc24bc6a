# SPDX-License-Identifier: Apache-2.0
"""Shared by the proofs: compiling the runtime for a target, and the verdict.

A proof first shows that it can fail: it must find each kind of offence planted in planted/. Then it checks the real
code. Exit 0: holds; 1: broken; 77: skipped, a tool is absent.
"""
import contextlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "study" / "boards"))

import objects  # noqa: E402

RUNTIME = ROOT / "runtime"
PLANTED = HERE / "planted"
FREESTANDING = ["-std=c11", "-ffreestanding", "-fno-tree-loop-distribute-patterns"]


class Target:
    """A compiler, its flags, and the core's row in docs/firmware.md: the integer helpers that it may call where the
    processor lacks an instruction. __aeabi_f... and __aeabi_d... would be soft float."""

    def __init__(self, name, prefix, flags, core="x86-64, and other 64-bit cores"):
        self.name, self.prefix, self.flags, self.core = name, prefix, flags, core

    @property
    def helpers(self):
        text = (ROOT / "docs" / "firmware.md").read_text()
        row = re.search(rf"^\| {re.escape(self.core)} \| (.*) \|$", text, flags=re.M)
        if row is None:
            broken(f"docs/firmware.md has no row '{self.core}'")
        return set(re.findall(r"`(\w+)`", row[1]))


TARGETS = {
    "x86_64": Target("x86_64", "", ["-O3"]),
    "x86_64-O2": Target("x86_64-O2", "", ["-O2"]),
    "x86_64-O0": Target("x86_64-O0", "", ["-O0"]),
    "x86_64-general-registers": Target("x86_64-general-registers", "", ["-O2", "-mgeneral-regs-only"]),
    "i686": Target("i686", "i686-linux-gnu-", ["-O2", "-fno-pic"], "i686"),
    "cortex-m3": Target("cortex-m3", "arm-none-eabi-", ["-O2", "-mcpu=cortex-m3", "-mthumb", "-mfloat-abi=soft"],
                        "Cortex-M3 and larger, Cortex-A15"),
    "cortex-m7": Target("cortex-m7", "arm-none-eabi-", ["-O2", "-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=soft"],
                        "Cortex-M3 and larger, Cortex-A15"),
    "cortex-m7-Os": Target("cortex-m7-Os", "arm-none-eabi-", ["-Os", "-mthumb", "-mcpu=cortex-m7", "-mfloat-abi=soft"],
                           "Cortex-M3 and larger, Cortex-A15"),
    "cortex-m55": Target("cortex-m55", "arm-none-eabi-", ["-O2", "-mcpu=cortex-m55+nofp", "-mthumb", "-mfloat-abi=hard"],
                         "Cortex-M3 and larger, Cortex-A15"),
    # without floating-point registers: any real number is an error, or calls a helper that is not listed
    "aarch64": Target("aarch64", "aarch64-linux-gnu-", ["-O2", "-mgeneral-regs-only"]),
    "armv7": Target("armv7", "arm-linux-gnueabihf-", ["-O2", "-fno-pic", "-mcpu=cortex-a15", "-marm", "-mfloat-abi=soft"],
                    "Cortex-M3 and larger, Cortex-A15"),
    "armv5": Target("armv5", "arm-linux-gnueabi-", ["-O2", "-fno-pic", "-mfloat-abi=soft"], "Armv5"),
    "riscv64": Target("riscv64", "riscv64-linux-gnu-", ["-O2", "-march=rv64imac", "-mabi=lp64"],
                      "RISC-V, 64 bits, without Zbb"),
    "ppc64": Target("ppc64", "powerpc64-linux-gnu-", ["-O2", "-msoft-float"]),
    "s390x": Target("s390x", "s390x-linux-gnu-", ["-O2", "-msoft-float"]),
    "cortex-m0": Target("cortex-m0", "arm-none-eabi-", ["-O2", "-mthumb", "-mcpu=cortex-m0", "-mfloat-abi=soft"],
                        "Cortex-M0"),
}


def compiler_of(target):
    """Returns the target's compiler; skips the proof when it is not installed."""
    compiler = target.prefix + "gcc" if target.prefix else os.environ.get("CC", "gcc")
    if shutil.which(compiler) is None:
        print(f"SKIPPED: no {compiler} here (tools/setup --tests)")
        sys.exit(77)
    return compiler


def run(command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)


def compile_each(target, sources, folder, extra=()):
    """Compiles each source to an object in the folder; ends the proof if one fails to compile."""
    compiler, objects = compiler_of(target), []
    for index, source in enumerate(sources):
        made = pathlib.Path(folder) / f"{index:02d}_{source.stem}.o"
        result = compile_one(compiler, target, source, made, extra)
        if result.returncode != 0:
            broken(f"{source} does not compile for {target.name}", result.stderr.splitlines())
        objects.append(made)
    return objects


def compile_one(compiler, target, source, made, extra=()):
    """Compiles one source with no headers but the compiler's own and ours: none of a C library."""
    own = run([compiler, "-print-file-name=include"], check=True).stdout.strip()
    includes = ["-nostdinc", "-isystem", own, "-I", RUNTIME / "include", "-I", RUNTIME]
    return run([compiler, *FREESTANDING, *target.flags, *extra, *includes, "-c", source, "-o", made])


def runtime_objects(target):
    """Returns the runtime's objects for the target, shared by all proofs and tests; NAME.ci beside each is its call
    graph."""
    return objects.compiled([compiler_of(target), *target.flags])


def runtime_sources():
    return objects.sources()


def public_headers():
    return [*sorted((RUNTIME / "include").glob("*.h")), ROOT / "quant" / "heads" / "trim3r_heads.h",
            *sorted((ROOT / "platform").glob("trim3r_*.h"))]


def public_functions():
    """Returns the names of the functions that trim3r.h declares, except inline ones, which the program compiles."""
    text = re.sub(r"/\*.*?\*/", "", (RUNTIME / "include" / "trim3r.h").read_text(), flags=re.S)
    text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
    text = re.sub(r"\{[^{}]*\}", "", text)
    return re.findall(r"^(?!static )[A-Za-z_][\w *]*?\b(t3r_\w+)\(", text, flags=re.M)


@contextlib.contextmanager
def scratch():
    with tempfile.TemporaryDirectory(prefix="trim3r-proof-") as folder:
        yield pathlib.Path(folder)


def must_find(findings, text, what):
    """Checks the proof itself: the offence planted in `what` is among the findings."""
    if not any(text in finding for finding in findings):
        broken(f"blind: '{text}' planted in {what} was not found", findings or ["(no findings)"])
    found = next(line for finding in findings for line in finding.splitlines() if text in line)
    print(f"finds what is planted in {what}: {found}")


def broken(headline, lines=()):
    print(f"BROKEN: {headline}")
    for line in lines:
        print("  " + line)
    sys.exit(1)


def verdict(claim, findings):
    if findings:
        broken(claim, findings)
    print(f"holds: {claim}")
