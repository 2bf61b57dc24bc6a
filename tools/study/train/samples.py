# SPDX-License-Identifier: Apache-2.0
"""Training data of a head: crops of pictures with depth, and pairs of posed views with a third to be predicted.

Pictures are generated without limit (procedural.py) and read from the user's folders: images, or posed folders with a
transforms.json (instant-ngp; depth as NeRFCapture writes it). Each draw depends only on its own generator, so a run can
stop and resume, and processes can share the work."""
import ctypes
import glob
import json
import os
from dataclasses import dataclass

import cv2
import numpy as np

import native
from procedural import Procedural, degrade_depth, expose

ALLOCATIONS = {"density": 1, "paper": 2, "pixel": 3, "uniform": 4, "random": 5}
MASKS = ("trim3r", "random", "eagles", "lightgaussian", "pup", "efficientgs")  # kinds of rivals/kinds.h, in order
KINDS = ("all", "recorded", "rooms", "pictures")  # of scenes
PLANE = 2000  # mm: the depth of pictures without depth, a wall two metres away
TRIPLET = (0, 2, 1)  # context, context, target


class _Views(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint32) for name in ("count", "width", "height")]
    _fields_ += [(name, ctypes.c_void_p) for name in ("rgb", "depth", "intrinsics", "poses")]


class _Settings(ctypes.Structure):
    _fields_ = [
        (name, ctypes.c_uint32)
        for name in ("gaussians", "allocate", "gamma_q8", "clusters", "batches", "seed", "rival")
    ]


POINT = np.dtype(
    [("x", "f4"), ("y", "f4"), ("spacing", "f4"), ("position", "f4", 3), ("tangent_u", "f4", 3), ("tangent_v", "f4", 3)]
)
_library = None


@dataclass
class Prepared:
    """One view prepared by the runtime: image uint8 [h, w, 3]; features int8 [h, w, 9]; confidence uint8 [h, w];
    points: POINT [n], raster order."""

    image: np.ndarray
    features: np.ndarray
    confidence: np.ndarray
    points: np.ndarray


def _quaternion(rotation):
    """Returns w x y z of a rotation matrix: the eigenvector of the symmetric matrix of Bar-Itzhack 2000, method 3."""
    (a, b, c), (d, e, f), (g, h, i) = np.asarray(rotation, np.float64)
    symmetric = [[a + e + i, h - f, c - g, d - b], [h - f, a - e - i, b + d, c + g],
                 [c - g, b + d, e - a - i, f + h], [d - b, c + g, f + h, i - a - e]]  # fmt: skip
    found = np.linalg.eigh(np.array(symmetric) / 3)[1][:, -1]
    return found if found[0] >= 0 else -found


def prepare(image, depth, intrinsics, kept, **budget):
    """Prepares one picture as the only context view; see prepare_views()."""
    return prepare_views([image], [depth], [intrinsics], None, kept, **budget)[0]


def prepare_views(images, depths, intrinsics, poses, kept, allocation="density", gamma=0.7, clusters=300, seed=1,
                  mask="trim3r"):  # fmt: skip
    """Analyses context views together by the runtime, with budget and features. depths: uint16 [h, w] each, mm;
    poses: camera to world [4, 4] each, None for a single view; kept: share of the points with depth; mask:
    chooses the points: `trim3r` by the allocation, a rival by its score of the Gaussians that the shipped `small`
    makes of all points."""
    global _library
    _library = _library or native.preparer()
    rgb, depth = np.ascontiguousarray(np.stack(images)), np.ascontiguousarray(np.stack(depths), np.uint16)
    count, height, width = depth.shape
    lenses, seats = np.ascontiguousarray(np.stack(intrinsics), np.float64), np.zeros((count, 7))
    seats[:, 0] = 1
    if poses is not None:
        seats[:] = [[*_quaternion(pose[:3, :3]), *pose[:3, 3]] for pose in poses]
    wanted = max(1, round(kept * int((depth > 0).sum())))
    settings = _Settings(wanted, ALLOCATIONS[allocation], round(gamma * 256), clusters, 4, seed, MASKS.index(mask))
    views = _Views(count, width, height, *(a.ctypes.data for a in (rgb, depth, lenses, seats)))
    features, confidence = np.empty((*depth.shape, 9), np.int8), np.empty(depth.shape, np.uint8)
    points, counts = np.empty(depth.size, POINT), np.zeros(count, np.uint32)
    status = _library.prepare(
        ctypes.addressof(views), ctypes.addressof(settings),
        *(a.ctypes.data for a in (features, confidence, points, counts)),
    )  # fmt: skip
    if status < 0:
        raise ValueError(f"the runtime refuses {count} pictures of {width} x {height}: status {status}")
    each = np.split(points[: counts.sum()], np.cumsum(counts)[:-1])
    return [Prepared(*parts) for parts in zip(rgb, features, confidence, each)]


