# SPDX-License-Identifier: Apache-2.0
"""The runtime's K-means against scikit-learn's MiniBatchKMeans on the same points: K = 300, the pointmap of two views.

Ours may be at most 1.05 x theirs in mean squared distance. Usage: kmeans_sklearn.py TRIM3R DUMP_POINTS DATA_FOLDER
"""
import json
import os
import subprocess
import sys
import tempfile
import warnings

ALLOWED = 1.05
CLUSTERS = 300

try:
    import numpy as np
    from sklearn.cluster import MiniBatchKMeans
except ImportError as missing:
    print(f"SKIPPED: {missing}")
    sys.exit(77)


def run(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def mean_squared_distance(points, centres):
    """Returns the mean |p - c|^2 to the nearest centre, in double, by blocks."""
    total = 0.0
    for block in np.array_split(points.astype(np.float64), 64):
        squares = (block**2).sum(1)[:, None] - 2 * block @ centres.T + (centres**2).sum(1)[None]
        total += np.maximum(squares.min(1), 0).sum()
    return total / len(points)


def compare(name, trim3r, points_file):
    points = np.fromfile(points_file, "<f4").reshape(-1, 6)
    ours = json.loads(run(trim3r, "bench", "--stages", "kmeans_ms", "--points", points_file, "--json", "--runs",
                          "1"))["kmeans_msd"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fit = MiniBatchKMeans(n_clusters=CLUSTERS, random_state=0).fit(points)
    theirs = mean_squared_distance(points, fit.cluster_centers_.astype(np.float64))
    print(f"{name}: {len(points)} points, ours {ours:.6g}, scikit-learn {theirs:.6g}, ratio {ours / theirs:.4f}")
    # no clustering can be much better than a converged one, so this catches a made-up figure
    return 0.5 * theirs <= ours <= ALLOWED * theirs


def main():
    trim3r, dump_points, data = sys.argv[1:4]
    good = True
    with tempfile.TemporaryDirectory() as folder:
        points = os.path.join(folder, "points.f32")
        recording = os.path.join(folder, "room.mcap")
        run(trim3r, "room", "-o", recording)
        run(dump_points, recording, "0", "2", points)
        good &= compare("room", trim3r, points)
        scene = os.path.join(data, "hololens_b")
        if os.path.isdir(scene):
            recording = os.path.join(folder, "scene.mcap")
            run(trim3r, "import", scene, "--size", "256x256", "-o", recording)
            run(dump_points, recording, "0", "2", points)
            good &= compare("hololens_b", trim3r, points)
    return 0 if good else 1


sys.exit(main())
