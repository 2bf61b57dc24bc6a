# SPDX-License-Identifier: Apache-2.0
"""The image stage alone."""
from typing import Any

import numpy as np

from ._native import INTERFACE, address, called, ffi, lib
from .arguments import setting
from .camera import Camera
from .errors import InputError
from .frame import Frame


def arena_of(plan_bytes: int) -> "np.ndarray[Any, np.dtype[np.uint8]]":
    """So many bytes, aligned as the library wants them."""
    room = np.empty(plan_bytes + lib.T3R_ARENA_ALIGN, dtype=np.uint8)
    start = -room.__array_interface__["data"][0] % lib.T3R_ARENA_ALIGN
    return room[start:start + plan_bytes]


def default_config(width: int, height: int, views: int, gaussians: int) -> Any:
    """A t3r_config of defaults. Raises InputError where a number is out of its range."""
    config = ffi.new("t3r_config *")
    called("t3r_default_config_as", INTERFACE, config, ffi.sizeof("t3r_config"), setting("width", width),
           setting("height", height), setting("views", views), setting("gaussians", gaussians))
    return config


def camera_of(frame: Frame) -> Camera:
    """The frame's camera. Raises InputError where it has none."""
    if frame.camera is None:
        raise InputError("the frame has no camera", "T3R_ERR_CAMERA")
    return frame.camera


def develop(frame: Frame, width: int, height: int) -> Frame:
    """A frame as the image stage makes it of `frame`: resized and undistorted, as a view of that size is.

    Parameters
    ----------
    frame : Frame
        With a camera.
    width, height : int
        The working size in pixels, 8..4096 each.

    Returns
    -------
    Frame
        Colour as "rgb24", uint8 of (height, width, 3). Depth in steps of the frame's own unit, uint16 of (height,
        width), or None where it has none. The camera has no distortion.

    Raises
    ------
    ValueError
        The frame, its camera or the size cannot be used.
    """
    config = default_config(width, height, 1, 1)
    plan, runtime, undistorted = ffi.new("t3r_plan_info *"), ffi.new("t3r_runtime **"), ffi.new("t3r_camera *")
    called("t3r_plan_as", INTERFACE, config, plan, what=f"a size of {width}x{height}")
    arena = arena_of(plan.min_bytes)
    called("t3r_init_as", INTERFACE, runtime, address(arena, "void *"), arena.nbytes, config)
    lib.t3r_set_cpu(runtime[0], lib.t3r_cpu_features())
    colour = np.empty((height, width, 3), dtype=np.uint8)
    depth = None if frame.depth is None else np.empty((height, width), dtype="<u2")
    native, kept = frame.native()
    steps = ffi.NULL if depth is None else address(depth, "uint16_t *")
    called("t3r_develop", runtime[0], native, camera_of(frame).native(frame.size), address(colour, "uint8_t *"), steps,
           undistorted)
    del kept
    return Frame(colour, Camera.from_native(undistorted), depth, frame.depth_unit)
