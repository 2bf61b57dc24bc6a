# SPDX-License-Identifier: Apache-2.0
"""Shared by the tests of the Python package: the package itself, as built."""
import contextlib
import pathlib
import sys

from checks import check, skip

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PACKAGE = pathlib.Path(sys.argv[1]).resolve().parent # the folder of the shared library, which is the first argument

sys.dont_write_bytecode = True
sys.path[:0] = [str(PACKAGE.parent)]
try:
    import _cffi_backend as _
    import numpy as np
except ImportError as error:
    skip(f"no {error.name} (Debian: python3-cffi, python3-numpy)")

import trim3r

SIDE = 64
FRAMES = trim3r.room(3, SIDE, SIDE)


def small(views=2, **options):
    """Returns a reconstructor of small views, quick to build."""
    return trim3r.Reconstructor(SIDE, SIDE, views=views, **{"head": "tiny", **options})


def with_views(frames=(FRAMES[0], FRAMES[2]), **options):
    """Returns a reconstructor with these views added."""
    made = small(len(frames), **options)
    for frame in frames:
        made.add_view(frame)
    return made


@contextlib.contextmanager
def refused(kind, *words):
    """Expects an error of that kind from the block, with these words in its text."""
    try:
        yield
    except kind as error:
        for word in words:
            check(word in str(error), f"{error!r} does not say {word!r}")
        return
    check(False, f"no {kind.__name__} with {words}")
