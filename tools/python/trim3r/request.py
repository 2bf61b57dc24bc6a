# SPDX-License-Identifier: Apache-2.0
"""Requests: what one build shall be."""
from typing import Any, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from ._native import address, ffi
from .arguments import real
from .configuration import setting_value

Importance = Sequence["NDArray[np.uint16]"]
_LOSS_MOST = 10  # dB


def request_of(config: Any, views: int, gaussians: int, max_loss: float, allocate: Optional[str],
               importance: Optional[Importance]) -> Tuple[Any, Any]:
    """A t3r_request for so many views, and what must outlive its use; 0 and None leave the configuration's value.

    Raises ValueError where a field is out of its range.
    """
    if not 0 <= real("max_loss", max_loss) <= _LOSS_MOST:
        raise ValueError(f"max_loss is 0..{_LOSS_MOST} dB, not {max_loss}")
    request = ffi.new("t3r_request *", {"gaussians": gaussians, "max_loss_q8": round(max_loss * 256)})
    if allocate is not None:
        request.allocate = setting_value("allocate", allocate)
    if importance is None:
        return request, None
    planes = [np.ascontiguousarray(plane) for plane in importance]
    shape = (config.height, config.width)
    if len(planes) != views or any(plane.dtype != np.uint16 or plane.shape != shape for plane in planes):
        raise ValueError(f"importance is a plane of uint16 with the shape {shape} for each of the {views} views")
    pointers = ffi.new("const uint16_t *[]", [address(plane, "const uint16_t *") for plane in planes])
    request.importance, request.importance_stride_bytes = pointers, config.width * 2
    return request, (planes, pointers)
