#!/usr/bin/env python3
"""check_pages.py TRIM3R: what the README, docs/*.md and the pages of quant and of the training say in words.

Every command stands in a shell block that runs, or that says why it does not. Options, names of the interface and links
exist. A sentence has at most 35 words, the README at most 200 lines.
"""
import functools
import pathlib
import re
import subprocess
import sys

from pages import FENCE, LINK, ROOT, all_pages, blocks_of, sentences_of, without_blocks

WORDS, README_LINES = 35, 200
OTHERS = ["runtime/DESIGN.md", "runtime/SPEC.md", "quant/heads/MODEL_CARD.md"]  # and docs/study: links and sentences alone
COMMAND = re.compile(r"^\s*(?:\$ )?(?:trim3r [a-z]|tools/[a-z]|build/release/[a-z])")
COPIED = [ROOT / "README.md", ROOT / "docs" / "rivals.md"]  # tables with figures of docs/study/paper.md, by hand
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*")
NAME = re.compile(r"\b(?:t3r|T3R)_\w+")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    find_what_is_planted(program)
    findings = []
    for page in all_pages():
        findings += check(page, page.read_text(), program)
    for page in [*(ROOT / name for name in OTHERS), *sorted((ROOT / "docs" / "study").glob("*.md"))]:
        text = page.read_text()
        findings += [*links(page, text), *sentences(page.relative_to(ROOT), text)]
    for page in COPIED:
        findings += figures(page.name, page.read_text(), (ROOT / "docs" / "study" / "paper.md").read_text())
    lines = (ROOT / "README.md").read_text().count("\n")
    if lines > README_LINES:
        findings.append(f"README.md has {lines} lines, at most {README_LINES} were wanted")
    for finding in findings:
        print("FAILED:", finding)
    if findings:
        sys.exit(1)
    print(f"{len(all_pages())} pages: commands, options, names, links and sentences")


def find_what_is_planted(program):
    """A page of offences, one a line: each must be found."""
    planted = {"    trim3r info room.mcap": "outside a shell block", "```sh not-run\ntrim3r info\n```": "no reason",
               "```sh not-run: slow\ntrim3r info a --wrong\n```": "trim3r info has no option --wrong",
               "```sh not-run: slow\ntrim3r wrong a\n```": "no command trim3r wrong", "Say `--no-such`.": "--no-such",
               "See `t3r_no_such()`.": "t3r_no_such", "See [it](no/such.md).": "no/such.md",
               "See [it](README.md#no-such).": "no-such", " ".join(["word"] * 36) + ".": "36 words",
               "```\ntools/demo\n```": "outside a shell block"}
    for page, text in planted.items():
        found = check(ROOT / "planted.md", f"# Planted\n\n{page}\n", program)
        if len(found) != 1 or text not in found[0]:
            sys.exit(f"blind: '{text}' planted in a page was not found alone: {found}")
    source = "| a | 27.88 / 0.831 / 0.1 | 27.73 / 0.830 / 0.2 | 27.68 / 0.834 / 0.3 |\n"
    for row, wanted in {"| x | 27.88 | 27.73 | 27.68 | 0.4* |": 0, "| x | 27.88 / 0.831 | 27.73 / 0.830 | 27.68 / 0.834 |": 0,
                        "| x | 27.88 | 27.73 | 27.69 | 0.4* |": 1, "| x | 27.88 / 0.831 | 27.73 / 0.830 | 27.68 / 0.833 |": 1}.items():
        if len(list(figures("planted.md", row, source))) != wanted:
            sys.exit(f"blind: figures of {row}")
    good = "# Good\n\n" + " ".join(["word"] * 34) + " [it](README.md#try-it).\n\n```sh\ntrim3r info room.mcap --json\n```\n"
    found = check(ROOT / "planted.md", good, program)
    if found:
        sys.exit(f"sees offences where there are none: {found}")


def figures(name, text, source):
    """Figures in a copied table stand side by side in a row of its source; PSNR alone, or PSNR / SSIM."""
    rows = [values(line, 2) for line in source.splitlines() if line.startswith("|")]
    for line in text.splitlines():
        wanted = values(line, 2) or values(line, 1)
        if line.startswith("|") and len(wanted) > 2 and not any(stands_in(wanted, row) for row in rows):
            yield f"{name}: not a row of docs/study/paper.md: {line}"


