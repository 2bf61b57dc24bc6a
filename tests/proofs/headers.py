#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""headers.py: each public header compiles alone, first and twice, as C11 and as C++17, without a warning. The size of an
arena is a constant there, and a text that compilers read quickly."""
import shutil
import sys

import proof

STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror", "-fsyntax-only"]
LANGUAGES = [("gcc", "c", "-std=c11"), ("g++", "c++", "-std=c++17"),
             ("clang", "c", "-std=c11"), ("clang++", "c++", "-std=c++17")]


def check(header, folder):
    findings = []
    user = folder / "user"
    user.write_text(f'#include "{header.name}"\n#include "{header.name}"\n'
                    "typedef int user; /* a file may not be empty, and some headers have macros alone */\n")
    for compiler, language, standard in LANGUAGES:
        if shutil.which(compiler) is None:
            print(f"without {compiler}: not here")
            continue
        result = proof.run([compiler, "-x", language, standard, *STRICT, "-I", header.parent, "-I", proof.RUNTIME / "include", user])
        if result.returncode != 0:
            findings.append(f"{header.name} as {standard} by {compiler}: {result.stderr.strip()}")
    return findings


ARENA_TEXT_MOST = 350_000  # characters of T3R_ARENA_BYTES() after the preprocessor


def check_arena(folder, most):
    user = folder / "arena"
    user.write_text('#include "trim3r_arena.h"\n'
                    "extern unsigned char arena[T3R_ARENA_BYTES(256, 256, 2, 13107)];\n")
    findings = []
    for compiler, language, standard in LANGUAGES:
        if shutil.which(compiler) is not None:
            command = [compiler, "-x", language, standard, "-I", proof.RUNTIME / "include", user]
            result, text = proof.run([*command, "-fsyntax-only"]), proof.run([*command, "-E", "-P"]).stdout
            if result.returncode != 0 or len(text) > most:
                findings.append(f"an arena as {standard} by {compiler}: {len(text)} characters, {result.stderr.strip()}")
    return findings


def main():
    with proof.scratch() as folder:
        proof.must_find(check(proof.PLANTED / "header.h", folder), "size_t", "header.h")
        proof.must_find(check_arena(folder, 1000), "characters", "a limit of 1,000")
        proof.verdict("the bytes of an arena are a constant of a short text", check_arena(folder, ARENA_TEXT_MOST))
        headers = proof.public_headers()
        proof.verdict(f"{', '.join(h.name for h in headers)}: compile alone in C11 and C++17",
                      [finding for header in headers for finding in check(header, folder)])


if __name__ == "__main__":
    sys.exit(main())
