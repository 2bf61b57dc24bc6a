# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder; the program is their first argument. A failed expectation is reported, and
the script goes on."""
import os
import subprocess
import sys

PROGRAM = os.path.abspath(sys.argv[1])
failures = []


def check(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def run(*arguments):
    ended = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=300, check=False)
    return ended.returncode, ended.stdout, ended.stderr


def done():
    print("failed:" if failures else "all passed", len(failures) or "")
    sys.exit(1 if failures else 0)
