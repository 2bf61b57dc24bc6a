# SPDX-License-Identifier: Apache-2.0
"""The synthetic training pictures: repeatable, with the statistics of photographs, depth and poses that agree.

Usage: procedural.py TOOLS_TRAIN BUILD_FOLDER"""
import os
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

try:
    import numpy as np
except ImportError as missing:
    print(f"SKIPPED: {missing}")
    sys.exit(77)

TOOLS, BUILD = sys.argv[1:3] if len(sys.argv) > 2 else ("tools/study/train", None)
sys.path.insert(0, TOOLS)
sys.dont_write_bytecode = True
import procedural  # noqa: E402

SIDE = 256


def grey_of(image):
    return image @ np.array([0.299, 0.587, 0.114])


def amplitude_slope(pictures):
    """Returns s of amplitude ~ 1/f^s over 4 to 100 cycles a picture: Hann window, every picture's power scaled to
    one."""
    window = np.hanning(SIDE)[:, None] * np.hanning(SIDE)[None]
    k = np.hypot(*np.meshgrid(*[np.fft.fftfreq(SIDE) * SIDE] * 2))
    rings, mean = np.arange(4, 100), 0
    for picture in pictures:
        power = np.abs(np.fft.fft2((picture - picture.mean()) * window)) ** 2
        power = np.array([power[(k >= r) & (k < r + 1)].mean() for r in rings])
        mean = mean + power / power.sum()
    return -np.polyfit(np.log(rings + 0.5), np.log(mean), 1)[0] / 2


def haar_deviations(picture, levels=4):
    """Returns the root mean square of the Haar details of successively coarser means, finest first: equal for
    amplitudes ~ 1/f."""
    found = []
    for _ in range(levels):
        a, b, c, d = picture[::2, ::2], picture[1::2, ::2], picture[::2, 1::2], picture[1::2, 1::2]
        details = np.stack((a - b + c - d, a + b - c - d, a - b - c + d)) / 2
        found.append(np.sqrt((details**2).mean()))
        picture = (a + b + c + d) / 4
    return np.array(found)


def planar_share(depth):
    """Returns the share of pixels at which 1/z is linear: the inside of a plane."""
    w = 1 / depth.astype(np.float64)
    bend = np.abs(w[:, 2:] + w[:, :-2] - 2 * w[:, 1:-1])
    return (bend < 1e-5 * w[:, 1:-1]).mean()


def warped(source, target, pose=None):
    """Returns source's colours at target's pixels by target's depth, and where source measured the same depth."""
    fx, fy, cx, cy = target["intrinsics"]
    y, x = np.mgrid[:SIDE, :SIDE]
    z = target["depth"].astype(np.float64)
    points = np.stack(((x - cx) / fx * z, (y - cy) / fy * z, z, np.ones_like(z)), -1)
    pose = target["pose"] if pose is None else pose
    points = points @ (np.linalg.inv(source["pose"].astype(np.float64)) @ pose.astype(np.float64)).T
    fx, fy, cx, cy = source["intrinsics"]
    front = points[..., 2] > 0.05
    u = np.where(front, fx * points[..., 0] / np.maximum(points[..., 2], 0.05) + cx, -1)
    v = np.where(front, fy * points[..., 1] / np.maximum(points[..., 2], 0.05) + cy, -1)
    inside = (u >= 0) & (v >= 0) & (u < SIDE - 1) & (v < SIDE - 1)
    u0, v0 = np.where(inside, u, 0).astype(int), np.where(inside, v, 0).astype(int)
    s, t = (np.where(inside, u, 0) - u0)[..., None], (np.where(inside, v, 0) - v0)[..., None]
    image = source["image"].astype(float)
    top = image[v0, u0] * (1 - s) + image[v0, u0 + 1] * s
    low = image[v0 + 1, u0] * (1 - s) + image[v0 + 1, u0 + 1] * s
    around = np.stack([source["depth"][v0 + j, u0 + i] for i in (0, 1) for j in (0, 1)])
    same = (np.abs(around / np.maximum(points[..., 2], 0.05) - 1) < 0.01).all(0)
    return top * (1 - t) + low * t, inside & same, inside


