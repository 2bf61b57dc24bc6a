# SPDX-License-Identifier: Apache-2.0
"""Gaussian heads by name: analytic, the shipped networks, files of weights."""
import os
from typing import Any, NamedTuple, Union

import numpy as np

from ._native import address, ffi, lib, text_of
from .image_stage import arena_of
from .errors import InputError

HeadName = Union[str, "os.PathLike[str]"]

_SHIPPED = {"tiny": (lib.t3r_head_tiny, lib.t3r_head_tiny_bytes), "small": (lib.t3r_head_small, lib.t3r_head_small_bytes)}
_ANALYTIC = "analytic"  # the head without weights
_BYTES_MOST = 1 << 24  # of a file of weights; one byte more is refused


class Head(NamedTuple):
    """A value of t3r_head and, of a network, its weights: a pointer, their bytes, and the array that holds them."""

    value: int
    weights: Any = ffi.NULL
    nbytes: int = 0
    owner: Any = None

    def column_bytes(self, width: int) -> int:
        """Working memory in bytes a column of a view of that width, as t3r_config.head_column_bytes has it."""
        if self.nbytes == 0:
            return 0
        needed = lib.t3r_head_column_bytes(self.weights, self.nbytes, width)
        return int(max(needed, lib.T3R_HEAD_COLUMN_BYTES))


def head_of(name: HeadName) -> Head:
    """The head of a name, or of a path that ends in .t3w.

    Raises
    ------
    InputError
        There is no such head, or the file holds no valid weights.
    OSError
        The file cannot be read.
    """
    text = os.fsdecode(name)
    if text == _ANALYTIC:
        return Head(lib.T3R_HEAD_ANALYTIC)
    if text in _SHIPPED:
        weights, count = _SHIPPED[text]
        return Head(lib.T3R_HEAD_LEARNED, ffi.cast("const void *", weights), count)
    if not text.endswith(".t3w"):
        raise InputError(f"a head is one of {', '.join([*_SHIPPED, _ANALYTIC])} or a file that ends in .t3w, not {text!r}")
    with open(text, "rb") as file:
        read = np.frombuffer(file.read(_BYTES_MOST + 1), dtype=np.uint8)
    owner = arena_of(read.nbytes) # aligned
    owner[:] = read
    head = Head(lib.T3R_HEAD_LEARNED, address(owner, "const void *"), owner.nbytes, owner)
    reason = lib.t3r_weights_error(head.weights, head.nbytes)
    if reason != ffi.NULL:
        raise InputError(f"{text}: {text_of(reason)}", "T3R_ERR_WEIGHTS")
    return head
