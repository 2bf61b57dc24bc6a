# SPDX-License-Identifier: Apache-2.0
"""Checks of arguments. Each refusal names the argument and its range."""
import errno
import math
import operator
import os
from typing import Any, Tuple, Union

import numpy as np

from ._native import lib
from ._settings import SETTINGS
from .errors import InputError

_TRUTH = (bool, np.bool_)
_SIDE_MOST: int = lib.T3R_MAX_SIDE
Path = Union[str, "os.PathLike[str]"]


def integer(name: str, value: Any) -> int:
    """`value` as an int. Raises TypeError unless it is an integer: True and 1.0 are none."""
    try:
        if not isinstance(value, _TRUTH):
            return operator.index(value)
    except TypeError:
        pass
    raise TypeError(f"{name} is an integer, not {value!r}")


def whole(name: str, value: Any, low: int, high: int, status: str = "") -> int:
    """`value` as an int of low..high. Raises TypeError as integer(), and InputError out of the range."""
    number = integer(name, value)
    if not low <= number <= high:
        raise InputError(f"{name} is {low}..{high}, not {number}", status)
    return number


def pair(name: str, value: Any) -> Tuple[Any, Any]:
    """Width and height. Raises TypeError unless `value` has two items."""
    try:
        width, height = value
    except (TypeError, ValueError):
        raise TypeError(f"{name} is a width and a height, not {value!r}") from None
    return width, height


def grid(name: str, value: Any) -> Tuple[int, int]:
    """Width and height of a picture in pixels, 1..4096. Raises as pair() and whole()."""
    width, height = pair(name, value)
    return (whole("width", width, 1, _SIDE_MOST, "T3R_ERR_CAMERA"),
            whole("height", height, 1, _SIDE_MOST, "T3R_ERR_CAMERA"))


def setting(name: str, value: Any) -> int:
    """The number of a setting, in its range. True and False are 1 and 0 for settings that are on or off."""
    kind, _, low, high = SETTINGS[name]
    return whole(name, int(value) if kind == "toggle" and isinstance(value, bool) else value, low, high, "T3R_ERR_CONFIG")


def real(name: str, value: Any) -> float:
    """`value` as a finite float. Raises TypeError unless it is a number, and InputError where it is not finite."""
    if isinstance(value, (*_TRUTH, str, bytes, complex, np.complexfloating)):
        raise TypeError(f"{name} is a number, not {value!r}")
    try:
        number = float(value)
    except OverflowError: # of an integer
        number = math.inf
    except TypeError:
        raise TypeError(f"{name} is a number, not {value!r}") from None
    if not math.isfinite(number):
        raise InputError(f"{name} is {number}, not a finite number")
    return number


def fixed(value: Any, fraction_bits: int, name: str, bits: int = 32) -> int:
    """`value` in 1/2**fraction_bits, rounded half to even, as a signed integer of `bits` bits.

    Raises TypeError unless it is a number, and InputError where it is not finite or does not fit.
    """
    number = real(name, value)
    most = math.ldexp(1, bits - 1 - fraction_bits)
    scaled = round(math.ldexp(number, fraction_bits)) if abs(number) <= most else 1 << bits
    if not -(1 << (bits - 1)) <= scaled < 1 << (bits - 1):
        raise InputError(f"{name} is {-most:g} to {most:g}, not {number}: it is out of range")
    return scaled


def path_bytes(path: Path) -> bytes:
    """The path as the system takes it. Raises ValueError for one with a zero byte, as open() does."""
    encoded = os.fsencode(path)
    if b"\0" in encoded:
        raise ValueError("embedded null byte")
    return encoded


def readable(path: Path) -> bytes:
    """The path of a file that can be opened. Raises OSError where it cannot, and IsADirectoryError for a folder."""
    encoded = path_bytes(path)
    if os.path.isdir(encoded):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), os.fsdecode(encoded))
    os.close(os.open(os.fsdecode(encoded), os.O_RDONLY | os.O_NONBLOCK))
    return encoded
