# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder; the program is their first argument."""
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from checks import check, done  # noqa: E402, F401

TRIM3R = os.path.abspath(sys.argv[1])


def run(*command, expect=0, words=""):
    """Returns the program's output; its messages must contain `words`."""
    ended = subprocess.run([TRIM3R, *map(str, command)], capture_output=True, text=True, timeout=300)
    check(ended.returncode == expect and words in ended.stderr, f"{command}: {ended.returncode} {ended.stderr}")
    return ended.stdout
