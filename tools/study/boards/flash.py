# SPDX-License-Identifier: Apache-2.0
"""The use of a Cortex-M7's flash by small firmwares."""
import argparse
import concurrent.futures
import os

from cortex_m import firmware_of, flash_of, start
from firmware import words

BOARD = "mps2-an500"
# Contents, head, context views, features, and the most bytes of flash.
FIRMWARES = (("one view, `analytic`", "analytic", 1, (), 48 << 10),
             ("one view, `tiny`, refinement", "tiny", 1, ("learned", "refinement"), 80 << 10),
             ("one view, `small`, refinement", "small", 1, ("learned", "refinement"), 110 << 10),
             ("two views, `tiny`, refinement", "tiny", 2, ("learned", "refinement", "comparison"), None))


def measure(path, options, host):
    """Measures a row for each; host(path, options) returns this machine's hash and its stages' hashes."""
    def row(firmware):
        name, head, views, features, limit = firmware
        chosen = argparse.Namespace(**{**vars(options), "head": head, "views": views, "features": features, "lto": True,
                                       "optimize": "-Os", "refine": 2 if "refinement" in features else 0})
        elf = firmware_of(BOARD, chosen)
        said = start(BOARD, elf, [*words(path, chosen), "hashes=1"])
        return {"name": name, "features": features, "flash_bytes": flash_of(elf), "limit_bytes": limit,
                "bits": "same" if said["hash final"] == host(path, chosen)[0] else "different"}

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(row, FIRMWARES))


def lines(rows):
    """Returns the table's lines, starting with its head."""
    return [["firmware", "features", "flash, bytes", "at most"],
            *([row["name"], ", ".join(row["features"]) or "none", f"{row['flash_bytes']:,}",
               f"{row['limit_bytes']:,}" if row["limit_bytes"] else ""] for row in rows)]
