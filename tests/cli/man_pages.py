#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""man_pages.py TRIM3R: each command's page for man(1) has every option of its help, and mandoc or man accepts it
without a warning."""
import re
import shutil
import subprocess
import sys

from program import check, expect, in_scratch

SECTIONS = {".SH NAME", ".SH SYNOPSIS", ".SH DESCRIPTION", '.SH "EXIT STATUS"'}
LINT = ["mandoc", "-Tlint", "-Wwarning"] if shutil.which("mandoc") else ["man", "--warnings=w", "-E", "UTF-8", "-l", "-Z"]


def pages():
    commands = [line.split("\t") for line in expect(0, "--commands").splitlines()]
    yield "trim3r", expect(0, "--man-page"), [f"trim3r-{name}" for name, _ in commands], ""
    for name, summary in commands:
        options = [line.split("\t")[0] for line in expect(0, name, "--complete").splitlines()]
        yield f"trim3r-{name}", expect(0, name, "--man-page"), [*options, summary], expect(0, name, "--help")


def words_of(text):
    """Returns the words of a command's help, without what argp adds."""
    own = re.sub(r"(?m)^( *Usage:| +or: | +-\?, --help| +--usage).*", "", text)
    own = re.sub(r"(?s)Mandatory or optional.*?short options\.", "", own)
    return re.findall(r"[A-Za-z]{3,}", own)


def every_page():
    for name, page, wanted, text in pages():
        plain = page.replace("\\-", "-").replace("\\fB", "").replace("\\fR", "").replace("\\fI", "")
        for words in wanted:
            check(words in plain, f"{name} lacks {words}")
        check(SECTIONS <= set(page.splitlines()), f"{name}: sections")
        lost = [word for word in words_of(text.split("Examples:")[0]) if word not in plain]
        check(lost == [], f"{name} lacks words: {lost[:9]}")
        with open(f"{name}.1", "w", encoding="utf-8") as file:
            file.write(page)
    planted = subprocess.run([*LINT, "/dev/stdin"], input=".TH\n.XX\n", capture_output=True, text=True)
    check(planted.stdout + planted.stderr != "", "blind to a planted page")
    for name, *_ in pages():
        said = subprocess.run([*LINT, f"{name}.1"], capture_output=True, text=True)
        found = said.stdout if LINT[0] == "mandoc" else said.stderr
        check(found == "", f"{name}.1: {found}")


if not shutil.which(LINT[0]):
    print("SKIPPED: neither mandoc nor man is there")
    sys.exit(77)
sys.exit(in_scratch(every_page))
