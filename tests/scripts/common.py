# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder."""

from checks import check, done, near, run, skip  # noqa: F401


def need_opencv():
    try:
        import cv2  # noqa: F401
        import numpy  # noqa: F401
    except ImportError as error:
        skip(str(error))
