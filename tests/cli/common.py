"""What scripts of this folder share; the program is their first argument."""
import os
import subprocess
import sys

TRIM3R = os.path.abspath(sys.argv[1])
checks = 0


def check(condition, text):
    """One expectation; the first that fails ends the script."""
    global checks
    checks += 1
    if not condition:
        print(f"FAILED: {text}")
        sys.exit(1)


def run(*command, expect=0, words=""):
    """What the program prints; `words` must stand in its messages."""
    done = subprocess.run([TRIM3R, *map(str, command)], capture_output=True, text=True, timeout=300)
    check(done.returncode == expect and words in done.stderr, f"{command}: {done.returncode} {done.stderr}")
    return done.stdout


def done():
    print(f"{checks} checks")
