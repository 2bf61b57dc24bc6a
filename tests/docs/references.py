# SPDX-License-Identifier: Apache-2.0
"""References on pages exist: commands, their options, names of the interface, links."""
import functools
import re
import subprocess

from pages import FENCE, LINK, ROOT, blocks_of, without_blocks

COMMAND = re.compile(r"^\s*(?:\$ )?(?:trim3r [a-z]|tools/[a-z]|build/release/[a-z])")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*")
NAME = re.compile(r"\b(?:t3r|T3R)_\w+")


class Program:
    """The commands of trim3r and their options, from its help."""

    def __init__(self, path):
        self.path = path
        self.commands = re.findall(r"^  ([a-z-]+) +[a-z]", self.help_of(), re.M)
        self.options = {command: set(OPTION.findall(self.help_of(command))) for command in self.commands}

    def help_of(self, *command):
        return subprocess.run([self.path, *command, "--help"], capture_output=True, text=True, check=True).stdout


def commands(name, text):
    """Finds commands outside a shell block, and blocks that do not run and give no reason."""
    for block in blocks_of(text):
        if block.skipped and not block.reason:
            yield f"{name}:{block.line}: the block does not run and gives no reason"
        if not block.is_shell and block.language != "text":
            yield from stray(name, block.line, block.body.splitlines())
    outside = re.sub(FENCE, lambda match: "\n" * match.group(0).count("\n"), text).split("\n")
    for number, line in enumerate(outside, start=1):
        if line.startswith("    "):
            yield from stray(name, number, [line])


def stray(name, number, lines):
    for line in lines:
        if COMMAND.match(line):
            yield f"{name}:{number}: '{line.strip()}' stands outside a shell block"


def options(name, text, program):
    for block in blocks_of(text):
        if block.is_shell:
            for line in re.sub(r"\\\n", " ", block.body).splitlines():
                for part in re.split(r"&&|[|;]", line.split(" #")[0]):
                    yield from options_of(f"{name}:{block.line}", part.split(), program)
    known = options_of_scripts().union(*program.options.values())
    for option in OPTION.findall(" ".join(re.findall(r"`([^`]*)`", without_blocks(text)))):
        if option not in known:
            yield f"{name}: {option} is an option of nothing"


def options_of(where, words, program):
    if words[:2] == ["trim3r", "help"]:
        words = ["trim3r", *words[2:]]
    if words[:1] != ["trim3r"] or len(words) < 2 or words[1].startswith("-"):
        return
    if words[1] not in program.commands:
        yield f"{where}: there is no command trim3r {words[1]}"
        return
    for option in OPTION.findall(" ".join(words[2:])):
        if option not in program.options[words[1]] | {"--help"}:
            yield f"{where}: trim3r {words[1]} has no option {option}"


@functools.cache
def options_of_scripts():
    known = set()
    for folder in ("tools", "docs"):
        for path in (ROOT / folder).rglob("*"):
            if path.is_file() and (path.suffix == ".py" or (not path.suffix and path.stat().st_mode & 0o100)):
                known |= set(OPTION.findall(path.read_text()))
    return known


def commands_missing(program, text):
    for command in program.commands:
        if not re.search(rf"trim3r {command}\b", text):
            yield f"docs/cli.md does not show trim3r {command}"


def names(name, text):
    for wanted in sorted(set(NAME.findall(text)) - known_names()):
        yield f"{name}: there is no {wanted}"


@functools.cache
def known_names():
    known = set(NAME.findall((ROOT / "CMakeLists.txt").read_text()))
    for folder in ("runtime", "quant", "platform", "tools/planning"):  # planning: of the header that it writes
        for path in (ROOT / folder).rglob("*"):
            if path.suffix in (".h", ".c", ".cmake"):
                known |= set(NAME.findall(path.read_text()))
    return known


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
