# SPDX-License-Identifier: Apache-2.0
"""Shared by the tests of the library: paths, compilers, and the hash that every consumer must print."""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "proofs"))

CONSUMERS = HERE / "consumers"
VERSION = ".".join(re.findall(r"#define T3R_VERSION_\w+ (\d+)", (ROOT / "runtime/include/trim3r.h").read_text()))
SERIES = VERSION.rpartition(".")[0] # version part in the names of shared libraries and packages
HEADS = ROOT / "quant" / "heads"
HASH = (HERE / "golden_hash.txt").read_text().strip()
FEATURES = ("comparison", "stereo", "streams", "learned", "refinement", "extras", "backdrop")
WARNINGS = ["-Wall", "-Wextra", "-Wshadow", "-Werror"]


def ended(*command, **options):
    """Runs the command to its end, whatever its status."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)


def there(*tools):
    """Whether these are on the path; otherwise prints the missing ones."""
    missing = [tool for tool in tools if shutil.which(tool) is None]
    if missing:
        print(f"SKIPPED, no {' and no '.join(missing)} here (tools/setup --tests)")
    return not missing


def at_once(function, values):
    """Returns function(value) of each, with one thread per processor."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(function, values))


def amalgamate(folder, seed="0"):
    """Writes trim3r.c and trim3r.h; returns the script's output."""
    made = ended(sys.executable, "-B", ROOT / "tools" / "amalgamate", folder,
                 env={**os.environ, "PYTHONHASHSEED": seed})
    if made.returncode != 0:
        sys.exit(f"tools/amalgamate: {made.stdout}{made.stderr}")
    return made.stdout


def without(feature):
    """Returns the compiler's argument that omits a feature."""
    return f"-DT3R_FEATURE_{feature.upper()}=0"
