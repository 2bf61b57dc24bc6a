#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""settings.py [--update]: the list of settings in docs/library.md agrees with trim3r_settings.h, and each option has
its setting's name. --update writes the list."""
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from checks import check, done, run  # noqa: E402

PAGE = ROOT / "docs" / "library.md"
TABLE = re.compile(r"(<!-- settings:begin -->\n)(.*?)(<!-- settings:end -->)", re.S)
GIVEN = 2**32 - 1
PROGRAM = f"""
#include <stdio.h>
#include "trim3r.h"
#define NAME(NAME, name) #name ", "
#define NAMES_number ""
#define NAMES_q8 ""
#define NAMES_toggle ""
#define NAMES_head ""
#define NAMES_wavelet T3R_WAVELETS(NAME)
#define NAMES_allocation T3R_ALLOCATIONS(NAME)
#define NAMES_depth T3R_DEPTHS(NAME)
#define ROW(name, kind, low, high, usual, feature, from, group, option, help) \\
    printf("%s\\t%s\\t%s\\t%u\\t%u\\t%u\\t%s\\t%s\\n", #name, #kind, NAMES_##kind, (unsigned)(low), (unsigned)(high), \\
           (unsigned)(usual), text(option), help);
static const char *text(const char *option)
{{
    return option != NULL ? option : "";
}}
int main(void)
{{
    unsigned width = {GIVEN}u, height = width, views = width, gaussians = width;
    T3R_SETTINGS(ROW)
    return 0;
}}
"""


def rows():
    with tempfile.TemporaryDirectory(prefix="trim3r-settings-") as folder:
        source = pathlib.Path(folder) / "settings.c"
        source.write_text(PROGRAM)
        run("cc", "-std=c11", "-I", ROOT / "runtime" / "include", source, "-o", source.with_suffix(""))
        return [line.split("\t") for line in run(source.with_suffix("")).stdout.splitlines()]


def number(kind, value):
    """Returns a value as the option takes it."""
    if value == GIVEN:
        return "given"
    return f"{value / 256:.2g}" if kind == "q8" else ("off", "on")[value] if kind == "toggle" else str(value)


def values_of(kind, names, low, high):
    if kind == "head":
        return "a `t3r_head`"
    if kind == "toggle":
        return "off, on"
    return names.removesuffix(", ") or ("any number" if high == GIVEN else f"{number(kind, low)} to {number(kind, high)}")


def line_of(name, kind, names, low, high, usual, option, what):
    low, high, usual = int(low), int(high), int(usual)
    first = names.split(", ")[usual - low] if names else "analytic" if kind == "head" else number(kind, usual)
    return f"| `{name}` | {f'`--{option}`' if option else ''} | {values_of(kind, names, low, high)} | {first} | {what} |\n"


def main():
    found = rows()
    check(len(found) > 30, f"blind: {len(found)} settings")
    for name, *_, option, _ in found:
        check(option in ("", name.removesuffix("_q8").replace("_", "-")), f"{name} has the option --{option}")
    table = "| setting | option | values | default | what it is |\n|---|---|---|---|---|\n"
    table += "".join(line_of(*row) for row in found)
    page = PAGE.read_text()
    if "--update" in sys.argv:
        PAGE.write_text(TABLE.sub(lambda match: match[1] + table + match[3], page))
    else:
        shown = TABLE.search(page)
        check(shown is not None and shown[2] == table, f"docs/library.md is not of these settings; tests/docs/settings.py --update writes\n{table}")
    done()


if __name__ == "__main__":
    main()
