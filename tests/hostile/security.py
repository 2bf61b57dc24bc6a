# SPDX-License-Identifier: Apache-2.0
"""SECURITY.md names every limit of platform/mcap/reader_limits.h with its value, and files that exist.

security.py SOURCE_FOLDER
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
header = (root / "platform" / "mcap" / "reader_limits.h").read_text()
page = (root / "SECURITY.md").read_text()
failures = []


def value(text):
    """Returns the number of a #define: a shifted or plain integer."""
    text = re.sub(r"U?INT(?:32|64)_C\((\d+)\)", r"\1", text.split("/*")[0]).strip()
    match = re.fullmatch(r"\(?(\d+)(?: << (\d+))?\)?", text)
    return int(match[1]) << int(match[2] or 0)


limits = {name: value(text) for name, text in re.findall(r"#define (T3R_LIMIT_\w+) (.+)", header)}
told = {name: int(number) for name, number in re.findall(r"\| `(T3R_LIMIT_\w+)` \| (\d+) \|", page)}
for name in sorted(limits.keys() | told.keys()):
    if limits.get(name) != told.get(name):
        failures.append(f"{name}: {limits.get(name)} in the header, {told.get(name)} in SECURITY.md")
for link in re.findall(r"\]\(([^)]+)\)", page):
    if not (root / link).exists():
        failures.append(f"SECURITY.md: {link} does not exist")
if len(limits) < 10:
    failures.append("hardly any limit was found in the header")
for failure in failures:
    print("FAILED:", failure)
print(f"{len(limits)} limits")
sys.exit(1 if failures else 0)
