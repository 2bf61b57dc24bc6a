#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""comments.py: the comments of the runtime's headers read plainly. Every field of a public struct has a comment of its
own, which begins with a capital and ends as a sentence; no sentence is long; some words have no place in a reference.
"""
import re
import sys

import proof

WORDS = 35
BANNED = re.compile(r"\b(tell|tells|told|aside|promises?|promised|sights?|workshop)\b")
PUBLIC = proof.RUNTIME / "include" / "trim3r.h"


def comments_of(text):
    """Yields line and text of each comment; indented or drawn lines end a sentence, like an empty line."""
    for match in re.finditer(r"/\*(.*?)\*/", text, flags=re.S):
        lines = [re.sub(r"^\s*\* ?", "", line) for line in match[1].split("\n")]
        yield text[:match.start()].count("\n") + 1, "\n".join("." if line.startswith("    ") else line for line in lines)


def wording(name, text):
    for line, comment in comments_of(text):
        for found in BANNED.finditer(comment):
            yield f"{name}:{line}: '{found[0]}'"
        for sentence in re.split(r"[.:;?!](?:\s|$)|\n\s*\n", comment):
            words = re.findall(r"[A-Za-z][\w'()]*", sentence)
            if len(words) > WORDS:
                yield f"{name}:{line}: {len(words)} words: {' '.join(words[:8])} ..."


def fields(name, text):
    """Yields fields of structs without a preceding sentence."""
    for struct in re.finditer(r"typedef struct \w+ \{(.*?)\n\} \w+;", text, flags=re.S):
        line, documented = text[:struct.start(1)].count("\n") + 1, False
        for part in re.finditer(r"/\*(.*?)\*/|([^;/]+);|\n", struct[1], flags=re.S):
            at = line + struct[1][:part.start()].count("\n") + len(re.match(r"\n*", part[0])[0])
            if part[1]:
                documented = re.match(r"\s*[A-Z0-9]", part[1]) and re.search(r"[.\]]\s*$", part[1])
            elif part[2] and part[2].strip():
                if not documented:
                    yield f"{name}:{at}: no sentence says what this is: {' '.join(part[2].split())}"
                documented = False


def main():
    planted = "typedef struct a {\n    /* The width. */\n    int w;\n    int h; /* it */\n} a;\n"
    proof.must_find(list(fields("planted", planted)), "planted:4", "a field without a sentence")
    proof.must_find(list(wording("planted", "/* a word aside */")), "'aside'", "a word")
    proof.must_find(list(wording("planted", f"/* {'word ' * 36}. */")), "36 words", "a long sentence")
    headers = sorted(proof.RUNTIME.rglob("*.h"))
    found = list(fields(PUBLIC.name, PUBLIC.read_text()))
    for path in headers:
        found += wording(path.relative_to(proof.RUNTIME), path.read_text())
    proof.verdict(f"{len(headers)} headers: plain comments, a sentence for each public field", found)


if __name__ == "__main__":
    sys.exit(main())
