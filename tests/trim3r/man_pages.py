#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""man_pages.py TRIM3R: the page of each command for man(1) has every line of its help, and mandoc or man takes it
without a warning."""
import pathlib
import re
import shutil
import subprocess
import sys

from program import TRIM3R, check, expect, in_scratch

SECTIONS = {".SH NAME", ".SH SYNOPSIS", ".SH DESCRIPTION", '.SH "EXIT STATUS"'}
MAKER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "packaging" / "man_pages.cmake"
LINT = ["mandoc", "-Tlint", "-Wwarning"] if shutil.which("mandoc") else ["man", "--warnings=w", "-E", "UTF-8", "-l", "-Z"]


def pages():
    """Yields each page's name, its text without roff, and the lines of help."""
    subprocess.run(["cmake", f"-DPROGRAM={TRIM3R}", "-DFOLDER=.", "-P", MAKER], check=True)
    for command in ["", *(line.split("\t")[0] for line in expect(0, "--commands").splitlines())]:
        name = f"trim3r-{command}".rstrip("-")
        with open(f"{name}.1", encoding="utf-8") as file:
            page = re.sub(r"\\fB|\\fR|\\&", "", file.read()).replace("\\-", "-").replace("\\e", "\\")
        yield name, page, expect(0, *command.split(), "--help").splitlines()


def every_page():
    made = list(pages())
    for name, page, help_lines in made:
        check(SECTIONS <= set(page.splitlines()), f"{name}: sections")
        lost = [line for line in help_lines if re.sub("^(Usage|or): +", "", line.strip()).rstrip(":") not in page]
        check(lost in ([], ["Examples:"]), f"{name} lacks {lost}") # in capitals there
    planted = subprocess.run([*LINT, "/dev/stdin"], input=".TH\n.XX\n", capture_output=True, text=True)
    check(planted.stdout + planted.stderr != "", "blind to a planted page")
    for name, *_ in made:
        said = subprocess.run([*LINT, f"{name}.1"], capture_output=True, text=True)
        found = said.stdout if LINT[0] == "mandoc" else said.stderr
        check(found == "", f"{name}.1: {found}")


if not shutil.which(LINT[0]):
    print("SKIPPED: neither mandoc nor man is there")
    sys.exit(77)
in_scratch(every_page)
