# SPDX-License-Identifier: Apache-2.0
"""Draws the curves of a run."""
import matplotlib
import numpy as np


def draw_curves(rows, path):
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(8, 4.5))
    steps = [r[0] for r in rows]
    for column, label in ((2, "own view"), (3, "own view, refined"), (4, "third view")):
        values = np.array([r[column] for r in rows], float)
        smooth = [
            np.nanmean(values[max(0, i - 7) : i + 1]) if np.isfinite(values[max(0, i - 7) : i + 1]).any() else np.nan
            for i in range(len(values))
        ]
        (line,) = axes.plot(steps, smooth, label=label)
        axes.plot(steps, values, color=line.get_color(), alpha=0.25, linewidth=0.8)
    changes = [r[0] for before, r in zip(rows, rows[1:]) if before[7] != r[7]]
    for step in changes:
        axes.axvline(step, color="grey", linewidth=0.6, linestyle=":")
    axes.set(xlabel="step", ylabel="PSNR of training pictures, dB", title="A head learns")
    axes.grid(alpha=0.3)
    axes.legend(loc="lower right")
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    pyplot.close(figure)
