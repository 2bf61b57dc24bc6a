# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder."""
import importlib.util
import os
import sys

from checks import check, done, near, run, skip  # noqa: F401


def need_numpy():
    try:
        import cv2
        import numpy
    except ImportError as error:
        skip(str(error))
    return numpy, cv2


def load_scorer(path):
    """Returns score.py as a module, or None if it is not there."""
    if not os.path.exists(path):
        return None
    sys.dont_write_bytecode = True
    spec = importlib.util.spec_from_file_location("score", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
