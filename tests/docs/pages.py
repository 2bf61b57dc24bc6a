# SPDX-License-Identifier: Apache-2.0
"""Contents of the pages: blocks, prose, links."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```[ ]*$", re.M | re.S)
LINK = re.compile(r"!?\[([^\]]*)\]\(([^)\s]+)\)")


def all_pages():
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md")), ROOT / "quant" / "README.md",
            ROOT / "tools" / "study" / "train" / "README.md"]


class Block:
    """A fenced block: its language, the reason why it does not run, its first line, its expected output."""

    def __init__(self, text, match):
        language, _, reason = match.group(1).partition("not-run")
        self.language, self.body = language.strip(), match.group(2)
        self.skipped, self.reason = "not-run" in match.group(1), reason.lstrip(":").strip()
        self.line = text.count("\n", 0, match.start()) + 1
        self.expected = None

    @property
    def is_shell(self):
        return self.language == "sh"

    @property
    def runs(self):
        return self.is_shell and not self.skipped


def blocks_of(text):
    """Returns the fenced blocks; a text block that follows a shell block is its output."""
    blocks, end = [], 0
    for match in FENCE.finditer(text):
        block = Block(text, match)
        if block.language == "text" and blocks and blocks[-1].runs and not text[end:match.start()].strip():
            blocks[-1].expected = block.body
        blocks.append(block)
        end = match.end()
    return blocks


def given_in(text):
    """Returns the files with which the page begins: <!-- given: room.mcap posed/ -->."""
    return [name for match in re.finditer(r"<!-- given: (.*?) -->", text) for name in match.group(1).split()]


def needed_by(text):
    """Returns the build outputs that the page needs: <!-- needs: build/release/NAME -->."""
    return [name for match in re.finditer(r"<!-- needs: (.*?) -->", text) for name in match.group(1).split()]


def without_blocks(text):
    """Returns the page with fenced blocks, comments and tables blanked, line for line."""
    text = re.sub(FENCE, lambda match: "\n" * match.group(0).count("\n"), text)
    text = re.sub(r"<!--.*?-->", lambda match: "\n" * match.group(0).count("\n"), text, flags=re.S)
    return re.sub(r"^\|.*$", "", text, flags=re.M)


def sentences_of(text):
    """Yields (line, words) of each sentence outside blocks, tables and headings."""
    paragraph, first = [], 0
    for number, line in enumerate(without_blocks(text).split("\n") + [""], start=1):
        new = line.startswith(("#", "    ")) or not line.strip()
        if new or re.match(r"\s*([-*]|\d+\.) ", line):
            yield from split(" ".join(paragraph), first)
            paragraph = []
        if not new:
            if not paragraph:
                first = number
            paragraph.append(re.sub(r"^\s*([-*]|\d+\.) ", "", line).strip())


def split(paragraph, line):
    plain = LINK.sub(r"\1", paragraph)
    plain = re.sub(r"`[^`]*`", "code", plain)
    for sentence in re.split(r"(?<=[.!?])[*)\"]*\s+", plain):
        words = re.findall(r"[\w'.,%/+-]*\w[\w'.,%/+-]*", sentence)
        if words:
            yield line, words
