# SPDX-License-Identifier: Apache-2.0
"""Numbers to fixed point, as recordings are read: times a power of two, rounded half to even."""
import math


def fixed(value: float, fraction_bits: int, what: str, bits: int = 32) -> int:
    """`value` in 1/2**fraction_bits, as a signed integer of `bits` bits.

    Raises ValueError, which says `what`, where it is no finite number or does not fit.
    """
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"{what} is {number}, not a finite number")
    scaled = round(math.ldexp(number, fraction_bits))
    if not -(1 << (bits - 1)) <= scaled < 1 << (bits - 1):
        raise ValueError(f"{what} is {number}, which is out of range")
    return scaled
