#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""flash.py [--each | --update]: the features' use of a Cortex-M7's flash, as in docs/library.md.

The two files of tools/amalgamate, compiled for size and linked with a firmware that calls every function of trim3r.h
except t3r_set_cpu() and the sentences of errors: complete, without any feature, and with the sentences; with --each also
without each feature. A row may differ by 2 %, the effect of another compiler version. --update writes the table.
"""
import pathlib
import re
import sys
import tempfile

from library import FEATURES, ROOT, amalgamate, at_once, there, without

import proof
from checks import check, done, run

PAGE = ROOT / "docs" / "library.md"
TABLE = re.compile(r"(<!-- flash:begin -->\n)(.*?)(<!-- flash:end -->)", re.S)
COMPILER = "arm-none-eabi-gcc"
FLAGS = ["-std=c11", "-Os", "-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=soft", "-ffreestanding", "-nostdlib",
         "-ffunction-sections", "-fdata-sections", "-Wl,--gc-sections", "-Wl,-e,firmware"]
TOLERANCE = 0.02


def is_sentence(name, names):
    """Whether a function puts the error of another one into words."""
    call = name.removesuffix("_error")
    return call != name and (call in names or call + "_as" in names)


def caller(with_sentences):
    """Returns a firmware that calls every function, with the sentences of errors or without."""
    public = proof.public_functions()
    names = [name for name in public if name != "t3r_set_cpu" and (with_sentences or not is_sentence(name, public))]
    rows = "".join(f"    (function *){name},\n" for name in names)
    return ('#include "memory.h"\n#include "trim3r.h"\n\ntypedef void function(void);\n'
            f"function *const firmware[] __attribute__((used)) = {{\n{rows}}};\n")


def bytes_of(folder, left_out, program="caller"):
    firmware = folder / f"{program}_{'_'.join(left_out or ['whole'])}"
    run(COMPILER, *FLAGS, *map(without, left_out), "-I", folder, "-I", ROOT / "tests" / "proofs" / "freestanding",
        folder / f"{program}.c", folder / "trim3r.c", "-lgcc", "-o", firmware)
    text, data = run("arm-none-eabi-size", firmware).stdout.splitlines()[1].split()[:2]
    return int(text) + int(data)


def table_of(sizes):
    """Returns the page's rows: without each measured feature, without all of them, and complete."""
    whole, plain, worded, *without_one = sizes
    rows = [f"| {name} | `T3R_WITH_{name.upper()}`, `T3R_FEATURE_{name.upper()}` | {whole - size:,} |\n"
            for name, size in zip(FEATURES, without_one)]
    return ("| left out | CMake's option, the compiler's macro | bytes saved |\n|---|---|---:|\n" + "".join(rows)
            + f"| all of them | | {whole - plain:,} |\n| nothing: the whole library takes | | {whole:,} |\n"
            + f"| nothing, and the [sentences of all errors](errors.md) add | | {worded - whole:,} |\n")


def figures(table):
    return [int(row.replace(",", "")) for row in re.findall(r"\| ([\d,]+) \|$", table, flags=re.M)]


def alike(shown, measured, whole):
    """Whether each figure equals the measured one within this share of it and a thousandth of the library."""
    return len(shown) == len(measured) and all(
        abs(a - b) <= TOLERANCE * b + whole / 1000 for a, b in zip(shown, measured))


def main():
    if not there(COMPILER):
        sys.exit(77)
    each = {"--each", "--update"} & set(sys.argv)
    with tempfile.TemporaryDirectory(prefix="trim3r-flash-") as folder:
        folder = pathlib.Path(folder)
        amalgamate(folder)
        (folder / "caller.c").write_text(caller(with_sentences=False))
        (folder / "worded.c").write_text(caller(with_sentences=True))
        choices = [([],), (list(FEATURES),), ([], "worded"), *(([name],) for name in FEATURES if each)]
        sizes = at_once(lambda choice: bytes_of(folder, *choice), choices)
    table, page = table_of(sizes), PAGE.read_text()
    measured = figures(table)
    check(all(size > 0 for size in measured), f"a feature saves nothing:\n{table}")
    more = 900 if each else 4500
    check(not alike([size + more for size in measured], measured, sizes[0]), f"blind: {more} bytes more are not noticed")
    if "--update" in sys.argv:
        PAGE.write_text(TABLE.sub(lambda match: match[1] + table + match[3], page))
    else:
        shown = TABLE.search(page)
        check(shown is not None and alike(figures(shown[2])[-len(measured):], measured, sizes[0]),
              f"docs/library.md is not what is measured; tests/library/flash.py --update writes\n{table}")
    print(table, end="")
    done()


if __name__ == "__main__":
    main()
