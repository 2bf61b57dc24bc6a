# SPDX-License-Identifier: Apache-2.0
"""Which trim3r this is."""
from ._native import lib, text_of

__version__ = text_of(lib.t3r_version())
BITS_EPOCH: int = lib.T3R_BITS_EPOCH