class Leaves(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        source, cls.pairs, cls.seconds = procedural.Procedural(20, build_folder=BUILD), [], []
        for _ in range(80):
            start = time.process_time()
            cls.pairs.append(source.leaves(SIDE, SIDE))
            cls.seconds.append(time.process_time() - start)
        cls.greys = [grey_of(image) for image, _ in cls.pairs]

    def test_repeats(self):
        again = procedural.Procedural(20, build_folder=BUILD)
        for image, depth in self.pairs[:3]:
            other = again.leaves(SIDE, SIDE)
            self.assertTrue(np.array_equal(image, other[0]) and np.array_equal(depth, other[1]))
        later = procedural.Procedural(20, index=7, build_folder=BUILD).leaves(SIDE, SIDE)
        self.assertTrue(np.array_equal(self.pairs[7][0], later[0]))
        other = procedural.Procedural(21, build_folder=BUILD).leaves(SIDE, SIDE)
        self.assertFalse(np.array_equal(self.pairs[0][0], other[0]))

    def test_repeats_without_the_optimiser(self):
        plain = procedural.Procedural(20, build_folder=BUILD, flags=("-std=gnu11", "-O1", "-ffp-contract=off"))
        for image, depth in self.pairs[:6]:
            other = plain.leaves(SIDE, SIDE)
            self.assertTrue(np.array_equal(image, other[0]) and np.array_equal(depth, other[1]))
        ours = procedural.Procedural(5, build_folder=BUILD).room(64, 64)
        plain.seed, plain.index = 5, 0
        room = plain.room(64, 64)
        for a, b in zip(ours, room):
            self.assertTrue(all(np.array_equal(a[key], b[key]) for key in a))

    def test_spectrum(self):
        # by this measure 1.44 and 1.54 on the two real scenes of the training; 1.2 in the literature, over all subjects
        self.assertTrue(1.0 <= amplitude_slope(self.greys) <= 1.5, amplitude_slope(self.greys))
        k = np.maximum(np.hypot(*np.meshgrid(*[np.fft.fftfreq(SIDE) * SIDE] * 2)), 1)
        noise = np.fft.fft2(np.random.default_rng(1).normal(size=(8, SIDE, SIDE)))
        for slope in (0, 1, 2):  # checks the measure itself
            self.assertAlmostEqual(amplitude_slope(np.fft.ifft2(noise / k**slope).real), slope, delta=0.1)

    def test_scales(self):
        """Details grow from octave to octave as in the real scenes: 10.7 14.7 17.6 22.3 and 11.9 16.3 19.9 25.9."""
        mean = np.mean([haar_deviations(g) for g in self.greys], 0)
        self.assertTrue(6 < mean[0] < 14, mean)
        ratios = mean[1:] / mean[:-1]
        self.assertTrue((ratios > 1.05).all() and (ratios < 1.6).all(), ratios)

    def test_gradients_are_sparse(self):
        steps = np.stack([np.diff(g, axis=1) for g in self.greys])
        kurtosis = (steps**4).mean() / (steps**2).mean() ** 2
        self.assertGreater(kurtosis, 10)  # 21 and 23 in the real scenes, 3 for Gaussian noise
        flat = (np.abs(steps) < 2).mean((1, 2))
        self.assertTrue(0.35 < flat.mean() < 0.75, flat.mean())  # 0.64 and 0.61 in the real scenes
        self.assertGreater(np.quantile(flat, 0.9) - np.quantile(flat, 0.1), 0.4)  # blank walls and foliage

    def test_colours(self):
        pixels = np.concatenate([image[::8, ::8].reshape(-1, 3) for image, _ in self.pairs]).astype(float)
        correlation = np.corrcoef(pixels.T)
        self.assertTrue((correlation > 0.7).all(), correlation)
        self.assertTrue(70 < pixels.mean() < 140, pixels.mean())
        means = np.array([g.mean() for g in self.greys])
        self.assertGreater(means.std(), 10)

    def test_depth(self):
        planar, edges = [], []
        for image, depth in self.pairs:
            self.assertTrue(np.isfinite(depth).all() and depth.min() > 0.05 and depth.max() < 60)
            planar.append(planar_share(depth))
            jump = procedural.depth_edges(depth)
            strength = np.abs(np.diff(grey_of(image), axis=1))
            if 0.01 < jump.mean() < 0.5:
                edges.append(strength[jump[:, 1:]].mean() / max(strength[~jump[:, 1:]].mean(), 0.1))
        self.assertGreater(np.median(planar), 0.8)
        self.assertGreater(np.median(edges), 2)  # depth changes where the picture changes

    def test_sides(self):
        image, depth = procedural.Procedural(1, build_folder=BUILD).leaves(123, 77)
        self.assertEqual((image.shape, depth.shape), ((77, 123, 3), (77, 123)))
        for side in (15, 2049):
            with self.assertRaises(ValueError):
                procedural.Procedural(1, build_folder=BUILD).leaves(side, SIDE)

    @classmethod
    def tearDownClass(cls):
        print(f"leaves of {SIDE}x{SIDE}: {1000 * np.median(cls.seconds):.1f} ms")


class Rooms(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        source, cls.rooms, cls.seconds = procedural.Procedural(30, build_folder=BUILD), [], []
        for _ in range(24):
            start = time.process_time()
            cls.rooms.append(source.room(SIDE, SIDE, 3))
            cls.seconds.append((time.process_time() - start) / 3)

    def test_cameras(self):
        for views in self.rooms:
            for view in views:
                fx, fy, cx, cy = view["intrinsics"]
                self.assertTrue(219 <= fx <= 301 and fx == fy and cx == cy == 127.5)
                rotation = view["pose"][:3, :3].astype(np.float64)
                self.assertTrue(np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-5))
                self.assertGreater(np.linalg.det(rotation), 0)
                self.assertTrue(np.array_equal(view["pose"][3], [0, 0, 0, 1]))
                self.assertTrue(np.isfinite(view["depth"]).all() and 0.05 < view["depth"].min())
                self.assertLess(view["depth"].max(), 12)
            at = np.array([v["pose"][:3, 3] for v in views], np.float64)
            walk = np.linalg.norm(at[2] - at[0])
            self.assertTrue(0.02 < walk < 1.6, walk)
            self.assertLess(np.linalg.norm(at[1] - (at[0] + at[2]) / 2), 0.35 * walk)  # the middle one is between

    def test_views_agree(self):
        differences, shares, wrong = [], [], []
        for views in self.rooms:
            for source, target in ((0, 1), (2, 1), (0, 2)):
                colours, same, inside = warped(views[source], views[target])
                error = np.abs(colours - views[target]["image"]).mean(-1)
                self.assertGreater(inside.mean(), 0.2)
                shares.append(same.sum() / inside.sum())
                differences.append(error[same].mean())
                moved = views[target]["pose"].copy()
                moved[:3, 3] += 0.05 * moved[:3, 0]
                colours, same, inside = warped(views[source], views[target], moved)
                wrong.append(np.abs(colours - views[target]["image"]).mean(-1)[same].mean())
        self.assertGreater(np.median(shares), 0.8)  # the others are hidden, or at an edge
        self.assertLess(np.mean(differences), 4)  # noise, resampling, vignetting, of 255
        self.assertLess(np.mean(differences), 0.75 * np.mean(wrong))

    def test_shape_of_a_stream(self):
        source = procedural.Procedural(30, index=4, build_folder=BUILD)
        views = source.room(SIDE, SIDE, 3)
        self.assertTrue(all(np.array_equal(a["image"], b["image"]) for a, b in zip(views, self.rooms[4])))
        self.assertEqual(len(source.room(64, 48, 2)), 2)
        self.assertEqual(source.room(64, 48, 1)[0]["image"].shape, (48, 64, 3))
        for views in (0, 17):
            with self.assertRaises(ValueError):
                source.room(64, 64, views)

    def test_statistics(self):
        greys = [grey_of(views[1]["image"]) for views in self.rooms]
        self.assertTrue(1.1 < amplitude_slope(greys) < 1.7, amplitude_slope(greys))
        self.assertTrue(60 < np.mean(greys) < 150, np.mean(greys))
        self.assertGreater(np.median([planar_share(views[1]["depth"]) for views in self.rooms]), 0.8)

    @classmethod
    def tearDownClass(cls):
        print(f"a room's view of {SIDE}x{SIDE}: {1000 * np.median(cls.seconds):.1f} ms")


class Degradations(unittest.TestCase):
    def test_noise_grows_with_the_square_of_depth(self):
        depth = np.repeat(np.array([[1, 4]], np.float32), 64, 0).repeat(64, 1)
        ratios = []
        for seed in range(60):
            made = procedural.degrade_depth(seed, depth, holes=False)
            self.assertTrue((made > 0).all() and made.dtype == np.float32)
            near, far = (made - depth)[:, :64].std(), (made - depth)[:, 64:].std()
            if near > 0.001:  # where steps do not dominate
                ratios.append(far / near)
        self.assertGreater(len(ratios), 15)
        self.assertTrue(12 < np.median(ratios) < 20, np.median(ratios))

    def test_holes(self):
        _, depth = procedural.Procedural(3, build_folder=BUILD).leaves(SIDE, SIDE)
        kept, before = [], depth.copy()
        for seed in range(60):
            made = procedural.degrade_depth(seed, depth, noise=False)
            self.assertTrue(np.array_equal(made[made > 0], depth[made > 0]))
            again = procedural.degrade_depth(np.random.default_rng(seed), depth, noise=False)
            self.assertTrue(np.array_equal(made, again))
            kept.append((made > 0).mean())
        self.assertTrue(np.array_equal(depth, before))
        self.assertTrue(min(kept) >= 0.04 and min(kept) < 0.3 and max(kept) > 0.97, (min(kept), max(kept)))

    def test_lattice(self):
        for seed in range(20):
            seen = procedural.depth_lattice(np.random.default_rng(seed), (SIDE, SIDE))
            self.assertTrue(0.03 < seen.mean() < 0.9, seen.mean())
            quarters = [q.mean() for h in np.split(seen, 2) for q in np.split(h, 2, 1)]
            self.assertLess(max(quarters), 1.2 * min(quarters))  # it reaches every corner

    def test_exposure(self):
        image, _ = procedural.Procedural(3, build_folder=BUILD).leaves(SIDE, SIDE)
        means = []
        for seed in range(40):
            made = procedural.expose(seed, image)
            self.assertTrue(made.dtype == np.uint8 and made.shape == image.shape)
            means.append(made.mean() / image.mean())
            for c in range(3):  # one rising curve a channel
                order = np.argsort(image[..., c].ravel(), kind="stable")
                self.assertTrue((np.diff(made[..., c].ravel()[order].astype(int)) >= 0).all())
        self.assertTrue(0.6 < min(means) < 0.95 and 1.05 < max(means) < 1.6, (min(means), max(means)))


class Sheet(unittest.TestCase):
    def test_command(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sheet.png")
            environment = dict(os.environ, TRIM3R_BUILD=BUILD or folder)
            command = [sys.executable, "-B", os.path.join(TOOLS, "procedural.py"), "--out", path, "--seed", "20"]
            subprocess.run(command, check=True, env=environment)
            with open(path, "rb") as file:
                data = file.read()
        width, height = struct.unpack(">II", data[16:24])
        self.assertEqual((data[:8], width, height), (b"\x89PNG\r\n\x1a\n", 6 * SIDE, 4 * SIDE))
        start = data.index(b"IDAT") + 4
        rows = np.frombuffer(zlib.decompressobj().decompress(data[start:]), np.uint8).reshape(height, 1 + 3 * width)
        first, _ = procedural.Procedural(20, build_folder=BUILD).leaves(SIDE, SIDE)
        self.assertTrue(np.array_equal(rows[:SIDE, 1 : 1 + 3 * SIDE].reshape(SIDE, SIDE, 3), first))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
