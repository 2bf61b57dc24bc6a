# SPDX-License-Identifier: Apache-2.0
"""Exceptions of the package."""
from typing import Dict, Type


class Trim3rError(Exception):
    """The library refused a call. `status` is the name of its t3r_status, "T3R_ERR_CAMERA" say."""

    def __init__(self, text: str, status: str = "") -> None:
        super().__init__(text)
        self.status = status


class InputError(Trim3rError, ValueError):
    """A frame, a camera, a setting, a file of weights or of frames that cannot be used."""


class DepthError(InputError):
    """No depth: a frame has none, or no two views can be matched."""


class StateError(Trim3rError, RuntimeError):
    """A call that does not fit the state: no views yet, no room for another, closed, or at work."""


class Cancelled(Trim3rError):
    """A progress callback may raise it to stop the work; the call that it stops raises it again."""


class UnsupportedError(Trim3rError, NotImplementedError):
    """The library was built without the requested feature."""


_OF_STATUS: Dict[str, Type[Trim3rError]] = {
    "T3R_ERR_STATE": StateError,
    "T3R_ERR_FULL": StateError,
    "T3R_ERR_NO_DEPTH": DepthError,
    "T3R_ERR_STEREO": DepthError,
    "T3R_ERR_CANCELLED": Cancelled,
    "T3R_ERR_UNSUPPORTED": UnsupportedError,
}


def error_of(status: str, text: str) -> Trim3rError:
    """The exception of a t3r_status by its name."""
    return _OF_STATUS.get(status, InputError)(text, status)
