# SPDX-License-Identifier: Apache-2.0
"""Recordings: MCAP files of ROS 2 messages."""
import os
from typing import Any, Iterator, List, NamedTuple, Tuple

import numpy as np

from ._native import ERROR_BYTES, borrowed, ffi, lib, text_of
from .arguments import Path, integer, readable
from .camera import Camera
from .errors import InputError
from .frame import Colour, Frame

_BYTE = np.dtype(np.uint8)


class Triplet(NamedTuple):
    """Context frames and the frame to be drawn, by their numbers."""

    context: Tuple[int, int]
    target: int


class Recording:
    """The frames of an `.mcap` file, in their order.

    `len()` is their number, and `recording[i]` is a frame: its arrays lie in the recording's memory, read-only. They
    stay valid as long as any of them is there, also after the recording itself is gone. From several threads at the
    same time use a recording each. A pickled one is the path: it is opened again.

    Parameters
    ----------
    path : str or path-like
        The file. One that was cut off is read up to its last whole message; `note` then says so.

    Raises
    ------
    OSError
        The file cannot be opened.
    InputError
        It is no recording; the text says what is wrong, and at which byte.
    """

    def __init__(self, path: Path) -> None:
        error = ffi.new("char[]", ERROR_BYTES)
        opened = lib.t3r_recording_open(readable(path), error, ERROR_BYTES)
        if opened == ffi.NULL:
            raise InputError(text_of(error))
        self._recording = ffi.gc(opened, lib.t3r_recording_close)
        self._path = os.path.abspath(os.fsdecode(path))

    def __reduce__(self) -> Tuple[Any, ...]:
        return Recording, (self._path,)

    def __repr__(self) -> str:
        return f"<Recording: {self._path}, {len(self)} frames>"

    def __len__(self) -> int:
        return int(lib.t3r_recording_frame_count(self._recording))

    def __getitem__(self, index: int) -> Frame:
        """Frame `index`, from the end where it is negative. Its camera is None without a pose or intrinsics.

        Raises
        ------
        IndexError
            There is no such frame.
        InputError
            The frame cannot be read.
        """
        count, index = len(self), integer("index", index)
        if not -count <= index < count:
            raise IndexError(f"the recording has {count} frames, none with the number {index}")
        captured, error = ffi.new("t3r_capture_frame *"), ffi.new("char[]", ERROR_BYTES)
        if lib.t3r_recording_frame(self._recording, index % count, captured, error, ERROR_BYTES) != lib.T3R_CAPTURE_FRAME:
            raise InputError(f"frame {index}: {text_of(error)}")
        native = captured.frame
        camera = Camera.from_native(captured.camera) if captured.has_pose and captured.has_intrinsics else None
        return Frame(self._colour(native), camera, self._depth(native), native.depth_unit_q40 / (1 << 40),
                     text_of(lib.t3r_pixel_format_name(native.format)))

    def __iter__(self) -> Iterator[Frame]:
        return (self[index] for index in range(len(self)))

    @property
    def triplets(self) -> List[Triplet]:
        """Good choices of context and target that the recording carries."""
        found = (lib.t3r_recording_triplet(self._recording, i)
                 for i in range(lib.t3r_recording_triplet_count(self._recording)))
        return [Triplet((t.context[0], t.context[1]), t.target) for t in found]

    @property
    def note(self) -> str:
        """"" or a remark, such as "cut off after 12 of its messages"."""
        return text_of(lib.t3r_recording_note(self._recording))

    def _rows(self, pointer: Any, height: int, row_bytes: int, stride: int) -> "np.ndarray[Any, Any]":
        """Returns the bytes of `height` rows, `stride` bytes apart."""
        flat = borrowed(pointer, stride * (height - 1) + row_bytes, self._recording, _BYTE)
        return np.lib.stride_tricks.as_strided(flat, (height, row_bytes), (stride, 1), writeable=False)

    def _colour(self, frame: Any) -> Colour:
        height, width = frame.height, frame.width
        channels = {lib.T3R_PIXEL_RGB24: 3, lib.T3R_PIXEL_BGR24: 3, lib.T3R_PIXEL_YUYV: 2, lib.T3R_PIXEL_UYVY: 2}
        count = channels.get(frame.format, 1)
        rows = self._rows(frame.planes[0], height, width * count, frame.stride_bytes[0])
        if frame.format == lib.T3R_PIXEL_NV12:
            chroma = self._rows(frame.planes[1], height // 2, width, frame.stride_bytes[1])
            return rows, chroma.reshape(height // 2, width // 2, 2)
        return rows if count == 1 else rows.reshape(height, width, count)

    def _depth(self, frame: Any) -> Any:
        if frame.depth == ffi.NULL:
            return None
        return self._rows(frame.depth, frame.depth_height, frame.depth_width * 2, frame.depth_stride_bytes).view("<u2")
