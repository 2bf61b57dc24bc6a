# SPDX-License-Identifier: Apache-2.0
"""Scores of scenes on a held-out view, as in `trim3r eval`."""
import dataclasses
from typing import List, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from . import measures
from ._native import address, ffi, lib
from .arguments import pair
from .configuration import Settings
from .image_stage import camera_of, develop
from .frame import Frame
from .reconstructor import Reconstructor

_ALPHA_ONE = 32767
_HOLE = 0.5  # transmittance above which there is a hole
_Mask = NDArray[np.bool_]


@dataclasses.dataclass(frozen=True, eq=False)
class Row:
    """One budget.

    Attributes
    ----------
    keep : float
        Percent of the valid points.
    gaussians : int
        The number that was used.
    psnr_all, ssim_all, flip_all : float
        Of all pixels that the target's lens reaches; PSNR is in dB.
    psnr, ssim, sharp, flip : float
        On the mask, as the functions of these names.
    holes : float
        The share of the mask that is drawn with a transmittance above 1/2.
    context_psnr : float
        The mean over the context views, each on its own mask, in dB.
    image : ndarray of uint8, shape (H, W, 3)
        The target view as it was drawn.
    """

    keep: float
    gaussians: int
    psnr_all: float
    ssim_all: float
    flip_all: float
    psnr: float
    ssim: float
    sharp: float
    flip: float
    holes: float
    context_psnr: float
    image: "NDArray[np.uint8]" = dataclasses.field(repr=False)


def evaluate(context: Sequence[Frame], target: Frame, keep: Sequence[float] = (100, 60, 40, 20, 10, 5, 2), *,
             size: Optional[Tuple[int, int]] = None, head: str = "small", depth: str = "sensor", workers: int = 1,
             settings: Settings = {}) -> List[Row]:
    """Builds scenes of the context frames and measures them on the target, a row a budget.

    The mask of a view has the pixels whose surface a context frame saw, by the frames' own depth. If a frame has no depth,
    it has all pixels. Definitions are those of `trim3r eval`, and so are the figures.

    Parameters
    ----------
    context : sequence of Frame
        The views that scenes are made of, with cameras.
    target : Frame
        The view that is drawn. Its colours are compared, and its depth serves for the mask alone.
    keep : sequence of float
        Budgets in percent of the valid points.
    size : pair of int, optional
        The working size. That of the first context frame without it.
    head, depth, workers, settings
        As Reconstructor has them.

    Returns
    -------
    list of Row
        In the order of `keep`.

    Raises
    ------
    ValueError
        As Reconstructor and its calls.
    """
    width, height = pair("size", size or context[0].size)
    pictures = [develop(frame, width, height) for frame in (target, *context)]
    shown = [_shown(frame, width, height) for frame in (target, *context)]
    masks = _masks(pictures, shown)
    rows: List[Row] = []
    with Reconstructor(width, height, views=len(context), head=head, depth=depth, workers=workers,
                       settings=settings) as made:
        for frame in context:
            made.add_view(frame)
        for percent in keep:
            scene = made.rebuild(keep=percent) if rows else made.build(keep=percent)
            rows.append(_row(percent, len(scene), made, pictures, shown[0], masks))
    return rows


def _shown(frame: Frame, width: int, height: int) -> _Mask:
    """Returns the pixels of a developed frame that the recorded picture reaches: a white one stays black beyond them."""
    if camera_of(frame).distortion == "none":
        return np.ones((height, width), dtype=np.bool_)
    white = np.full((*frame.size[::-1], 3), 255, dtype=np.uint8)
    lit: _Mask = _colour(develop(Frame(white, frame.camera), width, height))[..., 0] != 0
    return lit


def _masks(pictures: Sequence[Frame], shown: Sequence[_Mask]) -> Sequence[_Mask]:
    """Returns the pixels of each picture that count; the first is the target, the others are the context."""
    depths = [picture.depth for picture in pictures if picture.depth is not None]
    if len(depths) < len(pictures):
        return shown
    cameras = [camera_of(picture).native(picture.size) for picture in pictures]
    views = ffi.new("seen_view[]", [(camera, address(depth, "uint16_t *"), picture.depth_unit)
                                    for camera, depth, picture in zip(cameras, depths, pictures)])
    masks = [np.empty(depth.shape, dtype=np.uint8) for depth in depths]
    for i, mask in enumerate(masks):
        lib.seen_mask(address(mask, "uint8_t *"), *pictures[i].size, views + i, views + 1, len(pictures) - 1)
    return [reached & (mask != 0) for reached, mask in zip(shown, masks)]


def _transmittance(made: Reconstructor, picture: Frame) -> "NDArray[np.float64]":
    alpha = made.picture(camera_of(picture)).alpha_q15
    return (_ALPHA_ONE - np.minimum(alpha, _ALPHA_ONE).astype(np.float64)) / _ALPHA_ONE


def _colour(frame: Frame) -> "NDArray[np.uint8]":
    """Returns a developed frame's colour, a single array."""
    assert not isinstance(frame.colour, tuple)
    return frame.colour


def _row(percent: float, gaussians: int, made: Reconstructor, pictures: Sequence[Frame], shown: _Mask,
         masks: Sequence[_Mask]) -> Row:
    images = [made.render(camera_of(picture)) for picture in pictures]
    fits = [measures.psnr(_colour(picture), image, mask) for picture, image, mask in zip(pictures, images, masks)]
    wanted, image, mask = _colour(pictures[0]), images[0], masks[0]
    missed = _transmittance(made, pictures[0])[mask] > _HOLE
    return Row(percent, gaussians, psnr_all=measures.psnr(wanted, image, shown), ssim_all=measures.ssim(wanted, image, shown),
               flip_all=measures.flip(wanted, image, shown), psnr=fits[0], ssim=measures.ssim(wanted, image, mask),
               sharp=measures.sharp(wanted, image, mask), flip=measures.flip(wanted, image, mask),
               holes=float(np.mean(missed)) if missed.size else float("nan"), context_psnr=float(np.mean(fits[1:])),
               image=image)
