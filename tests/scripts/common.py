# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from checks import check, done, near, run, skip  # noqa: E402, F401


def need_opencv():
    try:
        import cv2  # noqa: F401
        import numpy  # noqa: F401
    except ImportError as error:
        skip(str(error))
