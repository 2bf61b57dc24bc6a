# SPDX-License-Identifier: Apache-2.0
"""Style of the pages: the length of sentences, and wrapped lines that look like lists."""
import re

from pages import sentences_of, without_blocks

WORDS = 35


def sentences(name, text):
    for line, words in sentences_of(text):
        if len(words) > WORDS:
            yield f"{name}:{line}: a sentence of {len(words)} words: {' '.join(words[:8])} ..."


def markers(name, text):
    """Finds lines inside a paragraph that begin like a list, a quotation or an underline."""
    lines = without_blocks(text).split("\n")
    for number, (above, line) in enumerate(zip(lines, lines[1:]), start=2):
        in_list = re.match(r"\s*([-*]|\d+\.) |  ", above) and re.match(r"(-|\d+\.) ", line)
        if re.match(r"([-+>=]+|\d+[.)]) ", line) and above.strip() and not above.startswith("#") and not in_list:
            yield f"{name}:{number}: begins like a list: {line[:40]}"
