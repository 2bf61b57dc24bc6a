# SPDX-License-Identifier: Apache-2.0
"""Scenes: Gaussians in the library's integers, and what they mean in world units."""
import os
import warnings
from typing import Any, Callable, Dict, List, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._native import HOST, address, borrowed, dtype_of, ffi, host_called, lib
from .arguments import Path, path_bytes, readable, whole
from .errors import InputError, StateError
from .scene_arrays import IDENTITY, Arrays, arrays_of, checked, scene_of

GAUSSIAN = dtype_of("t3r_gaussian")
FAR = dtype_of("t3r_scene_far")
_ORIGIN_MOST = (1 << 62) - 1
_EXPONENT_MOST = 24
_POINTS_MOST = (1 << 32) - 1
_COLOUR_ONE = 32640  # a level of 255, in 1/128


class Scene:
    """A set of Gaussians.

    One that a Reconstructor or a Stream made lies in its arena: it is read without a copy, and only until the next scene
    is made or a reset. After that, StateError is raised; copy() before it keeps the scene. Pickling copies, too.
    numpy.asarray(scene) is `gaussians`, without a copy. Arrays of positions and the like are always new.

    Attributes
    ----------
    origin_q32 : tuple of 3 int
        The origin of the scene's frame, in 1/2**32 world units, between -2**62 and 2**62.
    exponent : int
        A scene unit is 2**exponent world units, -24..24.
    valid_points : int
        Pixels of the context views with a measured or matched depth; 0 = the scene came from elsewhere.
    harmonics_q12 : ndarray of int16, shape (N, (degree + 1)**2, 3), or None
        The coefficients of colours that depend on the direction, from degree 0 on, in 1/2**12; None: they do not.
    antialiased : bool
        Opacities are those of mip-splatting.
    finer : int
        A picture takes a frame of its own, with a unit of 2**-finer scene units, 0..48; 0: only if `far` has
        Gaussians.
    far : ndarray of FAR
        Gaussians beyond the fixed point, by rising index: they are `times` as far from the origin, and as large, as
        `gaussians` says.
    """

    def __init__(self, gaussians: "NDArray[Any]", origin_q32: Tuple[int, int, int], exponent: int,
                 valid_points: int = 0, harmonics_q12: "Optional[NDArray[np.int16]]" = None, antialiased: bool = False,
                 finer: int = 0, far: "Optional[NDArray[Any]]" = None,
                 fresh: Callable[[], bool] = lambda: True) -> None:
        if gaussians.dtype != GAUSSIAN or gaussians.ndim != 1:
            raise ValueError("Gaussians are a one-dimensional array of trim3r.scene.GAUSSIAN")
        self._gaussians, self._fresh = gaussians, fresh
        self.origin_q32, self.exponent = origin_q32, exponent
        self.valid_points = whole("valid_points", valid_points, 0, _POINTS_MOST)
        self.harmonics_q12, self.antialiased = harmonics_q12, antialiased
        self.finer = whole("finer", finer, 0, 2 * _EXPONENT_MOST)
        self.far = np.zeros(0, FAR) if far is None else far
        self._degree() # which checks them
        self.native_frame() # which checks it

    @classmethod
    def read(cls, path: Path, drop_invalid: bool = False) -> "Scene":
        """A scene from a file: .ply, .splat, .spz, .glb and all that `trim3r convert` reads. Warns of what reading
        changed.

        Parameters
        ----------
        path : str or path-like
            The file.
        drop_invalid : bool
            Gaussians with a number that is not finite are left out, instead of refusing the file.

        Raises
        ------
        OSError
            The file cannot be opened or read.
        InputError
            It is no scene; the text says what is wrong, and where.
        """
        file = ffi.new("t3r_scene_file *")
        flags = lib.T3R_SCENE_DROP_INVALID if drop_invalid else 0
        _warn(host_called("t3r_scene_read_as", HOST, readable(path), flags, file, path=os.fsdecode(path)))
        return cls._of_file(file)

    @classmethod
    def from_arrays(cls, positions: ArrayLike, scales: ArrayLike, rotations: ArrayLike = IDENTITY,
                    colours: ArrayLike = 0.5, opacities: ArrayLike = 1.0, harmonics: Optional[ArrayLike] = None,
                    antialiased: bool = False) -> "Scene":
        """A scene of N Gaussians in floats, to be saved or drawn.

        The scene's frame is chosen as for a file: its origin is in the middle of the Gaussians.

        Parameters
        ----------
        positions : array_like, shape (N, 3)
            The means in world units.
        scales : array_like, shape (N, 3), or float
            The standard deviations along the Gaussian's own axes in world units, 0 or more; one number for all. A .ply
            has their logarithms.
        rotations : array_like, shape (N, 4)
            Quaternions w x y z of any length, from those axes to the world. Without them the axes are the world's.
        colours : array_like, shape (N, 3), or float
            Red, green and blue, 0..1. A .ply has coefficients f: 0.5 + 0.28209479 * f.
        opacities : array_like, shape (N,), or float
            The opacities at the means, 0..1. A .ply has logits x: 1 / (1 + exp(-x)).
        harmonics : array_like, shape (N, 3, 3), (N, 8, 3) or (N, 15, 3), optional
            Spherical harmonics of degree 1, 2 or 3 for red, green and blue, without degree 0.
        antialiased : bool
            Opacities are those of mip-splatting.

        Raises
        ------
        InputError
            An array has another shape, or a number is not finite or out of range: its place and value are named.
        TypeError
            An array holds no real numbers.
        """
        return cls._of_file(scene_of(checked(positions, scales, rotations, colours, opacities, harmonics), antialiased))

    @classmethod
    def in_frame(cls, gaussians: "NDArray[Any]", frame: Any, valid_points: int = 0,
                 fresh: Callable[[], bool] = lambda: True) -> "Scene":
        """In a t3r_scene_frame."""
        x, y, z = frame.origin_q32
        return cls(gaussians, (x, y, z), frame.exponent, valid_points, fresh=fresh)

    @classmethod
    def _of_file(cls, file: Any) -> "Scene":
        """Takes over a t3r_scene_file."""
        owner = ffi.gc(file, lib.t3r_scene_free)
        scene = cls.in_frame(borrowed(file.gaussians, file.count, owner, GAUSSIAN), file.frame)
        if file.degree > 0:
            coefficients = (file.degree + 1)**2
            flat = borrowed(file.harmonics_q12, file.count * coefficients * 3, owner, np.dtype(np.int16))
            scene.harmonics_q12 = flat.reshape(file.count, coefficients, 3)
        scene.antialiased, scene.finer = bool(file.mip), file.finer
        if file.far_count > 0:
            scene.far = borrowed(file.far, file.far_count, owner, FAR)
        return scene

    def save(self, path: Path, local: bool = False, comments: bool = False) -> None:
        """Writes a file in the format of its suffix: .ply, .splat, .spz, .glb and all that `trim3r build` writes. Warns
        of what the format cannot hold.

        Parameters
        ----------
        path : str or path-like
            The file. One that is there is replaced.
        local : bool
            Positions are from the scene's origin, not the world's.
        comments : bool
            A .ply names the bits epoch and the scene's frame, with which read() gives the same integers. Some readers
            fail on comments.

        Raises
        ------
        OSError
            The system refuses to write it: no such folder, no permission, a full disk. An existing file stays.
        InputError
            The suffix is that of no scene file, the scene is empty or a number of it is out of range. An existing file
            stays.
        """
        flags = (lib.T3R_SCENE_LOCAL if local else 0) | (lib.T3R_SCENE_COMMENTS if comments else 0)
        file, kept = self.native()
        _warn(host_called("t3r_scene_file_write_as", HOST, path_bytes(path), file, flags, path=os.fsdecode(path)))
        del kept

    def copy(self) -> "Scene":
        """The same scene in memory of its own."""
        return self.select(np.arange(len(self)))

    def select(self, which: "NDArray[Any]") -> "Scene":
        """The scene of the Gaussians that an index array or a mask of (N,) chooses, in memory of its own."""
        gaussians, harmonics = self.gaussians[which], self.harmonics_q12
        times = np.ones(len(self))
        times[self.far["index"]] = self.far["times"]
        chosen = times[which]
        far = np.zeros(np.count_nonzero(chosen > 1), FAR)
        far["index"], far["times"] = np.flatnonzero(chosen > 1), chosen[chosen > 1]
        return Scene(gaussians.copy(), self.origin_q32, self.exponent, self.valid_points,
                     None if harmonics is None else harmonics[which].copy(), self.antialiased, self.finer, far)

    def __reduce__(self) -> Tuple[Any, ...]:
        return Scene, (self.gaussians.copy(), self.origin_q32, self.exponent, self.valid_points, self.harmonics_q12,
                       self.antialiased, self.finer, self.far.copy())

    def __len__(self) -> int:
        return len(self._gaussians)

    def __repr__(self) -> str:
        if not self._fresh():
            return "<Scene: gone, as its reconstructor or stream has gone on>"
        points = f" of {self.valid_points} points" if self.valid_points else ""
        degree = f", harmonics of degree {self._degree()}" if self._degree() else ""
        x, y, z = self.origin
        return f"<Scene: {len(self)} Gaussians{points}{degree}, origin ({x:.6g}, {y:.6g}, {z:.6g})>"

    @property
    def __array_interface__(self) -> Dict[str, Any]:
        return self.gaussians.__array_interface__

    @property
    def gaussians(self) -> "NDArray[Any]":
        """The Gaussians as the library holds them: a structured array of (N,), a field each of t3r_gaussian.

        Raises StateError where the reconstructor that it lies in has gone on. An array that was taken before then shows
        other Gaussians, or none that mean anything.
        """
        if not self._fresh():
            raise StateError("the reconstructor or stream has gone on, and this scene with it: copy() keeps a scene")
        return self._gaussians

    def arrays(self) -> Arrays:
        """The scene in new arrays of floats: Scene.from_arrays(*scene.arrays()) is the same scene within the steps of
        the fixed point, in a frame of its own."""
        file, kept = self.native()
        arrays = arrays_of(file)
        del kept
        return arrays

    @property
    def origin(self) -> "NDArray[np.float64]":
        """The origin of the scene's frame in world units, (3,)."""
        return np.ldexp(np.array(self.origin_q32, dtype=np.float64), -32)

    @property
    def positions(self) -> "NDArray[np.float64]":
        """The means in world units, (N, 3)."""
        scaled: "NDArray[np.float64]" = np.ldexp(self.gaussians["position_q20"].astype(np.float64), self.exponent - 20)
        return self.origin + scaled

    @property
    def scales(self) -> "NDArray[np.float64]":
        """The standard deviations along the Gaussians' own axes in world units, (N, 3)."""
        return self.arrays().scales

    @property
    def rotations(self) -> "NDArray[np.float64]":
        """Unit quaternions w x y z from those axes to the world, (N, 4)."""
        return self.arrays().rotations

    @property
    def harmonics(self) -> "Optional[NDArray[np.float32]]":
        """The coefficients above degree 0 for red, green and blue, (N, 3, 3), (N, 8, 3) or (N, 15, 3); None: there are
        none."""
        return None if self.harmonics_q12 is None else np.ldexp(self.harmonics_q12[:, 1:].astype(np.float32), -12)

    @property
    def depends_on_camera(self) -> bool:
        """Whether the Gaussians look different from each viewpoint."""
        return self.harmonics_q12 is not None or self.antialiased or self.finer > 0 or len(self.far) > 0

    @property
    def covariances(self) -> "NDArray[np.float64]":
        """The covariances in world units squared, (N, 3, 3)."""
        gaussians = self.gaussians
        exponents = gaussians["factor_exponent"].astype(np.int32) + self.exponent
        factors = np.ldexp(gaussians["factor"].reshape(-1, 3, 3).astype(np.float64), exponents[:, None, None])
        products: "NDArray[np.float64]" = np.einsum("nik,njk->nij", factors, factors)
        return products

    @property
    def colours(self) -> "NDArray[np.float32]":
        """Red, green and blue, 0..1, (N, 3)."""
        return self.gaussians["colour_q7"].astype(np.float32) / np.float32(_COLOUR_ONE)

    @property
    def opacities(self) -> "NDArray[np.float32]":
        """The opacities at the means, 0 up to, but not including, 1, (N,)."""
        return self.gaussians["opacity_q15"].astype(np.float32) / np.float32(1 << 15)

    @property
    def confidences(self) -> "NDArray[np.float32]":
        """The confidence of the depths, 0..1, (N,): 1 = measured, less = filled or doubtful."""
        return self.gaussians["confidence"].astype(np.float32) / np.float32(255)

    def native_frame(self) -> Any:
        """A pointer to the t3r_scene_frame. Raises InputError where a number is out of its range."""
        if len(self.origin_q32) != 3:
            raise InputError(f"origin_q32 has 3 integers, not {self.origin_q32!r}")
        origin = [whole(f"origin_q32[{i}]", each, -_ORIGIN_MOST, _ORIGIN_MOST) for i, each in enumerate(self.origin_q32)]
        exponent = whole("exponent", self.exponent, -_EXPONENT_MOST, _EXPONENT_MOST)
        return ffi.new("t3r_scene_frame *", {"origin_q32": origin, "exponent": exponent})

    def native(self) -> Tuple[Any, Any]:
        """A pointer to a t3r_scene_file and what must outlive its use. Raises as native_frame()."""
        gaussians = np.ascontiguousarray(self.gaussians)
        degree = self._degree()
        harmonics = None if degree == 0 else np.ascontiguousarray(self.harmonics_q12)
        far = np.ascontiguousarray(self.far)
        file = ffi.new("t3r_scene_file *", {
            "gaussians": address(gaussians, "t3r_gaussian *"), "count": len(gaussians), "frame": self.native_frame()[0],
            "degree": degree, "mip": bool(self.antialiased), "finer": self.finer,
            "far": address(far, "t3r_scene_far *"), "far_count": len(far),
            "harmonics_q12": ffi.NULL if harmonics is None else address(harmonics, "int16_t *")})
        return file, (gaussians, harmonics, far)

    def _degree(self) -> int:
        """Returns the degree of the harmonics. Raises ValueError where they are no array of a scene of so many
        Gaussians."""
        harmonics = self.harmonics_q12
        if harmonics is None:
            return 0
        shapes: List[Tuple[int, ...]] = [(len(self._gaussians), (degree + 1)**2, 3) for degree in (1, 2, 3)]
        if not isinstance(harmonics, np.ndarray) or harmonics.dtype != np.int16 or harmonics.shape not in shapes:
            raise ValueError(f"harmonics_q12 is an array of int16 of one of the shapes {shapes}")
        return shapes.index(harmonics.shape) + 1


def _warn(remarks: str) -> None:
    """Passes remarks on a file to the caller of the caller."""
    if remarks:
        warnings.warn(remarks, stacklevel=3)
