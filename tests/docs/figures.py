# SPDX-License-Identifier: Apache-2.0
"""Figures in a hand-copied table are next to each other in a row of its source: PSNR alone, or PSNR / SSIM."""
import re

NUMBER = r"(\d+\.\d{2,3})"
PAIR, SINGLE = re.compile(r"\| *" + NUMBER + " / " + NUMBER), re.compile(r"\| *" + NUMBER + r"(?= *\|)")


def figures(name, text, source):
    rows = [cells(line, PAIR) for line in source.splitlines() if line.startswith("|")]
    for line in text.splitlines():
        wanted = cells(line, PAIR) or cells(line, SINGLE)
        if line.startswith("|") and len(wanted) > 2 and not any(stands_in(wanted, row) for row in rows):
            yield f"{name}: not a row of docs/study/paper.md: {line}"


def cells(line, kind):
    return [match.groups() for match in kind.finditer(line)]


def stands_in(wanted, row):
    row = [cell[:len(wanted[0])] for cell in row]
    return any(row[at:at + len(wanted)] == wanted for at in range(len(row) - len(wanted) + 1))
