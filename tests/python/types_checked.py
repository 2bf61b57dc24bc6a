#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""types_checked.py LIBRARY: mypy finds nothing in the package, nor in a correct program, and finds wrong uses.
Everything public has a docstring and types."""
import inspect
import pathlib
import shutil
import subprocess
import sys
import tempfile

from common import PACKAGE, ROOT, check, skip, trim3r

from checks import done

USE = '''
import numpy as np
import trim3r

frame = trim3r.Frame(np.zeros((8, 8, 3), np.uint8), trim3r.Camera.calibrated(8, 8, 4, 4, np.eye(4)))
with trim3r.Reconstructor(8, 8, views=1, settings={"refine": 2, "wavelet": "haar"}) as made:
    made.add_view(frame)
    scene = made.build(keep=10)
    image = made.render(trim3r.Camera.calibrated(8, 8, 4, 4, np.eye(4)))
    reveal_type(image)
'''
MISUSE = {"made.build(keep='10')": "arg-type", "made.bild(10)": "attr-defined", "trim3r.psnr(image)": "call-arg",
          "made.add_view(image)": "arg-type", "trim3r.Reconstructor(8, 8, veiws=2)": "call-arg"}


def check_types(folder):
    """Checks the package, the example, and a program with errors at its end: exactly these are found."""
    used = pathlib.Path(folder) / "used.py"
    used.write_text(USE + "\n".join(MISUSE) + "\n")
    found = subprocess.run(["mypy", "--config-file", ROOT / "tools" / "python" / "pyproject.toml", "--show-error-codes",
                            "--cache-dir", folder, "--python-executable", sys.executable, "trim3r",
                            ROOT / "tools" / "python" / "examples" / "room.py", used],
                           capture_output=True, text=True, check=False, cwd=PACKAGE.parent).stdout
    picture = "numpy.ndarray[Any, numpy.dtype[numpy.unsignedinteger[numpy._typing._8Bit]]]"
    check(picture in found, f"a picture's type: {found}")
    wrong = [line for line in found.splitlines() if ": error:" in line]
    check(len(wrong) == len(MISUSE), f"{len(MISUSE)} were planted: {found}")
    for line, (call, code) in zip(wrong, MISUSE.items()):
        check("used.py" in line and f"[{code}]" in line, f"{call}: {line}")


def check_documented():
    for name in trim3r.__all__:
        thing = getattr(trim3r, name)
        if not callable(thing) or name == "Settings":
            continue
        check(thing.__doc__, f"{name} has no docstring")
        for member, value in vars(thing).items() if inspect.isclass(thing) else ():
            if (inspect.isfunction(value) or isinstance(value, property)) and not member.startswith("_"):
                check(value.__doc__, f"{name}.{member} has no docstring")


def main():
    check_documented()
    if not shutil.which("mypy"):
        skip("no mypy (Debian: mypy)")
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        check_types(folder)
    done()


if __name__ == "__main__":
    main()
