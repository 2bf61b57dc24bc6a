# SPDX-License-Identifier: Apache-2.0
"""Expectations shared by the scripts of all folders; the first failed one ends the script."""
import subprocess
import sys

_count = 0


def check(condition, text):
    global _count
    _count += 1
    if not condition:
        print(f"FAILED: {text}")
        sys.exit(1)


def near(a, b, bound, text):
    check(abs(a - b) <= bound, f"{text}: {a} and {b} differ by more than {bound}")


def run(*command, expect=0):
    """Runs a command that must end with that status; returns the result of subprocess.run()."""
    # restore_signals: a child under a limit of file sizes must get the error, not the signal
    ended = subprocess.run([str(part) for part in command], capture_output=True, text=True, restore_signals=False)
    check(ended.returncode == expect,
          f"{' '.join(map(str, command))}: exit status {ended.returncode}, not {expect}\n{ended.stdout}{ended.stderr}")
    return ended


def skip(reason):
    print(f"SKIPPED: {reason}")
    sys.exit(77)


def done():
    print(f"{_count} checks")
