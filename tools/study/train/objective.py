# SPDX-License-Identifier: Apache-2.0
"""The loss of a step: pictures drawn from a head's splats, plain and refined, in their own and in a third view."""
import numpy as np
import torch

import head_net
import perceptual
import samples
import splatting

FLOOR = 1e-5  # added to the MSE: errors below 50 dB count little
REFINEMENTS = 2


def as_tensor(image):
    return torch.from_numpy(np.ascontiguousarray(image.transpose(2, 0, 1))).float() / 255


def neighbours(picture, counts):
    """Returns a splat of the pixel's own colour wherever `counts` is 0, in place of another view's splats there. [n,
    9]"""
    y, x = (torch.from_numpy(i) for i in np.nonzero(counts == 0))
    variance, none = torch.full((len(x),), 0.36), torch.zeros(len(x))
    centres = torch.stack((x, y), 1).float()
    return splatting.pack(centres, variance, none, variance, torch.full((len(x),), 0.96), picture[:, y, x].T)


class Batch:
    """Prepared pictures as inputs of the network and the splatter. `covered`, a flag per picture: another view
    covers the area without depth, so that splats must end at its border."""

    def __init__(self, prepared, device, covered=None):
        self.prepared = prepared
        self.height, self.width = prepared[0].confidence.shape
        features = np.stack([p.features for p in prepared])
        self.features = torch.from_numpy(features).permute(0, 3, 1, 2).float().mul(head_net.FEATURE_STEP).to(device)
        points = np.concatenate([p.points for p in prepared])
        picture = np.concatenate([np.full(len(p.points), b) for b, p in enumerate(prepared)])
        self.start = np.cumsum([0] + [len(p.points) for p in prepared]).astype(np.int32)
        self.index = tuple(torch.from_numpy(a.astype(np.int64)) for a in (picture, points["y"], points["x"]))
        self.spacing = torch.from_numpy(points["spacing"].copy())
        self.pixel = torch.from_numpy(np.stack((points["x"], points["y"]), 1))
        self.pictures = torch.stack([as_tensor(p.image) for p in prepared])
        self.counts = np.ascontiguousarray(np.stack([p.confidence > 0 for p in prepared]).astype(np.uint8))
        self.around = []
        for b, flag in enumerate(covered if covered is not None else [False] * len(prepared)):
            self.around.append(neighbours(self.pictures[b], self.counts[b] if flag else np.ones((1, 1), np.uint8)))
            if flag:
                self.counts[b] = 1
        # a splat reaches one pixel beyond its depth
        self.weight = torch.nn.functional.max_pool2d(torch.from_numpy(self.counts).float()[:, None], 3, 1, 1)
        b, y, x = self.index
        self.own_colour = self.pictures[b, :, y, x]

    def with_neighbours(self, splats):
        """Appends the surrounding splats to those of each picture; returns all, and where each picture's begin."""
        parts, start = [], [0]
        for b, around in enumerate(self.around):
            parts += [splats[self.start[b] : self.start[b + 1]], around]
            start.append(start[-1] + len(parts[-2]) + len(around))
        return torch.cat(parts), np.array(start, np.int32)

    def footprints(self, head, device):
        outputs = head(self.features, tuple(i.to(device) for i in self.index)).cpu()
        return splatting.footprints(outputs, self.spacing, self.own_colour)


def drawing_order(rng, start):
    """Returns another order at every step, so that a head does not adapt to one."""
    return splatting.order_by(rng.random(start[-1]), start)


def errors(drawn, wanted, weight, term):
    """MSE over the weighted pixels and MSE + lambda x perceptual term, [b] each."""
    drawn, wanted = drawn * weight, wanted * weight
    share = weight.mean((1, 2, 3)).clamp(min=1e-3)
    mse = ((drawn - wanted) ** 2).mean((1, 2, 3)) / share
    return mse, mse + perceptual.LAMBDA * term(drawn, wanted)


def decibels(mse):
    return float(-10 * torch.log10(mse.detach() + 1e-9).mean())


def planar_loss(head, batch, rng, term, device):
    """Returns the loss of plain and refined pictures in their own view, and the PSNR of both."""
    footprints = batch.footprints(head, device)
    splats, begins = batch.with_neighbours(splatting.planar_splats(*footprints, batch.pixel))
    order = drawing_order(rng, begins)
    half = (len(batch.prepared) + 1) // 2  # the others are not refined: refining takes as long as everything else
    start, some = begins[: half + 1], slice(0, begins[half])
    first, pictures = splats[some], batch.pictures[:half]
    # Without momentum, which overshoots an even error: corrections count as constants, so a head would see only the
    # overshoot, which has the wrong sign.
    corrected = splatting.refine(first, start, order[some], pictures, batch.counts[:half], REFINEMENTS, momentum=False)
    refined = first + (corrected - first).detach()
    loss, seen = 0, []
    for drawn, begin, places, wanted, weight, share in (
        (splats, begins, order, batch.pictures, batch.weight, 0.3),
        (refined, start, order[some], pictures, batch.weight[:half], 0.7),
    ):
        picture = splatting.draw(drawn, begin, places, batch.width, batch.height)
        mse, both = errors(picture, wanted, weight, term)
        loss = loss + share * torch.log(both + FLOOR).mean()
        seen.append(decibels(mse))
    return loss, seen


def novel_loss(head, context, target, term, device):
    """Returns the loss of a third view drawn from the two context views' splats, over the surface that either shows."""
    splats, depths = [], []
    for prepared, view in context:
        batch = Batch([prepared], device)
        points = {k: torch.from_numpy(prepared.points[k].copy()) for k in ("position", "tangent_u", "tangent_v")}
        move = torch.from_numpy(np.linalg.inv(target.pose) @ view.pose).float()
        made, depth, front = splatting.lifted_splats(
            *batch.footprints(head, device), points, move[:3, :3], move[:3, 3], [float(v) for v in target.intrinsics]
        )
        splats.append(made[front])
        depths.append(depth[front].detach().numpy())
    splats, key = torch.cat(splats), np.concatenate(depths)
    start = np.array([0, len(key)], np.int32)
    height, width = target.depth.shape
    picture = splatting.draw(splats, start, splatting.order_by(key, start), width, height)
    seen = samples.seen_by(target, context[0][1]) | samples.seen_by(target, context[1][1])
    if seen.mean() < 0.1:
        return None, None
    weight = torch.from_numpy(seen.astype(np.float32))[None, None]
    mse, both = errors(picture, as_tensor(target.image)[None], weight, term)
    return torch.log(both + 1e-4).mean(), decibels(mse)
