# SPDX-License-Identifier: Apache-2.0
"""Mutants of a C source: the source with one small mistake of the kind that people make. Comments, strings,
preprocessor lines, declared lengths of arrays, and bounds that a release build does not check are never changed.

This relies on clang-format's layout: a binary operator is followed by a space."""
import dataclasses
import re

TOKEN = re.compile(r"""(?P<skip>/\*.*?\*/|//[^\n]*|^[ \t]*\#(?:[^\n\\]|\\.)*|\s+)
                      |(?P<text>"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*')
                      |(?P<number>\.?\d(?:[eEpP][+-]|[\w.])*)
                      |(?P<name>[A-Za-z_]\w*)
                      |(?P<sign><<=|>>=|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|.)""", re.M | re.S | re.X)
HEAD = re.compile(r"^\w[^;={}]*?\b(\w+)\([^;={}]*\)\s*\{", re.M) # a function's, at the start of a line
LEFT_ALONE = {"T3R_BOUND", "T3R_ASSERT", "_Static_assert", "__attribute__"}
STATEMENTS = {"break", "case", "continue", "default", "do", "else", "for", "goto", "if", "return", "switch", "while"}
WORDS_OF_TYPES = {"bool", "char", "const", "int", "void"}
BETWEEN_TWO = {
    "+": ["-"], "-": ["+"], "*": ["+"], "/": ["*"], "%": ["/"],
    "<<": [">>"], ">>": ["<<"], "&": ["|"], "|": ["&"], "^": ["|"],
    "<": ["<=", ">="], "<=": ["<", ">"], ">": [">=", "<="], ">=": [">", "<"], "==": ["!="], "!=": ["=="],
    "&&": ["||"], "||": ["&&"],
    "+=": ["-="], "-=": ["+="], "*=": ["+="], "/=": ["*="], "^=": ["|="], "|=": ["&="], "&=": ["|="],
    ">>=": ["<<="], "<<=": [">>="],
}
COMPARISONS = {"<", "<=", ">", ">=", "==", "!="}
OTHER_NAME = {"T3R_MIN": "T3R_MAX", "T3R_MAX": "T3R_MIN"}
WIDE = {"int64_t", "uint64_t"}
CLOSES = {"(": ")", "[": "]", "{": "}"}
TABLE_LEAST, TABLE_STEP = 32, 16 # for an initializer of that length, every sixteenth number


@dataclasses.dataclass(frozen=True)
class Token:
    kind: str
    text: str
    begin: int
    end: int


@dataclasses.dataclass(frozen=True)
class Mutant:
    """The source with [begin, end) replaced. `place` is its file and function, `before` and `after` are the changed
    lines, with single spaces."""
    file: str
    place: str
    begin: int
    end: int
    put: str
    before: str
    after: str

    @property
    def key(self):
        return self.place, self.before, self.after

    def of(self, source):
        return source[:self.begin] + self.put + source[self.end:]


def tokens_of(source):
    return [Token(match.lastgroup, match[0], match.start(), match.end()) for match in TOKEN.finditer(source)
            if match.lastgroup != "skip"]


class Source:
    """A source's tokens, and the pairs of brackets."""

    def __init__(self, text):
        self.text, self.tokens = text, tokens_of(text)
        self.partner, opened = {}, []
        for i, token in enumerate(self.tokens):
            if token.kind == "sign" and token.text in CLOSES:
                opened.append(i)
            elif opened and token.text == CLOSES[self.tokens[opened[-1]].text]:
                self.partner[i], self.partner[opened[-1]] = opened[-1], i
                opened.pop()
        self.left_alone = set()
        for i, token in enumerate(self.tokens):
            if token.text in LEFT_ALONE and self.is_at(i + 1, "("):
                self.left_alone.update(range(i, self.partner[i + 1] + 1))
        self.table_places = {}
        for i, token in enumerate(self.tokens):
            if token.text == "{" and i in self.partner:
                numbers = [j for j in range(i, self.partner[i]) if self.tokens[j].kind == "number"]
                if len(numbers) >= TABLE_LEAST and len(numbers) * 2 >= self.partner[i] - i - 1:
                    self.table_places.update({j: place for place, j in enumerate(numbers)})

    def is_at(self, i, *texts):
        return 0 <= i < len(self.tokens) and self.tokens[i].text in texts

    def span(self, first, last):
        return self.tokens[first].begin, self.tokens[last].end

    def inner(self, opening, top=True):
        """Yields the tokens between a bracket and its partner; with `top` not those of inner brackets."""
        i = opening + 1
        while i < self.partner[opening]:
            yield i
            i = self.partner[i] if top and self.tokens[i].text in CLOSES else i + 1

    def is_type(self, i):
        token = self.tokens[i]
        return token.kind == "name" and (token.text.endswith("_t") or token.text in WORDS_OF_TYPES)

    def is_between_two(self, i):
        return self.text[self.tokens[i].end:][:1].isspace()

    def is_declared_length(self, i):
        """uint32_t names[129]: a type, a name, a length"""
        return (self.is_at(i - 1, "[") and self.is_at(i + 1, "]") and self.tokens[i - 2].kind == "name"
                and self.tokens[i - 3].kind == "name" and self.tokens[i - 3].text not in STATEMENTS)


