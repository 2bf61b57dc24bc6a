# SPDX-License-Identifier: Apache-2.0
"""trim3r: posed colour and depth frames to a budgeted set of 3-D Gaussians, and views drawn of them.

The work is that of the C library, in integers, with the same bits on every processor. Arrays of pixels are handed to it
where they lie. A first scene::

    import trim3r

    frames = trim3r.room()                                    # six frames of a built-in room
    with trim3r.Reconstructor(256, 256, views=2, head="small") as room:
        room.add_view(frames[0])
        room.add_view(frames[2])
        scene = room.build(keep=10)                           # a tenth of the points
        print(trim3r.psnr(frames[1].colour, room.render(frames[1].camera)))
        scene.save("scene.ply")

Conventions are those of trim3r.h: pixel (0, 0) is the centre of the top-left pixel; cameras look along +z, with x to
the right and y down; poses are camera-to-world; lengths are in world units, metres where the source has metres.
"""
from .built_in import room
from .camera import Camera
from .configuration import Settings, preset
from .errors import Cancelled, DepthError, InputError, StateError, Trim3rError, UnsupportedError
from .evaluation import Row, evaluate
from .frame import Frame
from .image_stage import develop
from .measures import flip, psnr, sharp, ssim
from .picture import Picture
from .reconstructor import Reconstructor
from .recording import Recording, Triplet
from .scene import Scene
from .scene_arrays import Arrays
from .stages import STAGES, run_hash
from .stream import Report, Stream
from .version import BITS_EPOCH, __version__

__all__ = [
    "BITS_EPOCH", "STAGES", "Arrays", "Camera", "Cancelled", "DepthError", "Frame", "InputError", "Picture", "Reconstructor",
    "Recording", "Report", "Row", "Scene", "Settings", "StateError", "Stream", "Trim3rError", "Triplet", "UnsupportedError",
    "__version__", "develop", "evaluate", "flip", "preset", "psnr", "room", "run_hash", "sharp", "ssim",
]
