# SPDX-License-Identifier: Apache-2.0
"""How a picture is judged, as `trim3r eval` does.

All functions take the picture as it should be and the one that was drawn, uint8 of (H, W, 3) both, and a mask of (H, W):
bool or uint8, not 0 = the pixel counts; None = every pixel. They return NaN where no pixel counts, and raise ValueError
for arrays of other types or shapes.
"""
from typing import Any, Callable, Optional

import numpy as np
from numpy.typing import NDArray

from ._native import address, ffi, lib

Picture8 = NDArray[np.uint8]
Mask = Optional["NDArray[Any]"]


def psnr(target: Picture8, image: Picture8, mask: Mask = None) -> float:
    """Peak signal-to-noise ratio in dB; 99 where the pictures are equal."""
    return _measure(lib.metric_psnr, target, image, mask)


def ssim(target: Picture8, image: Picture8, mask: Mask = None) -> float:
    """Structural similarity, at most 1: windows of 11 x 11 with a deviation of 1.5, the mean of the channels."""
    return _measure(lib.metric_ssim, target, image, mask)


def sharp(target: Picture8, image: Picture8, mask: Mask = None) -> float:
    """The mean gradient of `image` against that of `target`; less than 1 is softer."""
    return _measure(lib.metric_sharp, target, image, mask)


def flip(target: Picture8, image: Picture8, mask: Mask = None) -> float:
    """Perceived difference, FLIP at 67 pixels a degree; 0 = none."""
    return _measure(lib.metric_flip, target, image, mask)


def _measure(metric: Callable[..., float], target: Picture8, image: Picture8, mask: Mask) -> float:
    for name, array in (("target", target), ("image", image)):
        if not isinstance(array, np.ndarray) or array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] != 3:
            raise ValueError(f"{name} is no array of uint8 with the shape (H, W, 3)")
    height, width = target.shape[:2]
    if image.shape != target.shape:
        raise ValueError(f"the pictures have the shapes {target.shape} and {image.shape}")
    if 0 in target.shape:
        raise ValueError("the pictures are empty")
    if mask is not None and not isinstance(mask, np.ndarray):
        raise ValueError(f"the mask is a {type(mask).__name__}, not an array")
    if mask is not None and mask.shape != (height, width):
        raise ValueError(f"the mask has the shape {mask.shape}, not {(height, width)}")
    counted = None if mask is None else np.ascontiguousarray(mask != 0).view(np.uint8)
    a, b = np.ascontiguousarray(target), np.ascontiguousarray(image)
    return float(metric(address(a, "uint8_t *"), address(b, "uint8_t *"),
                        ffi.NULL if counted is None else address(counted, "uint8_t *"), width, height))
