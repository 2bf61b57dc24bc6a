# SPDX-License-Identifier: Apache-2.0
"""Instructions of each stage of builds of the built-in room, in plain C at -O2 on one thread, as callgrind counts them: what
no other program on the machine disturbs."""
import os
import re
import shutil
import sys

import proof

DRIVER = proof.HERE / "instructions_driver.c"
HEAD_SOURCES = [proof.ROOT / "quant" / "heads" / f"{name}.c" for name in ("tiny", "small")]
TARGET = proof.TARGETS["x86_64-O2"]


def compiler_name():
    """Returns the compiler's name; skips the proof where the compiler is missing."""
    name = proof.compiler_of(TARGET)
    machine = proof.run([name, "-dumpmachine"], check=True).stdout.strip()
    version = proof.run([name, "-dumpfullversion", "-dumpversion"], check=True).stdout.split()
    return f"{os.path.basename(name)} {version[0]} {machine}"


def skip(reason):
    print(f"SKIPPED: {reason}")
    sys.exit(77)


def build(folder):
    """The driver with the runtime that the proofs of the stack look at, the heads, the room and the counts of work."""
    name = proof.compiler_of(TARGET)
    tools = proof.ROOT / "tools"
    own = [DRIVER, *HEAD_SOURCES, *sorted((tools / "room").glob("*.c")), tools / "planning" / "work.c",
           tools / "planning" / "operations.c"]
    folders = ("runtime", "runtime/include", "platform", "tools", "quant/heads", "tests")
    includes = [word for place in folders for word in ("-I", proof.ROOT / place)]
    program = folder / "instructions_driver"
    proof.objects.output_of(name, "-std=c11", "-D_GNU_SOURCE", "-O2", *includes, *own, *proof.runtime_objects(TARGET), "-o",
                            program)
    return program


def count(program, folder, builds):
    """{"build stage": instructions}, all parts of a stage together, and the driver's output."""
    out = folder / "callgrind.out"
    done = proof.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", program, *builds])
    if done.returncode != 0:
        proof.broken("the builds fail under callgrind", done.stderr.splitlines())
    found = {}
    for part in sorted(folder.glob("callgrind.out.*"), key=lambda path: int(path.suffix[1:])):
        text = part.read_text()
        stage = re.search(r"^desc: Trigger: Client Request: (.+)$", text, flags=re.M)
        total = re.search(r"^(?:totals|summary): (\d+)", text, flags=re.M)
        if stage and total:
            found[stage[1]] = found.get(stage[1], 0) + int(total[1])
    if len(found) < 10:
        proof.broken("hardly any stage was counted", [str(found)])
    return found, done.stdout


def need_valgrind():
    if shutil.which("valgrind") is None or not os.path.exists("/usr/include/valgrind/callgrind.h"):
        skip("no valgrind here (tools/setup --tests)")
