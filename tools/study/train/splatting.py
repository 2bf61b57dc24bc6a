# SPDX-License-Identifier: Apache-2.0
"""Splats of an image plane in torch: footprints from a head's outputs, drawn with derivatives, refined."""
import numpy as np
import torch

import native

DILATION = 0.3
# Of a splat before dilation. The shipped heads were trained with the first of both; see runtime/head/head.h.
VARIANCE_LEAST, VARIANCE_LEAST_REFINED = 0.02, 0.2
L_LEAST, L_MOST = 580 / 4096, 64  # of a Cholesky factor, pixels, as runtime/head/head_learned.c has them
CHANGES = 10  # of a splat in a pass of refinement, its share of the step with them
_library = None


def _native():
    global _library
    _library = _library or native.splatter()
    return _library


class _Draw(torch.autograd.Function):
    @staticmethod
    def forward(context, splats, start, order, width, height):
        splats, count = splats.detach().contiguous(), len(start) - 1
        picture = torch.empty(count, height, width, 3)
        if not _native().splat_forward(
            count, width, height, start.ctypes.data, splats.data_ptr(), order.ctypes.data, picture.data_ptr()
        ):
            raise MemoryError("splatter: out of memory")
        context.save_for_backward(splats, picture)
        context.rest = start, order, width, height
        return picture.permute(0, 3, 1, 2)

    @staticmethod
    def backward(context, gradient):
        splats, picture = context.saved_tensors
        start, order, width, height = context.rest
        gradient, out = gradient.permute(0, 2, 3, 1).contiguous(), torch.empty_like(splats)
        if not _native().splat_backward(
            len(start) - 1, width, height, start.ctypes.data, splats.data_ptr(), order.ctypes.data,
            picture.data_ptr(), gradient.data_ptr(), out.data_ptr(),
        ):  # fmt: skip
            raise MemoryError("splatter: out of memory")
        return out, None, None, None, None


def draw(splats, start, order, width, height):
    """Pictures [b, 3, height, width] of splats [n, 9] (splat.c tells the columns): those of picture b are
    start[b]..start[b + 1] - 1, drawn in `order` (int32, from each start, front to back). Differentiable in splats."""
    return _Draw.apply(splats, start, order, width, height)


def refine(splats, start, order, pictures, counts, passes, momentum=True):
    """Splats corrected towards `pictures` by `passes` of the runtime's refinement, or by that less its momentum, every
    step the share of a first pass; no derivatives."""
    made, pictures = splats.detach().clone().contiguous(), pictures.permute(0, 2, 3, 1).contiguous()
    height, width = pictures.shape[1:3]
    changes = torch.zeros(len(made), CHANGES) if momentum else None
    for _ in range(passes):
        drawn = draw(made, start, order, width, height).permute(0, 2, 3, 1).contiguous()
        if not _native().splat_refine(
            len(start) - 1, width, height, start.ctypes.data, made.data_ptr(), order.ctypes.data,
            drawn.data_ptr(), pictures.data_ptr(), counts.ctypes.data, changes.data_ptr() if momentum else None,
        ):  # fmt: skip
            raise MemoryError("splatter: out of memory")
    return made


def order_by(key, start):
    """Orders by `key` within each picture, front to back."""
    order = np.empty(len(key), np.int32)
    for a, b in zip(start[:-1], start[1:]):
        order[a:b] = np.argsort(key[a:b], kind="stable")
    return order


class _Held(torch.autograd.Function):
    """A clamp whose derivative leads back inside."""

    @staticmethod
    def forward(context, x, low, high):
        context.save_for_backward(x)
        context.range = low, high
        return x.clamp(low, high)

    @staticmethod
    def backward(context, gradient):
        (x,) = context.saved_tensors
        low, high = context.range
        return gradient * (((x >= low) | (gradient < 0)) & ((x <= high) | (gradient > 0))), None, None


held = _Held.apply


