#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""words.py: the source of the runtime has no real numbers, no heap, no streams, no operating system.

The compiler may fold a real constant away, so symbols cannot show it; hence the source itself is searched. The words
must not appear in comments either, so that a plain grep is enough to verify it.
"""
import pathlib
import re
import sys

import proof

WORDS = re.compile(r"\b(float|double|malloc|calloc|realloc|alloca|free|\w*printf|fopen|FILE|errno|setjmp|longjmp|goto)\b")
REAL_LITERAL = re.compile(r"(?<![\w.])(\d+\.\d*|\.\d+|\d+[eE][+-]?\d+)[fFlL]?(?![\w.])")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"][^>"]+[>"])', re.M)
SYSTEM_HEADERS = {"<stddef.h>", "<stdint.h>", "<stdbool.h>"}
VECTOR_HEADERS = {"<immintrin.h>", "<emmintrin.h>", "<tmmintrin.h>", "<arm_neon.h>", "<arm_mve.h>", "<arm_acle.h>",
                  "<wasm_simd128.h>", "<cpuid.h>"}


def without_comments_and_strings(text):
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group(0))

    return re.sub(r'/\*.*?\*/|//[^\n]*|"(\\.|[^"\\\n])*"|\'(\\.|[^\'\\\n])*\'', blank, text, flags=re.S)


def check(path):
    text, findings = path.read_text(), []

    def found(what, at):
        findings.append(f"{path}:{text.count(chr(10), 0, at) + 1}: {what}")

    for match in WORDS.finditer(text):
        found(f"the word {match.group(0)}", match.start())
    for match in REAL_LITERAL.finditer(without_comments_and_strings(text)):
        found(f"the real number {match.group(0)}", match.start())
    for match in INCLUDE.finditer(text):
        name = match.group(1)
        if name.startswith("<") and name not in SYSTEM_HEADERS | (VECTOR_HEADERS if "kernels" in path.parts else set()):
            found(f"includes {name}", match.start())
    return findings


def main():
    with proof.scratch() as folder:
        planted = folder / "planted.c"
        planted.write_text('#include <stdio.h>\nint half = (int)(0.5 * 3); /* a double */\n')
        proof.must_find(check(planted), "includes <stdio.h>", "a line of text")
        proof.must_find(check(planted), "the real number 0.5", "a line of text")
        proof.must_find(check(planted), "the word double", "a comment")
        planted.write_text('const char *version = "0.1.0"; /* 0.5 px */\n')
        if check(planted):
            proof.broken("sees real numbers in strings and comments", check(planted))
    sources = sorted(path for path in pathlib.Path(proof.RUNTIME).rglob("*") if path.suffix in (".c", ".h"))
    proof.verdict(f"{len(sources)} files of the runtime: integers, no heap, no operating system",
                  [finding for path in sources for finding in check(path)])


if __name__ == "__main__":
    sys.exit(main())
