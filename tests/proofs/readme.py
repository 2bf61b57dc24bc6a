#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""readme.py example LIBRARY... | table PROGRAM [--update] | code LIBRARY: what the documents show is what happens.

example: the README's C program compiles without a warning, links with only the runtime and the heads, and prints
         what the README shows.
table:   the arena table of docs/firmware.md is the output of `trim3r plan --markdown`; --update writes it there.
code:    the shared library has the bytes of code that README states, within 5 %, the effect of another compiler.
"""
import re
import sys

import proof

README = proof.ROOT / "README.md"
FIRMWARE = proof.ROOT / "docs" / "firmware.md"
PLAN = ["plan", "--size", "256x256", "--views", "2", "--gaussians", "13107", "--markdown"]
STRICT = ["-std=c11", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror"]


def example_of(text):
    """Returns the first C block, and the text block after it, which is its output."""
    match = re.search(r"```c\n(.*?)```.*?```text\n(.*?)```", text, flags=re.S)
    if match is None:
        proof.broken("README.md has no C example followed by its output")
    return match.group(1), match.group(2)


def check_example(text, libraries, folder):
    code, expected = example_of(text)
    source, program = folder / "example.c", folder / "example"
    source.write_text(code)
    result = proof.run(["gcc", *STRICT, "-I", proof.RUNTIME / "include", "-I", proof.ROOT / "quant" / "heads", source,
                        *libraries, "-o", program])
    if result.returncode != 0:
        return ["does not build: " + result.stderr.strip()]
    result = proof.run([program], timeout=60)
    if result.returncode != 0:
        return [f"ends with status {result.returncode}: {result.stdout}{result.stderr}"]
    if result.stdout != expected:
        return [f"prints {result.stdout!r}, the README says {expected!r}"]
    return []


def table_in(text):
    return re.search(r"(<!-- arena:begin -->\n)(.*?)(<!-- arena:end -->)", text, flags=re.S) or proof.broken(
        "docs/firmware.md has no arena markers")


def check_table(text, printed):
    shown = table_in(text).group(2)
    if shown == printed:
        return []
    return ["the arena table of docs/firmware.md is not what the plan prints; tests/proofs/readme.py table PROGRAM --update",
            printed]


def check_code(text, size):
    shown = int(re.search(r"^\| x86-64.*?\| ([\d,]+) bytes", text, flags=re.M)[1].replace(",", ""))
    return [] if abs(shown / size - 1) < 0.05 else [f"libtrim3r.so has {size:,} bytes of code, the README says {shown:,}"]


def main():
    what, *paths = [word for word in sys.argv[1:] if word != "--update"]
    if what == "example":
        text = README.read_text()
        expected = example_of(text)[1]
        with proof.scratch() as folder:
            for wrong, offence in [(text.replace("#include", "#inclde", 1), "does not build"),
                                   (text.replace(expected, "1 " + expected), "the README says")]:
                proof.must_find(check_example(wrong, paths, folder), offence, "the README's example")
            proof.verdict("the README's example builds, runs and prints what the README says",
                          check_example(text, paths, folder))
        return
    if what == "code":
        size = int(proof.run(["size", paths[0]], check=True).stdout.splitlines()[1].split()[0])
        proof.must_find(check_code(README.read_text(), 2 * size), "the README says", "the README's code of the library")
        proof.verdict("the shared library has as much code as the README says", check_code(README.read_text(), size))
        return
    text, printed = FIRMWARE.read_text(), proof.run([paths[0], *PLAN], check=True).stdout
    if "--update" in sys.argv:
        found = table_in(text)
        FIRMWARE.write_text(text[:found.start(2)] + printed + text[found.end(2):])
        return
    proof.must_find(check_table(text.replace("<!-- arena:end -->", "| state | 1 |\n<!-- arena:end -->"), printed),
                    "is not what", "the arena table")
    proof.verdict("the arena table of docs/firmware.md is what the plan prints", check_table(text, printed))


if __name__ == "__main__":
    sys.exit(main())
