# SPDX-License-Identifier: Apache-2.0
"""The version of trim3r."""
from ._native import lib, text_of

__version__ = text_of(lib.t3r_version())
BITS_EPOCH: int = lib.T3R_BITS_EPOCH
