# SPDX-License-Identifier: Apache-2.0
"""Scenes from and to arrays of floats."""
from typing import Any, NamedTuple, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._native import HOST, address, check, ffi, host_called, lib
from .errors import InputError

_COEFFICIENTS = (0, 3, 8, 15)  # above degree 0, by the degree
IDENTITY = (1.0, 0.0, 0.0, 0.0)


class Arrays(NamedTuple):
    """A scene in floats: what Scene.from_arrays() takes, by the same names.

    Attributes
    ----------
    positions : ndarray of float64, shape (N, 3)
        The means in world units.
    scales : ndarray of float64, shape (N, 3)
        The standard deviations along the Gaussians' own axes, in world units.
    rotations : ndarray of float64, shape (N, 4)
        Unit quaternions w x y z, from those axes to the world.
    colours : ndarray of float64, shape (N, 3)
        Red, green and blue of degree 0, 0..1 where a screen can show them.
    opacities : ndarray of float64, shape (N,)
        The opacities at the means, 0..1.
    harmonics : ndarray of float32, shape (N, 3, 3), (N, 8, 3) or (N, 15, 3), or None
        The coefficients above degree 0 for red, green and blue. None: colours are the same from everywhere.
    """

    positions: "NDArray[np.float64]"
    scales: "NDArray[np.float64]"
    rotations: "NDArray[np.float64]"
    colours: "NDArray[np.float64]"
    opacities: "NDArray[np.float64]"
    harmonics: "Optional[NDArray[np.float32]]"


def checked(positions: ArrayLike, scales: ArrayLike, rotations: ArrayLike, colours: ArrayLike, opacities: ArrayLike,
            harmonics: Optional[ArrayLike]) -> Arrays:
    """The arrays in the library's types and shapes. Raises TypeError and InputError, which name the array."""
    means = _numbers("positions", positions)
    if means.ndim != 2 or means.shape[1] != 3 or len(means) == 0:
        raise InputError(f"positions have the shape (N, 3) with N above 0, not {means.shape}")
    count = len(means)
    if getattr(colours, "dtype", None) == np.uint8:
        raise InputError("colours are floats of about 0 to 1, not uint8: divide levels of 255 by 255")
    return Arrays(np.ascontiguousarray(means), _each("scales", scales, (count, 3)),
                  _each("rotations", rotations, (count, 4), IDENTITY), _each("colours", colours, (count, 3)),
                  _each("opacities", opacities, (count,)), _coefficients(harmonics, count))


def scene_of(arrays: Arrays, antialiased: bool) -> Any:
    """A t3r_scene_file of the arrays, to be freed. Raises InputError where a number is not finite or out of range."""
    made = ffi.new("t3r_scene_file *")
    native = _native(arrays)
    native.mip = antialiased
    host_called("t3r_scene_of_floats_as", HOST, native, made)
    return made


def arrays_of(file: Any) -> Arrays:
    """The floats of a t3r_scene_file."""
    count, rest = file.count, _COEFFICIENTS[file.degree]
    arrays = Arrays(np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 4)), np.empty((count, 3)), np.empty(count),
                    np.empty((count, rest, 3), np.float32) if rest else None)
    check(lib.t3r_floats_of_scene_as(HOST, file, _native(arrays)), "t3r_floats_of_scene")
    return arrays


def _native(arrays: Arrays) -> Any:
    """A t3r_scene_floats of the arrays, which must outlive its use."""
    *doubles, harmonics = arrays
    fields = {name: address(array, "double *") for name, array in zip(Arrays._fields, doubles)}
    degree = 0 if harmonics is None else _COEFFICIENTS.index(harmonics.shape[1])
    return ffi.new("t3r_scene_floats *", {
        **fields, "count": len(arrays.positions), "degree": degree,
        "harmonics": ffi.NULL if harmonics is None else address(harmonics, "float *")})


def _numbers(name: str, values: ArrayLike) -> "NDArray[Any]":
    """The values as an array of float64. Raises TypeError unless they are real numbers."""
    given = np.asarray(values)
    if given.dtype.kind not in "fiu":
        raise TypeError(f"{name} are real numbers, not {given.dtype}")
    return given.astype(np.float64, copy=False)


def _each(name: str, values: ArrayLike, shape: Tuple[int, ...], usual: Optional[Tuple[float, ...]] = None) -> "NDArray[Any]":
    """A row for each Gaussian: the values, or one number or the usual row for all."""
    given = _numbers(name, values)
    every = given.ndim == 0 or (usual is not None and given.shape == (len(usual),))
    if given.shape != shape and not every:
        allowed = f"{shape}{'' if usual else ' or a number for all'}"
        raise InputError(f"{name} have the shape {allowed}, as the {shape[0]} positions, not {given.shape}")
    return np.ascontiguousarray(np.broadcast_to(given, shape))


def _coefficients(harmonics: Optional[ArrayLike], count: int) -> "Optional[NDArray[np.float32]]":
    if harmonics is None:
        return None
    given = _numbers("harmonics", harmonics)
    if given.ndim != 3 or given.shape[0] != count or given.shape[1] not in _COEFFICIENTS or given.shape[2] != 3:
        raise InputError(f"harmonics have the shape ({count}, 3, 3), ({count}, 8, 3) or ({count}, 15, 3) without degree 0, "
                         f"not {given.shape}")
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(given, dtype=np.float32) if given.shape[1] else None
