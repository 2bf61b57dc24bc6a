#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""help.py TRIM3R: the style of help. A command or a switch says in the imperative what it does; an option with a
value names the value in a noun phrase: lower case first, no full stop, then range and default as `1..16 (4)`."""
import os
import re
import subprocess

from program import TRIM3R, check, expect, in_scratch

BANNED = r"\b(tell|tells|telling|told|said|says|aside|promises?|sights?|workshop)\b"
FRAGMENT = r"(of|to|for|than|with|which|where|what|how|that|likewise|wider) "  # an incomplete phrase
PROPER = r"SuperClusters|Gaussians|TUM|FLIP|PNG|MiB"
WORDS = 35
WIDTH = 78


def commands_of(summary):
    return re.findall(r"^  ([a-z-]+) +(\S.*)$", summary, flags=re.M)


def options_of(text):
    """Yields each option and its text; a long option has its text in the line below."""
    for line in re.sub(r"\n {29}(?=\S)", " ", text).splitlines():
        found = re.match(r" {2,6}(-\w [A-Z]+|(?:-\w, )?--[a-z0-9-]+\S*)\s+(\S.*)$", line)
        if found and not re.search(r"--(help|usage)$", found[1]):
            yield found[1], found[2]


def findings(name, text):
    """Returns what is wrong with the text of an option or of a command."""
    if text[0].isupper() and not re.match(PROPER, text):
        yield f"{name} begins with a capital: {text}"
    if text.endswith("."):
        yield f"{name} ends with a full stop: {text}"
    if re.match(FRAGMENT, text):
        yield f"{name} begins in the middle: {text}"


def prose(name, text):
    """Returns what is wrong with any text of a command's help, except its examples."""
    for found in re.finditer(BANNED, text):
        yield f"{name}: '{found[0]}' in: {text[max(0, found.start() - 30):found.end() + 30]!r}"
    for line in text.splitlines():
        if re.match(r"  +[^ -]", line) and len(line) > WIDTH and not line.startswith(" " * 29):
            yield f"{name}: wrapped in a list: {line}"
    lines = "\n".join(line if not line.startswith("  ") else "." for line in text.splitlines())
    for sentence in re.split(r"[.?!:](?:\s|$)|\n", lines):
        words = re.findall(r"[A-Za-z][\w'-]*", sentence)
        if len(words) > WORDS:
            yield f"{name}: {len(words)} words: {' '.join(words[:10])} ..."


def layout(name, text):
    """Returns lines that argp breaks where an option's text fills a line to the last column: they want another word."""
    for line in re.findall(r"^ +$|^ {30,}--[a-z].*$", text, flags=re.M):
        yield f"{name}: a line of help is broken: {line!r}"


def find_what_is_planted():
    check(len(list(layout("x", "a\n  \n" + " " * 35 + "--start=A|B\nwidths\n"))) == 2, "blind to planted lines")
    check(list(findings("x", "Tell more.")) != [] and list(findings("x", "of a stream")) != [], "blind to a planted text")
    check(list(prose("x", "what we told " + "word " * 40)) != [], "blind to planted prose")
    check(list(options_of("  -o, --output=REC.mcap      recording to write")) ==
          [("-o, --output=REC.mcap", "recording to write")] and
          list(options_of("      --json                 print it")) == [("--json", "print it")] and
          list(options_of("      --a=B|c[:D]\n" + " " * 29 + "b of a")) == [("--a=B|c[:D]", "b of a")] and
          list(options_of("  -o OUT                     file to write")) == [("-o OUT", "file to write")],
          "an option's line is not read")


def every_help():
    find_what_is_planted()
    summary = expect(0, "--help")
    wrong = list(prose("--help", summary))
    commands = commands_of(summary)
    check(len(commands) >= 15, f"{len(commands)} commands")
    for command, about in commands:
        wrong += findings(command, about)
        wrong += layout(command, expect(0, command, "--help"))
        wide = subprocess.run([TRIM3R, command, "--help"], capture_output=True, text=True, check=True,
                              env={**os.environ, "ARGP_HELP_FMT": "rmargin=2000"}).stdout
        options = list(options_of(wide))
        check(options, f"{command} has no options")
        for option, text in options:
            wrong += findings(f"{command} {option}", text)
        wrong += prose(command, wide)
    check(not wrong, "\n".join(sorted(set(wrong))))


in_scratch(every_help)
