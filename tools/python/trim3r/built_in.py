# SPDX-License-Identifier: Apache-2.0
"""The built-in recording."""
from typing import List

import numpy as np

from ._native import address, ffi, lib
from .arguments import setting, whole
from .camera import Camera
from .frame import Frame


def room(frames: int = 6, width: int = 256, height: int = 256, seed: int = 1) -> List[Frame]:
    """Frames of a furnished room, as `trim3r room` records them: exact depth and poses, the same bits everywhere.

    Parameters
    ----------
    frames : int
        Their number, 1..1000, along an arc around the middle of the room.
    width, height : int
        Their size in pixels, 8..4096 each.
    seed : int
        Of textures and noise, 0..2**32 - 1.

    Returns
    -------
    list of Frame
        Colour as "rgb24"; depth in millimetres; lengths in metres.

    Raises
    ------
    ValueError
        A number is out of its range.
    """
    frames, seed = whole("frames", frames, 1, 1000), setting("seed", seed)
    width, height = setting("width", width), setting("height", height)
    made = []
    for index in range(frames):
        colour = np.empty((height, width, 3), dtype=np.uint8)
        depth = np.empty((height, width), dtype=np.uint16)
        camera = ffi.new("t3r_camera *")
        lib.room_frame(index, width, height, seed, address(colour, "uint8_t *"), address(depth, "uint16_t *"))
        lib.room_camera(index, width, height, camera)
        made.append(Frame(colour, Camera.from_native(camera), depth))
    return made