def other_numbers(text):
    """Returns the number plus one and minus one, in the same base and of the same type; none for a real or an octal
    one."""
    match = re.fullmatch(r"(0[xX][0-9a-fA-F]+|0|[1-9]\d*)([uUlL]*)", text)
    if match is None:
        return []
    value, hexadecimal = int(match[1], 0), match[1][:2] in ("0x", "0X")
    return [(hex(other) if hexadecimal else str(other)) + match[2] for other in (value + 1, value - 1) if other >= 0]


def changes(source):
    """Yields (begin, end, replacement) for each mutant."""
    for i, token in enumerate(source.tokens):
        if i in source.left_alone:
            continue
        here = source.span(i, i)
        if token.kind == "number":
            if not source.is_declared_length(i) and source.table_places.get(i, 0) % TABLE_STEP == 0:
                yield from ((*here, other) for other in other_numbers(token.text))
        elif token.kind == "name":
            if token.text in OTHER_NAME:
                yield (*here, OTHER_NAME[token.text])
            if token.text in ("if", "while") and source.is_at(i + 1, "("):
                yield from negated(source, i + 1)
            yield from dropped_statement(source, i)
        elif token.kind == "sign":
            if token.text in BETWEEN_TWO and source.is_between_two(i):
                yield from ((*here, other) for other in BETWEEN_TWO[token.text])
            elif token.text in ("!", "-", "~"):
                yield (*here, "")
            elif token.text in ("++", "--"):
                yield (*here, {"++": "--", "--": "++"}[token.text])
            elif token.text == "(":
                yield from dropped_cast(source, i)
                yield from dropped_half(source, i)


def negated(source, opening):
    """Negates a condition, unless it has a comparison, whose mutants suffice."""
    if not any(source.tokens[i].text in COMPARISONS for i in source.inner(opening, top=False)):
        begin, end = source.span(opening, source.partner[opening])
        yield begin, end, f"(!{source.text[begin:end]})"


def dropped_cast(source, opening):
    """(uint64_t)x * y without the cast: a product of 32 bits"""
    if not source.is_at(opening + 1, *WIDE) or not source.is_at(opening + 2, ")"):
        return
    end = opening + 3
    while source.is_at(end, "(", "[", ".", "->") or source.tokens[end].kind in ("name", "number"):
        end = source.partner.get(end, end) + 1
    if source.is_at(end, "*", "<<") or source.is_at(opening - 1, "*"):
        yield (*source.span(opening, opening + 2), "")


def dropped_half(source, opening):
    """(x + half) >> shift rounded down"""
    closing = source.partner[opening]
    sums = [i for i in source.inner(opening) if source.is_at(i, "+") and source.is_between_two(i)]
    if source.is_at(closing + 1, ">>") and sums:
        yield source.tokens[sums[-1] - 1].end, source.tokens[closing].begin, ""


def dropped_statement(source, i):
    """An assignment or a call, as a statement of its own"""
    starts = source.is_at(i - 1, ";", "{", "}") and not source.is_type(i) and source.tokens[i].text not in STATEMENTS
    if not starts or not source.is_at(i + 1, "=", "[", ".", "->", "(", "++", "--", *(s for s in BETWEEN_TWO if s[-1] == "=")):
        return
    end = i
    while not source.is_at(end, ";"):
        if source.is_at(end, "{") or end + 1 == len(source.tokens):
            return
        end = source.partner[end] + 1 if source.tokens[end].text in CLOSES else end + 1
    yield (*source.span(i, end), ";")


def mutants_of(file, text):
    """Returns every mutant of a source, in the order of its text, without repetitions."""
    def lines(whole, begin, end):
        return " ".join(whole[whole.rfind("\n", 0, begin) + 1:(whole + "\n").index("\n", end)].split())

    heads = [(match.start(), match[1]) for match in HEAD.finditer(text)]
    made, seen = [], set()
    for begin, end, put in changes(Source(text)):
        changed = text[:begin] + put + text[end:]
        if changed not in seen:
            seen.add(changed)
            place = ": ".join([file, *[name for start, name in heads if start < begin][-1:]])
            made.append(Mutant(file, place, begin, end, put, lines(text, begin, end),
                               lines(changed, begin, begin + len(put))))
    return sorted(made, key=lambda mutant: mutant.begin)
