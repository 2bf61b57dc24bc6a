# SPDX-License-Identifier: Apache-2.0
"""What the tests of the library share: where things are, compilers, and the hash that every consumer must print."""
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
SERIES = VERSION.rpartition(".")[0] # what shared libraries and packages are named by
HEADS = ROOT / "quant" / "heads"
HASH = (HERE / "golden_hash.txt").read_text().strip()
FEATURES = ("comparison", "stereo", "streams", "learned", "refinement", "extras")
WARNINGS = ["-Wall", "-Wextra", "-Werror"]


def ended(*command, **options):
    """The command's end, whatever its status."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)


def there(*tools):
    """Whether these are on the path; says so where one is not."""
    missing = [tool for tool in tools if shutil.which(tool) is None]
    if missing:
        print(f"SKIPPED, no {' and no '.join(missing)} here (tools/setup --tests)")
    return not missing


def at_once(function, values):
    """function(value) of each, as many at once as there are processors."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(function, values))


def amalgamate(folder, seed="0"):
    """Writes trim3r.c and trim3r.h; what the script prints."""
    made = ended(sys.executable, "-B", ROOT / "tools" / "amalgamate", folder,
                 env={**os.environ, "PYTHONHASHSEED": seed})
    if made.returncode != 0:
        sys.exit(f"tools/amalgamate: {made.stdout}{made.stderr}")
    return made.stdout


def without(feature):
    """The compiler's word that leaves a feature out."""
    return f"-DT3R_FEATURE_{feature.upper()}=0"
