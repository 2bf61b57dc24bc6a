# SPDX-License-Identifier: Apache-2.0
"""Scores of scenes on a held-out view, as in `trim3r eval`."""
import dataclasses
from typing import List, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from . import measures
from .arguments import pair
from .configuration import Settings
from .image_stage import camera_of, develop
from .frame import Frame
from .reconstructor import Reconstructor

_ALPHA_ONE = 32767
_MASK, _HOLE = 0.3, 0.5  # transmittance: below it the target is measured, above it there is a hole


@dataclasses.dataclass(frozen=True, eq=False)
class Row:
    """One budget.

    Attributes
    ----------
    keep : float
        Percent of the valid points.
    gaussians : int
        The number that was used.
    psnr, psnr_all, context_psnr : float
        In dB: on the mask, over all pixels, and the mean of the context views, each on its own mask.
    ssim, sharp, flip : float
        On the mask, as the functions of these names.
    holes : float
        The share of the mask that is drawn with a transmittance above 1/2.
    image : ndarray of uint8, shape (H, W, 3)
        The target view as it was drawn.
    """

    keep: float
    gaussians: int
    psnr: float
    ssim: float
    sharp: float
    holes: float
    psnr_all: float
    context_psnr: float
    flip: float
    image: "NDArray[np.uint8]" = dataclasses.field(repr=False)


def evaluate(context: Sequence[Frame], target: Frame, keep: Sequence[float] = (100, 60, 40, 20, 10, 5, 2), *,
             size: Optional[Tuple[int, int]] = None, head: str = "small", depth: str = "sensor", workers: int = 1,
             settings: Settings = {}) -> List[Row]:
    """Builds scenes of the context frames and measures them on the target, a row a budget.

    The mask of a view is where all points of the frames' own depth cover it, drawn plainly; definitions are those of
    `trim3r eval`, and so are the figures.

    Parameters
    ----------
    context : sequence of Frame
        The views that scenes are made of, with cameras.
    target : Frame
        The view that is drawn. Its colours are compared; its depth is not used.
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
    masks = _masks(context, pictures, width, height, depth, workers, settings)
    rows: List[Row] = []
    with Reconstructor(width, height, views=len(context), head=head, depth=depth, workers=workers,
                       settings=settings) as made:
        for frame in context:
            made.add_view(frame)
        for percent in keep:
            scene = made.rebuild(keep=percent) if rows else made.build(keep=percent)
            rows.append(_row(percent, len(scene), made, pictures, masks))
    return rows


def _masks(context: Sequence[Frame], pictures: Sequence[Frame], width: int, height: int, depth: str, workers: int,
           settings: Settings) -> List["NDArray[np.bool_]"]:
    """Returns the pixels that the unpruned scene of the frames' own depth covers in each picture."""
    sensed = all(frame.depth is not None for frame in context)
    plain: Settings = {**settings, "fill_radius": 0, "bridge_radius": 0, "allocate": "uniform", "flying": 0,
                       "redundancy": 0, "exposure": 0, "fit_widths": 0, "align": 0, "refine": 0,
                       "keep_analysis": 0}
    with Reconstructor(width, height, views=len(context), head="analytic", depth="sensor" if sensed else depth,
                       workers=workers, settings=plain) as made:
        for frame in context:
            made.add_view(frame)
        made.build()
        return [_transmittance(made, picture) < _MASK for picture in pictures]


def _transmittance(made: Reconstructor, picture: Frame) -> "NDArray[np.float64]":
    alpha = made.picture(camera_of(picture)).alpha_q15
    return (_ALPHA_ONE - np.minimum(alpha, _ALPHA_ONE).astype(np.float64)) / _ALPHA_ONE


def _colour(frame: Frame) -> "NDArray[np.uint8]":
    """Returns a developed frame's colour, a single array."""
    assert not isinstance(frame.colour, tuple)
    return frame.colour


def _row(percent: float, gaussians: int, made: Reconstructor, pictures: Sequence[Frame],
         masks: Sequence["NDArray[np.bool_]"]) -> Row:
    images = [made.render(camera_of(picture)) for picture in pictures]
    fits = [measures.psnr(_colour(picture), image, mask) for picture, image, mask in zip(pictures, images, masks)]
    wanted, image, mask = _colour(pictures[0]), images[0], masks[0]
    missed = _transmittance(made, pictures[0])[mask] > _HOLE
    return Row(percent, gaussians, fits[0], measures.ssim(wanted, image, mask), measures.sharp(wanted, image, mask),
               float(np.mean(missed)) if missed.size else float("nan"), measures.psnr(wanted, image),
               float(np.mean(fits[1:])), measures.flip(wanted, image, mask), image)
