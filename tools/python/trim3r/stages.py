# SPDX-License-Identifier: Apache-2.0
"""The stages and their hashes."""
from typing import Mapping

from ._native import lib, text_of

STAGES = tuple(text_of(lib.t3r_stage_name(stage)) for stage in range(lib.T3R_STAGE_COUNT))


def run_hash(hashes: Mapping[str, str]) -> str:
    """One hash for the stages of a run: what `trim3r build --json` calls `hash`.

    Parameters
    ----------
    hashes : mapping of str to str
        16 hexadecimal digits by the names of stages, as Reconstructor.stage_hashes has them.

    Returns
    -------
    str
        16 hexadecimal digits: FNV-1a of 64 bits over each stage's number and hash, little-endian, in their order.
    """
    value = 0xcbf29ce484222325
    for number, stage in enumerate(STAGES):
        if stage in hashes:
            for byte in bytes([number]) + int(hashes[stage], 16).to_bytes(8, "little"):
                value = (value ^ byte) * 0x100000001b3 & (1 << 64) - 1
    return f"{value:016x}"
