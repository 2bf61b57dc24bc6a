# SPDX-License-Identifier: Apache-2.0
"""Scenes: Gaussians in the library's integers, and what they mean in world units."""
import os
from typing import Any, Callable, Tuple

import numpy as np
from numpy.typing import NDArray

from ._native import ERROR_BYTES, address, borrowed, dtype_of, ffi, lib, text_of
from .arguments import Path, path_bytes, readable, whole, writable
from .errors import InputError, StateError

GAUSSIAN = dtype_of("t3r_gaussian")
_ORIGIN_MOST = (1 << 62) - 1
_EXPONENT_MOST = 24
_POINTS_MOST = (1 << 32) - 1
_COLOUR_ONE = 32640  # a level of 255, in 1/128


class Scene:
    """A set of Gaussians.

    One that a Reconstructor made lies in its arena: it is read without a copy, and only until the reconstructor makes
    another or is reset. After that, StateError is raised; copy() before it keeps the scene. Arrays of positions and the
    like are always new.

    Attributes
    ----------
    origin_q32 : tuple of 3 int
        The origin of the scene's frame, in 1/2**32 world units, between -2**62 and 2**62.
    exponent : int
        A scene unit is 2**exponent world units, -24..24.
    valid_points : int
        Pixels of the context views with a measured or matched depth; 0 = the scene came from a file.
    """

    def __init__(self, gaussians: "NDArray[Any]", origin_q32: Tuple[int, int, int], exponent: int,
                 valid_points: int = 0, fresh: Callable[[], bool] = lambda: True) -> None:
        if gaussians.dtype != GAUSSIAN or gaussians.ndim != 1:
            raise ValueError("Gaussians are a one-dimensional array of trim3r.scene.GAUSSIAN")
        self._gaussians, self._fresh = gaussians, fresh
        self.origin_q32, self.exponent = origin_q32, exponent
        self.valid_points = whole("valid_points", valid_points, 0, _POINTS_MOST)
        self.native_frame() # which checks it

    @classmethod
    def read(cls, path: Path) -> "Scene":
        """A scene from a file: .ply, .splat, .spz, .glb and all that `trim3r convert` reads. Colours are those of
        harmonics of degree 0.

        Raises
        ------
        OSError
            The file cannot be opened.
        InputError
            It is no scene; the text says what is wrong, and where.
        """
        error = ffi.new("char[]", ERROR_BYTES)
        file = ffi.new("scene_file *")
        if lib.scene_file_read(readable(path), 0, file, error, ERROR_BYTES) != 0:
            raise InputError(text_of(error))
        owner = ffi.gc(file, lib.scene_file_free)
        gaussians = borrowed(file.gaussians, file.count, owner, GAUSSIAN)
        return cls.in_frame(gaussians, file.frame)

    @classmethod
    def in_frame(cls, gaussians: "NDArray[Any]", frame: Any, valid_points: int = 0,
                 fresh: Callable[[], bool] = lambda: True) -> "Scene":
        """In a t3r_scene_frame."""
        x, y, z = frame.origin_q32
        return cls(gaussians, (x, y, z), frame.exponent, valid_points, fresh)

    def save(self, path: Path, local: bool = False, comments: bool = False) -> None:
        """Writes a file in the format of its suffix: .ply, .splat, .spz, .glb and all that `trim3r build` writes.

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
            The folder of the file is not there.
        InputError
            The suffix is that of no scene file, the scene is empty or a number of it out of range, or the file cannot be
            written. An existing file stays.
        """
        if not lib.scene_file_is_written(path_bytes(path)):
            names = ffi.new("char[]", lib.SCENE_FILE_SUFFIXES_BYTES)
            raise InputError(f"{os.fspath(path)}: scene files end in {text_of(lib.scene_file_suffixes(names))}")
        gaussians = np.ascontiguousarray(self.gaussians)
        scene = ffi.new("t3r_scene *", {"gaussians": address(gaussians, "t3r_gaussian *"), "count": len(gaussians),
                                        "frame": self.native_frame()[0]})
        flags = (lib.T3R_SCENE_LOCAL if local else 0) | (lib.T3R_SCENE_COMMENTS if comments else 0)
        error = ffi.new("char[]", ERROR_BYTES)
        if lib.scene_file_write(writable(path), scene, flags, ffi.NULL, error, ERROR_BYTES) != 0:
            raise InputError(text_of(error))

    def copy(self) -> "Scene":
        """The same scene in memory of its own."""
        return Scene(self.gaussians.copy(), self.origin_q32, self.exponent, self.valid_points)

    def select(self, which: "NDArray[Any]") -> "Scene":
        """The scene of the Gaussians that an index array or a mask of (N,) chooses, in memory of its own."""
        return Scene(self.gaussians[which].copy(), self.origin_q32, self.exponent, self.valid_points)

    def __len__(self) -> int:
        return len(self._gaussians)

    @property
    def gaussians(self) -> "NDArray[Any]":
        """The Gaussians as the library holds them: a structured array of (N,), a field each of t3r_gaussian.

        Raises StateError where the reconstructor that it lies in has gone on. An array that was taken before then shows
        other Gaussians, or none that mean anything.
        """
        if not self._fresh():
            raise StateError("the reconstructor has gone on, and this scene with it: copy() keeps a scene")
        return self._gaussians

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
