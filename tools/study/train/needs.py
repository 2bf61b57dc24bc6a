# SPDX-License-Identifier: Apache-2.0
"""Import this first: it ends with status 77 and names the package if one of the training is missing."""
import importlib.util
import sys

PACKAGES = {
    "torch": "python3-torch",
    "cv2": "python3-opencv",
    "matplotlib": "python3-matplotlib",
    "numpy": "python3-numpy",
}
missing = [debian for name, debian in PACKAGES.items() if importlib.util.find_spec(name) is None]
if missing:
    print(f"SKIPPED: {sys.executable} lacks what Debian calls {', '.join(missing)}", file=sys.stderr)
    sys.exit(77)
