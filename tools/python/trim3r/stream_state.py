# SPDX-License-Identifier: Apache-2.0
"""Files of a stream's state: its last report, the bytes of its arena, and a CRC-32 of both."""
import struct
import zlib
from typing import Any, Tuple

import numpy as np

from ._native import INTERFACE, ffi
from .errors import InputError

_MAGIC = b"T3RSTREA"
_HEAD = struct.Struct("=8sQ")  # magic, interface
_CHECK = struct.Struct("=I")
_REPORT_BYTES = ffi.sizeof("t3r_stream_report")


def state_of(report: Any, arena: "np.ndarray[Any, np.dtype[np.uint8]]") -> bytes:
    """The bytes of a file. `report` is a t3r_stream_report, of zeros without one."""
    state = _HEAD.pack(_MAGIC, INTERFACE) + bytes(ffi.buffer(report)) + arena.tobytes()
    return state + _CHECK.pack(zlib.crc32(state))


def read_state(state: bytes, name: str) -> Tuple[Any, "np.ndarray[Any, np.dtype[np.uint8]]"]:
    """The report and the arena of a file. Raises InputError where it is none, of another version, or damaged."""
    if not state.startswith(_MAGIC) or len(state) < _HEAD.size:
        raise InputError(f"{name}: not the state of a stream")
    if _HEAD.unpack_from(state)[1] != INTERFACE:
        raise InputError(f"{name}: saved by another version of trim3r: begin a new map", "T3R_ERR_EPOCH")
    body, check = state[:-_CHECK.size], state[-_CHECK.size:]
    if len(body) < _HEAD.size + _REPORT_BYTES or _CHECK.pack(zlib.crc32(body)) != check:
        raise InputError(f"{name}: the state is damaged or cut off")
    report = ffi.new("t3r_stream_report *")
    ffi.memmove(report, body[_HEAD.size:], _REPORT_BYTES)
    return report, np.frombuffer(body, dtype=np.uint8, offset=_HEAD.size + _REPORT_BYTES)
