#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""example.py LIBRARY: the example runs, prints the text in docs/python.md, and draws its charts."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from common import PACKAGE, ROOT, check, skip

from checks import done, near

try:
    import matplotlib as _
except ImportError:
    skip("no matplotlib (Debian: python3-matplotlib)")

ROW = re.compile(r"^ *([\d.]+) % +(\d+) Gaussians +([\d.]+) dB +SSIM ([\d.]+)", re.M)


def main():
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        environment = {**os.environ, "PYTHONPATH": str(PACKAGE.parent), "MPLCONFIGDIR": folder, "MPLBACKEND": "Agg"}
        ended = subprocess.run([sys.executable, "-B", ROOT / "tools" / "python" / "examples" / "room.py"], cwd=folder,
                               env=environment, capture_output=True, text=True, check=False)
        check(ended.returncode == 0, ended.stdout + ended.stderr)
        rows = [tuple(map(float, row)) for row in ROW.findall(ended.stdout)]
        check(len(rows) >= 5, f"a line a budget: {ended.stdout}")
        for (keep, count, psnr, _), (more_keep, more_count, _, _) in zip(rows, rows[1:]):
            near(count / keep, more_count / more_keep, 0.05 * count / keep, "a budget is its share of the points")
            check(20 < psnr < 45, f"{psnr} dB")
        check(max(rows)[2] > min(rows)[2] + 1, "a tenth of the Gaussians costs more than a decibel")
        shown = re.search(r"^trim3r [\d.]+: .*?(?=^\.\.\.)", (ROOT / "docs" / "python.md").read_text(), re.M | re.S)[0]
        check(ended.stdout.startswith(shown), f"the page shows\n{shown}and it prints\n{ended.stdout}")
        for name in ("budgets.png", "views.png"):
            picture = (pathlib.Path(folder) / name).read_bytes()
            check(picture[:8] == b"\x89PNG\r\n\x1a\n" and len(picture) > 10000, f"{name}: {len(picture)} bytes")
        check((pathlib.Path(folder) / "room.ply").read_bytes().startswith(b"ply\n"), "the scene")
    done()


if __name__ == "__main__":
    main()