def millimetres(depth):
    return np.clip(np.rint(depth * 1000), 0, 65535).astype(np.uint16)


def square(image):
    """Crops the largest centred square."""
    height, width = image.shape[:2]
    side = min(height, width)
    top, left = (height - side) // 2, (width - side) // 2
    return image[top : top + side, left : left + side], top, left


@dataclass
class Posed:
    """A frame of a posed folder: image uint8 [s, s, 3]; depth float32 [s, s], metres, 0: none; fx fy cx cy; camera to
    world."""

    image: np.ndarray
    depth: np.ndarray
    intrinsics: np.ndarray
    pose: np.ndarray


def _read_posed(folder, frame, unit, side):
    image = cv2.imread(os.path.join(folder, frame["file_path"]), cv2.IMREAD_COLOR)
    if image is None:
        raise ValueError(f"{folder}: {frame['file_path']} cannot be read as an image")
    image, top, left = square(image[:, :, ::-1])
    scale = side / image.shape[0]
    depth = np.zeros((side, side), np.float32)
    if frame.get("depth_path"):
        raw = cv2.imread(os.path.join(folder, frame["depth_path"]), cv2.IMREAD_UNCHANGED)
        if raw is None:
            raise ValueError(f"{folder}: {frame['depth_path']} cannot be read as an image")
        across = frame["w"] / raw.shape[1]
        centres = (np.arange(side) + 0.5) / scale
        rows, columns = ((top + centres) / across).astype(int), ((left + centres) / across).astype(int)
        depth = raw[np.ix_(rows, columns)].astype(np.float32) * unit
    axes = np.diag([1.0, -1.0, -1.0, 1.0])  # OpenGL's y up, z backward
    camera = [
        frame["fl_x"] * scale,
        frame["fl_y"] * scale,
        (frame["cx"] - left) * scale - 0.5,
        (frame["cy"] - top) * scale - 0.5,
    ]
    image = cv2.resize(np.ascontiguousarray(image), (side, side), interpolation=cv2.INTER_AREA)
    return Posed(image, depth, np.array(camera), np.array(frame["transform_matrix"]) @ axes)


