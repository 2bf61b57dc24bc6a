#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""made_table.py PAGE MARK ROWS PROGRAM [--update]: the table between the comments MARK:begin and MARK:end of docs/PAGE is
the one that the test PROGRAM writes, of at least so many rows. --update writes it."""
import os
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from checks import check, done, run  # noqa: E402


def written_by(program):
    """Returns the table that the program writes; its tests pass."""
    with tempfile.TemporaryDirectory(prefix="trim3r-table-") as folder:
        path = pathlib.Path(folder) / "table.md"
        os.environ["T3R_TABLE"] = str(path)
        run(program)
        return path.read_text()


def main():
    page, mark, rows, program = ROOT / "docs" / sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4]
    block = re.compile(rf"(<!-- {mark}:begin -->\n)(.*?)(<!-- {mark}:end -->)", re.S)
    table, text = written_by(program), page.read_text()
    count = len(re.findall(r"^\| (?!---)", table, re.M))
    check(count >= rows, f"blind: {count} rows, wanted {rows}")
    if "--update" in sys.argv:
        page.write_text(block.sub(lambda match: match[1] + table + match[3], text))
    else:
        shown = block.search(text)
        check(shown is not None and shown[2] == table,
              f"docs/{page.name} is not of this table; tests/docs/made_table.py {' '.join(sys.argv[1:])} --update "
              f"writes\n{table}")
    done()


if __name__ == "__main__":
    main()
