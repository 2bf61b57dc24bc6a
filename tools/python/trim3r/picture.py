# SPDX-License-Identifier: Apache-2.0
"""Pictures: a scene as a camera sees it."""
import dataclasses
from typing import Any, Dict

import numpy as np
from numpy.typing import NDArray

from ._native import address, ffi
from .png import png_of


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Picture:
    """A view of a scene, drawn. numpy.asarray(picture) is `colour`, without a copy, and a notebook shows it.

    Attributes
    ----------
    colour : ndarray of uint8, shape (H, W, 3)
        Red, green and blue over black.
    depth_q20 : ndarray of uint32, shape (H, W)
        Depth along z in scene units, in 1/2**20, where transmittance falls below 1/2; 0 = there is none.
    alpha_q15 : ndarray of uint16, shape (H, W)
        1 - transmittance, 0..32767, in 1/2**15.
    exponent : int
        A scene unit is 2**exponent world units.
    """

    colour: "NDArray[np.uint8]"
    depth_q20: "NDArray[np.uint32]"
    alpha_q15: "NDArray[np.uint16]"
    exponent: int

    @property
    def depth(self) -> "NDArray[np.float64]":
        """Depth along z in world units, (H, W); 0 = there is none."""
        return np.ldexp(self.depth_q20.astype(np.float64), self.exponent - 20)

    @property
    def alpha(self) -> "NDArray[np.float32]":
        """1 - transmittance, 0 up to, but not including, 1, (H, W)."""
        return self.alpha_q15.astype(np.float32) / np.float32(1 << 15)

    @property
    def __array_interface__(self) -> Dict[str, Any]:
        return self.colour.__array_interface__

    def __repr__(self) -> str:
        height, width = self.colour.shape[:2]
        return f"<Picture: {width}x{height}, {100 * float(np.mean(self.alpha)):.1f} % covered>"

    def _repr_png_(self) -> bytes:
        return png_of(self.colour)


def target_of(colour: "NDArray[np.uint8]") -> Any:
    """A t3r_target that draws colours into the array, which must outlive its use."""
    return ffi.new("t3r_target *", {"width": colour.shape[1], "height": colour.shape[0],
                                    "rgb": address(colour, "uint8_t *"), "rgb_stride_bytes": colour.strides[0]})


def put_planes(target: Any, depth_q20: "NDArray[np.uint32]", alpha_q15: "NDArray[np.uint16]") -> None:
    """Has depth and alpha drawn, too."""
    target.depth_q20, target.depth_stride_bytes = address(depth_q20, "uint32_t *"), depth_q20.strides[0]
    target.alpha_q15, target.alpha_stride_bytes = address(alpha_q15, "uint16_t *"), alpha_q15.strides[0]