def values(line, count):
    """The first numbers of each cell that begins with `count` decimal fractions: one, or two with a slash between."""
    number = r"(\d+\.\d{2,3})"
    return [match[:count] for match in re.findall(r"\| *" + number + (" / " + number if count == 2 else r"()(?= *\|)"), line)]


def stands_in(wanted, row):
    row = [cell[:len(wanted[0])] for cell in row]
    return any(row[at:at + len(wanted)] == wanted for at in range(len(row) - len(wanted) + 1))


def check(page, text, program):
    name = page.relative_to(ROOT)
    return [*commands(name, text), *options(name, text, program), *names(name, text), *links(page, text),
            *sentences(name, text)]


def commands(name, text):
    for block in blocks_of(text):
        if block.skipped and not block.reason:
            yield f"{name}:{block.line}: the block does not run and gives no reason"
        if not block.is_shell and block.expected is None and block.language != "text":
            for line in block.body.splitlines():
                if COMMAND.match(line):
                    yield f"{name}:{block.line}: '{line.strip()}' stands outside a shell block"
    for number, line in enumerate(re.sub(FENCE, lambda m: "\n" * m.group(0).count("\n"), text).split("\n"), start=1):
        if line.startswith("    ") and COMMAND.match(line):
            yield f"{name}:{number}: '{line.strip()}' stands outside a shell block"


def options(name, text, program):
    for block in blocks_of(text):
        if not block.is_shell:
            continue
        for line in re.sub(r"\\\n", " ", block.body).splitlines():
            for part in re.split(r"&&|[|;]", line.split(" #")[0]):
                yield from options_of(f"{name}:{block.line}", part.split(), program)
    for match in OPTION.finditer(" ".join(re.findall(r"`([^`]*)`", without_blocks(text)))):
        if match.group(0) not in known_options(program):
            yield f"{name}: {match.group(0)} is an option of nothing"


def options_of(where, words, program):
    if words[:1] != ["trim3r"] or len(words) < 2 or words[1].startswith("-"):
        return
    known = options_in_help(program, words[1])
    if not known:
        yield f"{where}: there is no command trim3r {words[1]}"
        return
    for match in OPTION.finditer(" ".join(words[2:])):
        if match.group(0) not in known:
            yield f"{where}: trim3r {words[1]} has no option {match.group(0)}"


@functools.cache
def options_in_help(program, command):
    ended = subprocess.run([program, command, "--help"], capture_output=True, text=True, check=False)
    return set(OPTION.findall(ended.stdout)) if ended.returncode == 0 else set()


@functools.cache
def known_options(program):
    """Of all commands, and of the scripts."""
    overview = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    known = set().union(*(options_in_help(program, command) for command in re.findall(r"^  ([a-z-]+) ", overview, re.M)))
    for folder in ("tools", "docs"):
        for path in (ROOT / folder).rglob("*"):
            if path.is_file() and (path.suffix == ".py" or (not path.suffix and path.stat().st_mode & 0o100)):
                known |= set(OPTION.findall(path.read_text()))
    return known


@functools.cache
def known_names():
    known = set()
    for folder in ("runtime", "quant", "platform"):
        for path in (ROOT / folder).rglob("*"):
            if path.suffix in (".h", ".c", ".cmake"):
                known |= set(NAME.findall(path.read_text()))
    return known | set(NAME.findall((ROOT / "CMakeLists.txt").read_text()))


def names(name, text):
    for wanted in sorted(set(NAME.findall(text)) - known_names()):
        yield f"{name}: there is no {wanted}"


def links(page, text):
    for match in LINK.finditer(re.sub(FENCE, "", text)):
        path, _, anchor = match.group(2).partition("#")
        if path.startswith("http"):
            continue
        target = page.parent / path if path else page
        if not target.exists():
            yield f"{page.relative_to(ROOT)}: the link to {match.group(2)} leads nowhere"
        elif anchor and anchor not in anchors_of(target.read_text()):
            yield f"{page.relative_to(ROOT)}: {path} has no heading {anchor}"


def anchors_of(text):
    headings = re.findall(r"^#+ (.*)$", re.sub(FENCE, "", text), re.M)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def sentences(name, text):
    for line, words in sentences_of(text):
        if len(words) > WORDS:
            yield f"{name}:{line}: a sentence of {len(words)} words: {' '.join(words[:8])} ..."


if __name__ == "__main__":
    main()
