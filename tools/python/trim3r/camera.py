# SPDX-License-Identifier: Apache-2.0
"""Cameras: intrinsics, lens and pose."""
import dataclasses
from typing import Any, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._native import HOST, address, ffi, host_called, lib
from .arguments import fixed, grid, whole
from .errors import InputError

_LENSES = {"none": lib.T3R_DISTORTION_NONE, "radtan": lib.T3R_DISTORTION_RADTAN,
           "fisheye": lib.T3R_DISTORTION_FISHEYE}
_COEFFICIENTS = {"none": 0, "radtan": 5, "fisheye": 4}
# Each field of integers: the count (0: one, alone), and the bits of each.
_FIELDS = {"fx_q16": (0, 32), "fy_q16": (0, 32), "cx_q16": (0, 32), "cy_q16": (0, 32), "distortion_q24": (5, 32),
           "position_q32": (3, 64), "rotation_q30": (4, 32)}
_AXES = {"opencv": lib.T3R_AXES_OPENCV, "opengl": lib.T3R_AXES_OPENGL}


@dataclasses.dataclass(frozen=True)
class Camera:
    """A calibrated, posed pinhole camera, for the pixel grid of the frame or picture that it comes with.

    It holds the library's fixed-point numbers, so that cameras out of a recording keep their bits. `calibrated()` makes
    one of floats. The properties are floats, too.

    Attributes
    ----------
    fx_q16, fy_q16 : int
        Focal lengths in pixels, in 1/2**16; from 8 up to, but not including, 16384 pixels.
    cx_q16, cy_q16 : int
        Principal point in pixels, in 1/2**16; between -16384 and 16384 pixels.
    position_q32 : tuple of 3 int
        The centre in world units, in 1/2**32.
    rotation_q30 : tuple of 4 int
        Camera to world, a quaternion w x y z, in 1/2**30.
    distortion : str
        "none", "radtan" (k1 k2 p1 p2 k3) or "fisheye" (k1 k2 k3 k4).
    distortion_q24 : tuple of 5 int
        The coefficients of the lens, in 1/2**24; those that it lacks are 0.
    size : pair of int, optional
        Width and height of that pixel grid. Frames and pictures of another size are refused. None: any size is taken.
    """

    fx_q16: int
    fy_q16: int
    cx_q16: int
    cy_q16: int
    position_q32: Tuple[int, int, int] = (0, 0, 0)
    rotation_q30: Tuple[int, int, int, int] = (1 << 30, 0, 0, 0)
    distortion: str = "none"
    distortion_q24: Tuple[int, int, int, int, int] = (0, 0, 0, 0, 0)
    size: Optional[Tuple[int, int]] = None

    @classmethod
    def calibrated(cls, fx: float, fy: float, cx: float, cy: float, pose: ArrayLike, distortion: str = "none",
                   coefficients: Sequence[float] = (), size: Optional[Tuple[int, int]] = None, *, axes: str = "opencv",
                   world_to_camera: bool = False) -> "Camera":
        """A camera of floats.

        Parameters
        ----------
        fx, fy, cx, cy : float
            Focal lengths and principal point in pixels; (0, 0) is the centre of the top-left pixel.
        pose : array_like, shape (4, 4) or (3, 4)
            Camera to world: a rotation, and the camera's centre in world units.
        distortion : str
            The lens: "none", "radtan" or "fisheye".
        coefficients : sequence of float
            Those of the lens in its order, at most as many as it has.
        size : pair of int, optional
            Width and height of the pixel grid that fx, fy, cx and cy are for.
        axes : str
            Of the camera: "opencv", x right, y down, z forward; or "opengl", x right, y up, z backward, as of Blender
            and nerfstudio.
        world_to_camera : bool
            The pose is the inverse one, as of OpenCV's solvePnP() and of COLMAP.

        Raises
        ------
        ValueError
            A number is not finite or out of range, or the pose is no rigid motion.
        """
        if distortion not in _LENSES:
            raise ValueError(f"distortion is one of {', '.join(_LENSES)}, not {distortion!r}")
        if len(coefficients) > _COEFFICIENTS[distortion]:
            raise ValueError(f"distortion {distortion!r} has {_COEFFICIENTS[distortion]} coefficients, "
                             f"not {len(coefficients)}")
        position, rotation = _posed(pose, axes, world_to_camera)
        k = [fixed(c, 24, f"coefficient {i}") for i, c in enumerate(coefficients)] + [0] * (5 - len(coefficients))
        x, y, z = (fixed(c, 32, "the pose's position", 64) for c in position)
        w, i, j, l = (fixed(c, 30, "the pose's rotation") for c in rotation)
        return cls(fixed(fx, 16, "fx"), fixed(fy, 16, "fy"), fixed(cx, 16, "cx"), fixed(cy, 16, "cy"), (x, y, z),
                   (w, i, j, l), distortion, (k[0], k[1], k[2], k[3], k[4]), size)

    def at(self, pose: ArrayLike, *, axes: str = "opencv", world_to_camera: bool = False) -> "Camera":
        """The same camera at another pose. Its parameters and errors are those of calibrated()."""
        posed = Camera.calibrated(self.fx, self.fy, self.cx, self.cy, pose, axes=axes, world_to_camera=world_to_camera)
        return dataclasses.replace(self, position_q32=posed.position_q32, rotation_q30=posed.rotation_q30)

    def resized(self, width: int, height: int) -> "Camera":
        """The camera of the same picture at another size in pixels. Raises ValueError where `size` is None or a number is
        out of range."""
        if self.size is None:
            raise InputError("the camera's size is not known", "T3R_ERR_CAMERA")
        old, new = grid("size", self.size), grid("size", (width, height))
        (fx, cx), (fy, cy) = (_resized(*axis) for axis in zip((self.fx_q16, self.fy_q16), (self.cx_q16, self.cy_q16), old, new))
        return dataclasses.replace(self, fx_q16=fx, fy_q16=fy, cx_q16=cx, cy_q16=cy, size=new)

    @property
    def fx(self) -> float:
        """Focal length across, in pixels."""
        return self.fx_q16 / 65536

    @property
    def fy(self) -> float:
        """Focal length down, in pixels."""
        return self.fy_q16 / 65536

    @property
    def cx(self) -> float:
        """Principal point across, in pixels."""
        return self.cx_q16 / 65536

    @property
    def cy(self) -> float:
        """Principal point down, in pixels."""
        return self.cy_q16 / 65536

    @property
    def pose(self) -> "NDArray[np.float64]":
        """Camera to world, shape (4, 4), in world units."""
        w, x, y, z = np.array(self.rotation_q30) / np.linalg.norm(self.rotation_q30)
        matrix = np.eye(4)
        matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                          [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                          [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
        matrix[:3, 3] = np.ldexp(np.array(self.position_q32, dtype=np.float64), -32)
        return matrix

    def native(self, size: Tuple[int, int]) -> Any:
        """A t3r_camera for a picture of that width and height.

        Raises InputError where it is for another size, or a number does not fit its field.
        """
        if self.size is not None and grid("size", self.size) != size:
            raise InputError(f"the camera is for {self.size[0]}x{self.size[1]} pixels, not for {size[0]}x{size[1]}: "
                             "resized() makes one for another size", "T3R_ERR_CAMERA")
        if self.distortion not in _LENSES:
            raise InputError(f"distortion is one of {', '.join(_LENSES)}, not {self.distortion!r}", "T3R_ERR_CAMERA")
        fields = {name: _integers(name, getattr(self, name), *field) for name, field in _FIELDS.items()}
        width, height = self.size or (0, 0)
        return ffi.new("t3r_camera *", {**fields, "width": width, "height": height, "distortion": _LENSES[self.distortion]})

    @classmethod
    def from_native(cls, camera: Any) -> "Camera":
        """Makes a camera of a t3r_camera."""
        lens = next(name for name, value in _LENSES.items() if value == camera.distortion)
        x, y, z = camera.position_q32
        w, i, j, k = camera.rotation_q30
        a, b, c, d, e = camera.distortion_q24
        return cls(camera.fx_q16, camera.fy_q16, camera.cx_q16, camera.cy_q16, (x, y, z), (w, i, j, k), lens,
                   (a, b, c, d, e), (camera.width, camera.height) if camera.width else None)


def _integers(name: str, value: Any, count: int, bits: int) -> Any:
    """The integers of a field, checked: so many of them, or one where `count` is 0."""
    low, high = -(1 << (bits - 1)), (1 << (bits - 1)) - 1
    if count == 0:
        return whole(name, value, low, high, "T3R_ERR_CAMERA")
    if not isinstance(value, (tuple, list, np.ndarray)) or len(value) != count:
        raise InputError(f"{name} has {count} integers, not {value!r}", "T3R_ERR_CAMERA")
    return [whole(f"{name}[{i}]", each, low, high, "T3R_ERR_CAMERA") for i, each in enumerate(value)]


def _resized(focal_q16: int, centre_q16: int, old: int, new: int) -> Tuple[int, int]:
    """Focal length and principal point along an axis of another length, rounded half up."""
    return (2 * focal_q16 * new + old) // (2 * old), (2 * (centre_q16 + 0x8000) * new + old) // (2 * old) - 0x8000


def _posed(pose: ArrayLike, axes: str, world_to_camera: bool) -> Tuple[Any, Any]:
    """Position in world units and unit quaternion w x y z, camera to world, of a matrix in a convention."""
    if axes not in _AXES:
        raise ValueError(f"axes are one of {', '.join(_AXES)}, not {axes!r}")
    given = np.asarray(pose)
    if given.dtype.kind not in "iufO":
        raise TypeError(f"a pose holds numbers, not {given.dtype}")
    if given.shape not in ((4, 4), (3, 4)):
        raise ValueError(f"a pose has the shape (4, 4) or (3, 4), not {given.shape}")
    matrix = np.eye(4)
    matrix[:len(given)] = given
    camera = ffi.new("t3r_recorded_camera *")
    host_called("t3r_camera_pose_matrix_as", HOST, camera, address(matrix, "double *"),
                _AXES[axes] | (lib.T3R_WORLD_TO_CAMERA if world_to_camera else 0))
    return camera.position, camera.rotation
