#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""readme.py example LIBRARY... | table PROGRAM [--update] | code LIBRARY | study [--update]: what the documents show is what
happens.

example: the README's C program compiles without a warning, links with only the runtime and the heads, and prints
         what the README shows.
table:   the arena table of docs/firmware.md is the output of `trim3r plan --markdown`; --update writes it there.
code:    the shared library has the bytes of code that README states, within 5 %, the effect of another compiler.
study:   README's microcontrollers have the figures of docs/study/boards.md, and the views of README and docs/rivals.md those
         of docs/study/paper.md, with their times; --update writes them there.
"""
import re
import sys

import proof

README = proof.ROOT / "README.md"
FIRMWARE = proof.ROOT / "docs" / "firmware.md"
RIVALS = proof.ROOT / "docs" / "rivals.md"
BOARDS = proof.ROOT / "docs" / "study" / "boards.md"
PAPER = proof.ROOT / "docs" / "study" / "paper.md"
COLUMNS = {"Cortex-M7 with DSP": ("AN500), DSP", 480), "Cortex-M55 with Helium": ("Helium", 400)}  # its title's end, MHz
METHODS = {  # rows of README and docs/rivals.md, and their methods in docs/study/paper.md
    "trim3r, `--preset fast`": "trim3r, fast", "trim3r, `--preset balanced` (default)": "trim3r, balanced",
    "trim3r, `--preset best`": "trim3r, best", "the default with `--rim off`": "trim3r, balanced, no rim",
    "`--preset best` with `--rim off`": "trim3r, best, no rim", "random points, 50 iterations of fine-tuning": "random+finetune, 50",
    "random points, 200 iterations": "random+finetune, 200", "random points, 1,000 iterations": "random+finetune, 1000"}
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


def measured(text, title):
    """Returns the figures of a board's column in the first table of docs/study/boards.md."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")]
            for line in re.search(r"<!-- small:begin -->\n(.*?)\n\n", text, flags=re.S)[1].splitlines()]
    column = next(i for i, cell in enumerate(rows[0]) if cell.endswith(title))
    return {row[0]: row[column] for row in rows}


def with_boards(readme, boards):
    """Returns README with the figures that docs/study/boards.md has."""
    for name, (title, megahertz) in COLUMNS.items():
        found = measured(boards, title)
        millions = found["all stages, M"]
        ms = round(int(millions) * 1000 / megahertz)
        cells = [f"{found[row]} bytes" for row in ("flash, bytes", "arena, bytes", "stack, bytes")]
        cells.append(f"{millions} M instructions: {ms} ms at {megahertz} MHz")
        readme = re.sub(rf"^(\| {name} \|[^|]*\|).*$", lambda match: f"{match[1]} {' | '.join(cells)} |", readme, flags=re.M)
    return readme


def means_of(paper, table):
    """Returns the means of the scenes in a table of docs/study/paper.md by method: PSNR of the whole picture / of what a
    context view saw, by percent kept."""
    text = re.search(rf"<!-- {table}:begin -->\n(.*?)<!-- {table}:end -->", paper, flags=re.S)[1]
    rows = [[cell.strip() for cell in row.strip("|").split("|")]
            for row in re.search(r"^\| mean of the scenes \|.*\n(?:\|  \|.*\n)*", text, flags=re.M)[0].splitlines()]
    return {row[1]: [" / ".join(cell.split(" / ")[:2]) for cell in row[2:]] for row in rows}


def seconds_of(paper):
    """Returns the seconds of a build by method, as docs/study/paper.md has them."""
    text = re.search(r"^\| method \| seconds \|.*\n((?:\|.*\n)*)", paper, flags=re.M)[1]
    rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in text.splitlines()[1:]]
    return {row[0]: f"{row[1]} s" for row in rows}


def with_means(text, means):
    """Returns a text whose rows of these methods have these cells."""
    for name, method in {**{method: method for method in means}, **METHODS}.items():
        cells = means.get(method, [])
        row = rf"^\| {re.escape(name)} \|(?: [^|]* \|){{{len(cells)}}}$"
        if cells:
            text = re.sub(row, f"| {name} | {' | '.join(cells)} |", text, flags=re.M)
    return text


def with_study(texts):
    """Returns README and docs/rivals.md with the figures of the study's pages."""
    boards, paper = BOARDS.read_text(), PAPER.read_text()
    drawn, seconds = means_of(paper, "quality"), seconds_of(paper)
    tuned = {method: [*cells, seconds[method]] for method, cells in means_of(paper, "tuned").items()}
    return [with_means(with_boards(texts[0], boards), tuned), with_means(with_means(texts[1], drawn), tuned)]


def check_study(texts):
    return [f"{name} has figures of an older study; tests/proofs/readme.py study --update"
            for name, text, right in zip(("README.md", "docs/rivals.md"), texts, with_study(texts)) if text != right]


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
    if what == "study":
        texts = [README.read_text(), RIVALS.read_text()]
        if "--update" in sys.argv:
            for path, text in zip((README, RIVALS), with_study(texts)):
                path.write_text(text)
            return
        for old, new in ((" M instructions", "0 M instructions"), ("fast` | ", "fast` | 1"), ("+finetune, 200 | ", "+finetune, 200 | 1")):
            for text in [text for text in texts if old in text]:
                proof.must_find(check_study([text.replace(old, new) if text is t else t for t in texts]), "of an older study",
                                "a document")
        proof.verdict("README and docs/rivals.md have the study's figures", check_study(texts))
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
