"""What the scripts of this folder share."""
import importlib.util
import os
import subprocess
import sys

checks = 0


def check(condition, text):
    """One expectation; the first that fails ends the script."""
    global checks
    checks += 1
    if not condition:
        print(f"FAILED: {text}")
        sys.exit(1)


def near(a, b, bound, text):
    check(abs(a - b) <= bound, f"{text}: {a} and {b} differ by more than {bound}")


def skip(reason):
    print(f"SKIPPED: {reason}")
    sys.exit(77)


def need_numpy():
    try:
        import cv2
        import numpy
    except ImportError as error:
        skip(str(error))
    return numpy, cv2


def load_scorer(path):
    """score.py as a module, or None where it is not there."""
    if not os.path.exists(path):
        return None
    sys.dont_write_bytecode = True
    spec = importlib.util.spec_from_file_location("score", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(*command, expect=0):
    # restore_signals: a child under a limit of file sizes must get the error, not the signal
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, restore_signals=False)
    check(done.returncode == expect,
          f"{' '.join(map(str, command))}: exit status {done.returncode}, not {expect}\n{done.stdout}{done.stderr}")
    return done


def done():
    print(f"{checks} checks")
