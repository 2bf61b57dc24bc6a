#!/usr/bin/env python3
"""instructions.py [--update]: no stage takes more instructions than instructions.txt allows. callgrind counts those of two
small builds in plain C at -O2, which no other program on the machine disturbs. --update writes the table anew.

The compiler's version is part of the table: another one makes other instructions, and skips the proof.
"""
import concurrent.futures
import os
import re
import shutil
import sys

import proof

TABLE = proof.HERE / "instructions.txt"
DRIVER = proof.HERE / "instructions_driver.c"
HEAD_SOURCE = proof.ROOT / "quant" / "heads" / "small.c"
TARGET = proof.TARGETS["x86_64-O2"]
MOST_ABOVE = 0.03  # of what the table has
MUCH_BELOW = 0.03
HEADING = """# Instructions of each stage of two small builds, in plain C at -O2 (instructions_driver.c), counted by callgrind.
# tests/proofs/instructions.py --update writes them. The compiler's version is part of the table.
compiler {}
"""


def compiler_name():
    """What makes the instructions; skips the proof where it cannot be had."""
    name = proof.compiler_of(TARGET)
    machine = proof.run([name, "-dumpmachine"], check=True).stdout.strip()
    version = proof.run([name, "-dumpfullversion", "-dumpversion"], check=True).stdout.split()
    return f"{os.path.basename(name)} {version[0]} {machine}"


def skip(reason):
    print(f"SKIPPED: {reason}")
    sys.exit(77)


def build(folder):
    """The driver with the runtime, the head and the room, each compiled as the proofs of the stack are."""
    name = proof.compiler_of(TARGET)
    hosted = sorted((proof.ROOT / "tools" / "room").glob("*.c")) + [DRIVER]
    folders = ("runtime", "runtime/include", "platform", "tools", "quant/heads", "tests")
    includes = [word for place in folders for word in ("-I", proof.ROOT / place)]

    def compiled(numbered):
        index, source = numbered
        made = folder / f"{index:03d}.o"
        if source in hosted:
            done = proof.run([name, "-std=c11", "-D_GNU_SOURCE", "-O2", *includes, "-c", source, "-o", made])
        else:
            done = proof.compile_one(name, TARGET, source, made, ["-I", proof.ROOT / "quant" / "heads"])
        if done.returncode != 0:
            proof.broken(f"{source} does not compile", done.stderr.splitlines())
        return made
    sources = [*proof.runtime_sources(), HEAD_SOURCE, *hosted]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(compiled, enumerate(sources)))
    program = folder / "instructions_driver"
    proof.run([name, *objects, "-o", program], check=True)
    return program


def count(program, folder):
    """{"build stage": instructions}, all parts of a stage together."""
    out = folder / "callgrind.out"
    done = proof.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", program])
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
    return found


def table_of(text):
    """(the compiler, {"build stage": instructions})"""
    compiler, rows = "", {}
    for line in text.splitlines():
        words = line.split()
        if line.startswith("compiler "):
            compiler = " ".join(words[1:])
        elif words and not line.startswith("#"):
            rows[" ".join(words[:-1])] = int(words[-1])
    return compiler, rows


def check(allowed, found):
    findings = [f"{stage}: not in the table; instructions.py --update" for stage in found.keys() - allowed.keys()]
    findings += [f"{stage}: in the table alone; instructions.py --update" for stage in allowed.keys() - found.keys()]
    for stage in found.keys() & allowed.keys():
        share = found[stage] / allowed[stage] - 1
        if share > MOST_ABOVE:
            findings.append(f"{stage}: {found[stage]} instructions, {100 * share:.1f} % more than {allowed[stage]}")
    return sorted(findings)


def write(compiler, found):
    width = max(map(len, found))
    rows = "".join(f"{stage:<{width}} {number:>12}\n" for stage, number in found.items())
    TABLE.write_text(HEADING.format(compiler) + rows)


def main():
    compiler, update = compiler_name(), sys.argv[1:] == ["--update"]
    known, allowed = table_of(TABLE.read_text()) if TABLE.exists() else ("", {})
    if shutil.which("valgrind") is None or not os.path.exists("/usr/include/valgrind/callgrind.h"):
        skip("no valgrind here (tools/setup --tests)")
    if compiler != known and not update:
        skip(f"the table is of {known}, this is {compiler}")
    with proof.scratch() as folder:
        found = count(build(folder), folder)
    if update:
        write(compiler, found)
        return
    most = max(allowed, key=allowed.get)
    proof.must_find(check({**allowed, most: int(found[most] / 1.04)}, found), f"{most}: ", "the table of instructions")
    for stage in sorted(found.keys() & allowed.keys()):
        if found[stage] < allowed[stage] * (1 - MUCH_BELOW):
            print(f"{stage}: {found[stage]} instructions, {100 - 100 * found[stage] / allowed[stage]:.0f} % fewer than the "
                  "table's: instructions.py --update")
    proof.verdict("no stage takes 3 % more instructions than the table has", check(allowed, found))


if __name__ == "__main__":
    sys.exit(main())