class Folder:
    """Images of a folder, and the triplets of posed views with depth if it has any."""

    def __init__(self, path):
        self.path, self.images, self.triplets, self._posed = path, [], [], {}
        listing = os.path.join(path, "transforms.json")
        if os.path.exists(listing):
            with open(listing, encoding="utf-8") as file:
                scene = json.load(file)
            self.frames = [{**{k: v for k, v in scene.items() if k != "frames"}, **f} for f in scene["frames"]]
            self.unit = scene.get("integer_depth_scale", 0.001)
            names = [os.path.join(path, f["file_path"]) for f in self.frames]
            if all(
                f.get("depth_path") and "fl_x" in f and not any(f.get(k) for k in ("k1", "k2", "p1", "p2"))
                for f in self.frames
            ):
                self.triplets = [(*t["context"], t["target"]) for t in scene.get("trim3r_triplets", [])]
        else:
            names = sorted(
                n
                for e in ("png", "jpg", "jpeg", "JPG", "ppm")
                for n in glob.glob(os.path.join(path, "**", "*." + e), recursive=True)
            )
        for name in names:
            image = cv2.imread(name, cv2.IMREAD_COLOR)
            if image is None:
                raise ValueError(f"{name} cannot be read as an image")
            image = square(image[:, :, ::-1])[0]
            side = min(image.shape[0], 512)  # twice the working size: crops vary in scale
            self.images.append(cv2.resize(np.ascontiguousarray(image), (side, side), interpolation=cv2.INTER_AREA))
        if not self.images:
            raise ValueError(f"{path}: no images")

    def posed(self, index, side):
        if (index, side) not in self._posed:
            self._posed[index, side] = _read_posed(self.path, self.frames[index], self.unit, side)
        return self._posed[index, side]


