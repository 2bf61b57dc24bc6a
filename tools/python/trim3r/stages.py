# SPDX-License-Identifier: Apache-2.0
"""The stages and their hashes."""
import re
from typing import Mapping

from ._native import lib, text_of

_HASH = re.compile("[0-9a-fA-F]{16}")
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

    Raises
    ------
    ValueError
        A name is no stage's, or a hash has not 16 hexadecimal digits.
    """
    for stage, digits in hashes.items():
        if stage not in STAGES:
            raise ValueError(f"a stage is one of {', '.join(STAGES)}, not {stage!r}")
        if not isinstance(digits, str) or not _HASH.fullmatch(digits):
            raise ValueError(f"the hash of {stage} is 16 hexadecimal digits, not {digits!r}")
    value = 0xcbf29ce484222325
    for number, stage in enumerate(STAGES):
        if stage in hashes:
            for byte in bytes([number]) + int(hashes[stage], 16).to_bytes(8, "little"):
                value = (value ^ byte) * 0x100000001b3 & (1 << 64) - 1
    return f"{value:016x}"