def footprints(outputs, spacing, own_colour):
    """What head_learned.c makes of a head's outputs [n, 9]: offset [n, 2] and the lower Cholesky factor l11, l21, l22
    [n, 3] of the total footprint, pixels; opacity [n]; colour [n, 3] in 0..1. spacing [n] pixels, own_colour [n, 3]."""
    s = spacing[:, None]
    offset = held(outputs[:, 0:2], -2, 2) * s
    diagonal = held(s * torch.exp2(held(outputs[:, 2:4], -4, 4)), L_LEAST, L_MOST)
    across = held(held(outputs[:, 4:5], -2, 2) * s, -L_MOST, L_MOST)
    factor = torch.cat((diagonal[:, :1], across, diagonal[:, 1:]), 1)
    opacity = held(outputs[:, 5], 0, 0.99)
    colour = held(own_colour + outputs[:, 6:9] * (64 / 255), 0, 1)
    return offset, factor, opacity, colour


def narrowed(factor, least=VARIANCE_LEAST):
    """Returns the lower factor of the footprint minus the rasterizer's dilation, like runtime/head/head_lift.c."""
    l11, l21, l22 = factor.unbind(1)
    xx = torch.clamp(l11 * l11 - DILATION, min=least)
    yy = torch.clamp(l21 * l21 + l22 * l22 - DILATION, min=least)
    a = torch.sqrt(xx)
    b = l11 * l21 / a
    c = torch.sqrt(torch.clamp(yy - b * b, min=least))
    return torch.stack((a, b, c), 1)


def pack(mean, xx, xy, yy, opacity, colour):
    """Packs splats [n, 9] from centres [n, 2] and covariances, dilation included."""
    determinant = xx * yy - xy * xy
    conic = torch.stack((yy / determinant, -xy / determinant, xx / determinant), 1)
    return torch.cat((mean, conic, opacity[:, None], colour), 1)


def planar_splats(offset, factor, opacity, colour, pixel, least=VARIANCE_LEAST):
    """Returns the footprints about `pixel` [n, 2] as splats of their own view."""
    a, b, c = narrowed(factor, least).unbind(1)
    return pack(pixel + offset, a * a + DILATION, a * b, b * b + c * c + DILATION, opacity, colour)


def lifted_splats(offset, factor, opacity, colour, points, rotation, translation, intrinsics):
    """The same footprints on their surface, seen by another camera: splats, depth [n] and which are in front. `points`:
    position, tangent_u, tangent_v [n, 3] in the source camera; rotation [3, 3] and translation [3] take these to the
    other camera, whose fx, fy, cx, cy are `intrinsics`. The thin normal term is left out."""
    tangents = torch.stack((points["tangent_u"], points["tangent_v"]), 2)  # [n, 3, 2]
    centre = points["position"] + (tangents @ offset[:, :, None])[:, :, 0]
    a, b, c = narrowed(factor).unbind(1)
    lower = torch.stack((torch.stack((a, torch.zeros_like(a)), 1), torch.stack((b, c), 1)), 1)
    spread = rotation @ (tangents @ lower)  # [n, 3, 2], camera axes
    x, y, z = (centre @ rotation.T + translation).unbind(1)
    front = z > 0.05
    z = torch.clamp(z, min=0.05)
    fx, fy, cx, cy = intrinsics
    u, v = x / z, y / z
    top = (spread[:, 0] - u.clamp(-2, 2)[:, None] * spread[:, 2]) * (fx / z)[:, None]
    bottom = (spread[:, 1] - v.clamp(-2, 2)[:, None] * spread[:, 2]) * (fy / z)[:, None]
    xx, yy = (top * top).sum(1) + DILATION, (bottom * bottom).sum(1) + DILATION
    mean = torch.stack((fx * u + cx, fy * v + cy), 1)
    return pack(mean, xx, (top * bottom).sum(1), yy, opacity, colour), z, front
