# SPDX-License-Identifier: Apache-2.0
"""Frames: one captured instant as arrays, passed to the library without a copy."""
import dataclasses
from typing import Any, Optional, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ._native import address, ffi, lib, value_named
from .arguments import real
from .camera import Camera
from .errors import InputError
from .png import png_of

_CHANNELS = {"rgb24": 3, "bgr24": 3, "grey": 1, "yuyv": 2, "uyvy": 2, "nv12": 1}
_STEPS_MOST = 65535
_STRIDE_LIMIT = 1 << 19  # bytes; the limit of the distance of rows

Colour = Union["NDArray[np.uint8]", Tuple["NDArray[np.uint8]", "NDArray[np.uint8]"]]


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Frame:
    """One captured instant. Its arrays are the caller's: they are borrowed, never copied or changed.

    Rows may lie apart (a crop of a larger picture, every second row), but the pixels of a row must follow one another.
    Pixels are read during the call that takes the frame, and not before or after it. A notebook shows the colours.

    Attributes
    ----------
    colour : ndarray of uint8, shape (H, W, 3), (H, W, 2) or (H, W)
        The picture: (H, W, 3) of "rgb24" and "bgr24"; (H, W, 2) of "yuyv" and "uyvy"; (H, W) of "grey". Of "nv12" a
        pair: Y of (H, W), and U and V of (H / 2, W / 2, 2). Sides are 2..4096.
    camera : Camera, optional
        For the pixel grid of `colour`. None: not known.
    depth : ndarray of uint16, float32 or float64, shape (h, w), optional
        Depth along z, registered to the colour; its size may differ. uint16: steps of `depth_unit`, 0 = not measured.
        Floats are world units; they become steps in a copy, and what is not a positive number is not measured, nor is
        what is beyond 65535 steps. If half of them are, the frame is refused: they may be millimetres.
    depth_unit : float
        The length of a step of depth in world units; 0.001 is a millimetre.
    format : str
        "rgb24", "bgr24", "grey", "yuyv", "uyvy" or "nv12".
    """

    colour: Colour
    camera: Optional[Camera] = None
    depth: Optional["NDArray[Any]"] = None
    depth_unit: float = 0.001
    format: str = "rgb24"

    @property
    def size(self) -> Tuple[int, int]:
        """Width and height of the colour picture in pixels."""
        plane = self.colour[0] if isinstance(self.colour, tuple) else self.colour
        return plane.shape[1], plane.shape[0]

    def __repr__(self) -> str:
        depth = self.depth
        measured = "" if depth is None else f", depth {depth.shape[1]}x{depth.shape[0]} of {depth.dtype}"
        return (f"<Frame: {self.size[0]}x{self.size[1]} {self.format}{measured}, "
                f"{'no' if self.camera is None else 'a'} camera>")

    def _repr_png_(self) -> bytes:
        if isinstance(self.colour, tuple): # nv12: its luma
            return png_of(self.colour[0])
        if self.format in ("yuyv", "uyvy"):
            return png_of(self.colour[..., 0 if self.format == "yuyv" else 1])
        return png_of(self.colour[..., ::-1] if self.format == "bgr24" else self.colour)

    def native(self) -> Tuple[Any, Any]:
        """A t3r_frame and what must outlive its use.

        Raises ValueError where an array has another type, shape or layout than it must have.
        """
        return self._native(1)

    def native_strip(self, height: int, depth_height: int) -> Tuple[Any, Any]:
        """The same of a frame with so many rows of colour and of depth, of which the arrays hold some, or none."""
        frame, kept = self._native(0)
        frame.height, frame.depth_height = height, depth_height
        return frame, kept

    def _native(self, least_rows: int) -> Tuple[Any, Any]:
        frame = ffi.new("t3r_frame *")
        frame.format = value_named("format", lib.t3r_pixel_format_name, lib.T3R_PIXEL_FORMAT_COUNT, self.format)
        kept = [self._put_colour(frame, least_rows)]
        if self.depth is not None:
            kept.append(self._put_depth(frame, self.depth, least_rows))
        return frame, kept

    def _put_colour(self, frame: Any, least_rows: int) -> Any:
        planes = self.colour if isinstance(self.colour, tuple) else (self.colour,)
        if len(planes) != (2 if self.format == "nv12" else 1):
            raise ValueError("colour is a pair of arrays with the format nv12, and one array with any other")
        for i, plane in enumerate(planes):
            channels = 2 if i == 1 else _CHANNELS[self.format]
            check_plane(f"colour of {self.format}", plane, np.dtype(np.uint8), channels, least_rows)
            frame.planes[i] = address(plane, "const uint8_t *")
            frame.stride_bytes[i] = plane.strides[0]
        frame.height, frame.width = planes[0].shape[:2]
        if len(planes) == 2 and planes[1].shape[:2] != (frame.height // 2, frame.width // 2):
            raise ValueError(f"the second plane of nv12 has half the sides of the first, not {planes[1].shape}")
        return planes

    def _put_depth(self, frame: Any, depth: "NDArray[Any]", least_rows: int) -> Any:
        steps = _steps(depth, self.depth_unit) if _is_float(depth) else depth
        check_plane("depth", steps, np.dtype("<u2"), 1, least_rows)
        frame.depth = address(steps, "const uint8_t *")
        frame.depth_height, frame.depth_width = steps.shape
        frame.depth_stride_bytes = steps.strides[0]
        frame.depth_unit_q40 = _unit_q40(self.depth_unit)
        return steps


def _is_float(array: Any) -> bool:
    return isinstance(array, np.ndarray) and array.dtype.kind == "f"


def _unit_q40(unit: float) -> int:
    length = real("depth_unit", unit)
    unit_q40 = round(length * 2**40) if 0 < length < 128 else 0
    if unit_q40 < 1:
        raise InputError(f"depth_unit is 2**-40 to 128, not {length}: it is out of range", "T3R_ERR_FRAME")
    return unit_q40


def _steps(depth: "NDArray[Any]", unit: float) -> "NDArray[np.uint16]":
    """Depth in world units as whole steps, 0 where there is none or it is out of range."""
    _unit_q40(unit)
    with np.errstate(all="ignore"):
        steps = np.rint(depth.astype(np.float64) / unit)
        measured = np.isfinite(steps) & (steps >= 1)
        far = measured & (steps > _STEPS_MOST)
    if 2 * np.count_nonzero(far) > np.count_nonzero(measured):
        raise InputError(
            f"depth in floats is in world units, and half of it is {np.median(depth[measured]):g} or more, beyond the "
            f"{_STEPS_MOST * unit:g} that 16 bits hold with depth_unit={unit:g}. Millimetres? Divide by 1000 for metres, "
            "or pass uint16. Or take a larger depth_unit", "T3R_ERR_FRAME")
    return np.where(measured & ~far, steps, 0).astype("<u2")


def check_plane(what: str, array: Any, dtype: "np.dtype[Any]", channels: int, least_rows: int = 1) -> None:
    """Raises ValueError unless the array is a picture of that type whose rows have no gaps inside."""
    if not isinstance(array, np.ndarray):
        raise ValueError(f"{what} is a {type(array).__name__}, not an array")
    if array.dtype != dtype:
        remedy = ": of floats 0..1 take (255 * x).round().astype('uint8')" if array.dtype.kind == "f" else ""
        raise ValueError(f"{what} has elements of {array.dtype}, not {dtype.name}{remedy}")
    wanted = "(H, W)" if channels == 1 else f"(H, W, {channels})"
    if array.ndim != (2 if channels == 1 else 3) or (channels > 1 and array.shape[2] != channels):
        remedy = ": numpy.ascontiguousarray(x[..., :3]) drops alpha" if channels == 3 and array.shape[2:] == (4,) else ""
        raise ValueError(f"{what} has the shape {array.shape}, not {wanted}{remedy}")
    sides = array.shape[:2]
    if not all(least <= side <= lib.T3R_MAX_SIDE for least, side in zip((least_rows, 1), sides)):
        raise ValueError(f"{what} has the shape {array.shape}: its sides are not 1..{lib.T3R_MAX_SIDE}")
    pixel = channels * dtype.itemsize
    inside = (pixel,) if channels == 1 else (pixel, dtype.itemsize)
    if array.strides[1:] != inside or not pixel * sides[1] <= array.strides[0] < _STRIDE_LIMIT:
        raise ValueError(f"the pixels of a row of {what} do not follow one another in memory, or its rows overlap, run "
                         f"upwards or lie {_STRIDE_LIMIT} bytes apart: numpy.ascontiguousarray() makes a copy")