class Samples:
    """Draws training data. made_up: share of pictures from procedural.py. kind: of KINDS, `all` or one kind of
    scene: views and pictures of the folders; generated rooms; generated pictures, which have no third view. mask:
    of MASKS, whose choice of points a head is trained for."""

    def __init__(self, folders, crop, made_up, build_folder=None, kind="all", mask="trim3r"):
        self.folders, self.crop, self.build_folder = [Folder(f) for f in folders], crop, build_folder
        self.kind, self.mask = kind, mask
        self.made_up = {"recorded": 0.0, "rooms": 1.0, "pictures": 1.0}.get(kind, made_up if self.folders else 1.0)
        self.images = [i for f in self.folders for i in f.images]
        self.triplets = [(f, t) for f in self.folders for t in f.triplets]
        if kind == "recorded" and not self.triplets:
            raise ValueError("recorded scenes need a folder of posed views with depth and triplets")

    def _turned(self, rng, image, depth):
        if rng.random() < 0.5:
            image, depth = image[:, ::-1], depth[:, ::-1]
        if rng.random() < 0.5:
            image, depth = image[::-1], depth[::-1]
        if rng.random() < 0.5:
            image, depth = image.transpose(1, 0, 2), depth.T
        return image, depth

    def _crop(self, rng, picture):
        n = self.crop
        if rng.random() < self.made_up:
            image, depth = picture
            top, left = rng.integers(0, image.shape[0] - n + 1, 2)
            image, depth = image[top : top + n, left : left + n], depth[top : top + n, left : left + n]
        else:
            source = self.images[rng.integers(len(self.images))]
            side = source.shape[0]
            size = min(side, int(n * rng.uniform(max(1.0, side / 400), max(1.0, side / 200))))
            top, left = rng.integers(0, side - size + 1, 2)
            image = cv2.resize(source[top : top + size, left : left + size], (n, n), interpolation=cv2.INTER_AREA)
            depth = np.full((n, n), PLANE / 1000, np.float32)
        image, depth = self._turned(rng, image, depth)
        if rng.random() < 0.5:
            depth = np.full((n, n), PLANE / 1000, np.float32)
        elif rng.random() < 0.6:
            depth = degrade_depth(rng, np.ascontiguousarray(depth))
        if rng.random() < 0.3:
            image = expose(rng, np.ascontiguousarray(image))
        return image, depth

    def _budget(self, rng):
        kept = float(np.exp(rng.uniform(np.log(0.02), np.log(0.35)))) if rng.random() < 0.85 else rng.uniform(0.35, 1)
        allocation = str(rng.choice(["density", "pixel", "uniform", "random"], p=[0.5, 0.3, 0.12, 0.08]))
        clusters = 300 if allocation == "density" and rng.random() < 0.5 else 40
        return dict(kept=kept, allocation=allocation, gamma=rng.uniform(0.4, 1.0), clusters=clusters,
                    seed=int(rng.integers(1 << 31)), mask=self.mask)  # fmt: skip

    def _procedural(self, rng):
        return Procedural(int(rng.integers(1 << 62)), build_folder=self.build_folder)

    def _picture(self, rng):
        """Returns a generated picture and its depth, to be cropped; None if none is needed."""
        source = self._procedural(rng)
        if self.kind == "rooms":
            (view,) = source.room(256, 256, 1)
            return view["image"], view["depth"]
        return source.leaves(256, 256) if self.made_up > 0 else None

    def crops(self, rng, count):
        """Returns `count` prepared pictures, each with its own budget. For a rival's mask about half or more of them
        are context views that it ranked together; the last pair may be cut to fit."""
        picture, made = self._picture(rng), []
        while len(made) < count:
            if self.mask != "trim3r" and self.kind != "pictures" and rng.random() < 0.5:
                made += [prepared for prepared, _ in self.triplet(rng)[0]][: count - len(made)]
                continue
            image, depth = self._crop(rng, picture)
            depth = millimetres(depth)
            if (depth > 0).sum() < 64:
                continue
            n, f = self.crop, self.crop * rng.uniform(0.8, 1.3)
            made.append(prepare(image, depth, (f, f, (n - 1) / 2, (n - 1) / 2), **self._budget(rng)))
        return made

    def _posed(self, rng):
        n = self.crop
        if self.triplets and rng.random() >= self.made_up:
            folder, indices = self.triplets[rng.integers(len(self.triplets))]
            return [folder.posed(i, n) for i in indices]
        room = self._procedural(rng).room(n, n, 3)
        return [Posed(*(room[i][k] for k in ("image", "depth", "intrinsics", "pose"))) for i in TRIPLET]

    def triplet(self, rng):
        """Returns two prepared context views and the target: [(Prepared, Posed), (Prepared, Posed)], Posed. Our
        allocations treat each view alone; a rival ranks both together and keeps points of both."""
        while True:
            made, posed = self._prepared_triplet(rng)
            if min(len(prepared.points) for prepared in made) > 0:
                return list(zip(made, posed[:2])), posed[2]

    def _prepared_triplet(self, rng):
        posed = self._posed(rng)
        budget, depths = self._budget(rng), []
        for view in posed[:2]:
            depth = degrade_depth(rng, view.depth) if rng.random() < 0.5 else view.depth
            if (depth > 0).sum() < 64:
                depth = np.where(view.depth > 0, view.depth, PLANE / 1000).astype(np.float32)
            depths.append(millimetres(depth))
        context = posed[:2]
        if self.mask == "trim3r":
            made = [prepare(view.image, depth, view.intrinsics, **budget) for view, depth in zip(context, depths)]
        else:
            parts = zip(*((view.image, depth, view.intrinsics, view.pose) for view, depth in zip(context, depths)))
            made = prepare_views(*parts, **budget)
        return made, posed


def seen_by(target, source, tolerance=0.03):
    """Returns the pixels of `target` whose surface `source` shows, too, by both depths: bool [s, s]."""
    side = target.depth.shape[0]
    v, u = np.mgrid[0:side, 0:side]
    fx, fy, cx, cy = target.intrinsics
    z = target.depth
    points = np.stack(((u - cx) / fx * z, (v - cy) / fy * z, z), -1)
    move = np.linalg.inv(source.pose) @ target.pose
    x, y, depth = np.moveaxis(points @ move[:3, :3].T + move[:3, 3], -1, 0)
    fx, fy, cx, cy = source.intrinsics
    safe = np.maximum(depth, 1e-6)
    column, row = np.rint(fx * x / safe + cx), np.rint(fy * y / safe + cy)
    inside = (z > 0) & (depth > 0.05) & (column >= 0) & (row >= 0) & (column < side) & (row < side)
    there = source.depth[np.where(inside, row, 0).astype(int), np.where(inside, column, 0).astype(int)]
    return inside & (there > 0) & (np.abs(there - depth) < tolerance * depth)
