#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""wavelet_pywavelets.py DRIVER [DATA]: texture energies against PyWavelets' db2, periodized, within 1 % in sum.

Always on synthetic images; if DATA exists, also on the first pictures of each of its scenes.
"""
import pathlib
import subprocess
import sys

try:
    import numpy as np
    import pywt
except ImportError as missing:
    print(f"SKIPPED: {missing}")
    sys.exit(77)


def ours(driver, rgb, levels):
    height, width = rgb.shape[:2]
    planes = np.ascontiguousarray(rgb.transpose(2, 0, 1)).tobytes()
    command = [driver, str(width), str(height), str(levels)]
    out = subprocess.run(command, input=planes, stdout=subprocess.PIPE, check=True)
    return np.frombuffer(out.stdout, np.uint16).reshape(height, width) / 16


def theirs(rgb, levels):
    r, g, b = (rgb[..., c].astype(np.int64) for c in range(3))
    luma = ((77 * r + 150 * g + 29 * b + 128) >> 8).astype(np.float64)
    bands = pywt.wavedec2(luma, "db2", mode="periodization", level=levels)[1:]
    return sum(4 ** level * sum(np.abs(band).sum() for band in detail)
               for level, detail in zip(range(levels, 0, -1), bands))


def made_up():
    noise = np.random.default_rng(7)
    y, x = np.mgrid[0:192, 0:256]
    yield "noise", noise.integers(0, 256, (192, 256, 3), dtype=np.uint8)
    waves = [127 + 120 * np.sin(x / 5 + y / 9), 127 + 90 * np.cos(x / 3), 60 + y / 2]
    yield "waves", np.stack(waves, -1).astype(np.uint8)
    yield "black and white", (255 * ((x // 7 + y // 5) % 2)).astype(np.uint8)[..., None].repeat(3, -1)
    spectrum = noise.standard_normal((192, 256)) + 1j * noise.standard_normal((192, 256))
    radius = np.hypot(np.fft.fftfreq(192)[:, None], np.fft.fftfreq(256)[None]) + 1e-3
    natural = np.fft.ifft2(spectrum / radius).real
    natural = np.clip(127 + 50 * natural / natural.std(), 0, 255)
    yield "1/f", np.stack([natural, natural * 0.9, natural * 0.7], -1).astype(np.uint8)


def pictures(folder):
    try:
        import cv2
    except ImportError:
        return
    for scene in sorted(path for path in folder.iterdir() if (path / "images").is_dir()):
        for path in sorted((scene / "images").iterdir())[:2]:
            picture = cv2.imread(str(path))
            if picture is not None:
                height, width = (min(side, 1280) // 4 * 4 for side in picture.shape[:2])
                yield f"{scene.name}/{path.name}", picture[:height, :width, ::-1]


def main():
    driver = sys.argv[1]
    folder = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    images = list(made_up())
    if folder is not None and folder.is_dir():
        images += pictures(folder)
    worst = 0
    for name, rgb in images:
        for levels in (1, 2):
            energy = theirs(rgb, levels)
            difference = abs(ours(driver, rgb, levels).sum() / energy - 1)
            worst = max(worst, difference)
            if not difference < 0.01:
                print(f"{name}, {levels} levels: {100 * difference:.2f} % from PyWavelets")
                return 1
    print(f"{len(images)} images, at most {100 * worst:.3f} % from PyWavelets")
    return 0


if __name__ == "__main__":
    sys.exit(main())
