#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""ar.py TRIM3R AR_LOOP: a line and a view for every frame; the view drawn ahead is nearer to the next frame than the
current frame is; errors of a source are reported."""
import math
import subprocess
import tempfile

from checks import check, done, run
from common import EXAMPLE, room

SIDE, FRAMES = 256, 6
HEADING = b"P6\n256 256\n255\n"
VIEW_DB, SHOWN = 20.5, 0.95  # measured: 21.4 and 0.98; the poses are 17 mm from the predicted ones


def psnr(view, frame, shown):
    squares = sum((view[i + c] - frame[i + c])**2 for i in shown for c in range(3))
    return 10 * math.log10(255**2 * 3 * len(shown) / squares)


with tempfile.TemporaryDirectory() as folder:
    colours, _ = room(f"{folder}/room.mcap", SIDE, FRAMES)
    ended = subprocess.run([EXAMPLE, f"replay:{folder}/room.mcap"], capture_output=True, timeout=300)
    check(ended.returncode == 0, ended.stderr)
    check(ended.stderr.decode().splitlines() == [f"frame {i}: shown" for i in range(FRAMES)], ended.stderr)
    views = ended.stdout.split(HEADING)[1:]
    check([len(view) for view in views] == [3 * SIDE * SIDE] * FRAMES, "a picture a frame")
    for i in range(1, FRAMES - 1):  # the first frame has no motion yet
        view, frame, last = views[i], colours[i + 1], colours[i]
        shown = [p for p in range(0, len(view), 3) if view[p:p + 3] != bytes(3)]  # one view leaves the edges black
        ahead, stale, share = psnr(view, frame, shown), psnr(last, frame, shown), 3 * len(shown) / len(view)
        print(f"frame {i + 1}: {ahead:.2f} dB, {stale:.2f} dB by the frame before, on {share:.0%}")
        check(ahead >= VIEW_DB and ahead > stale + 2 and share > SHOWN, f"frame {i + 1}: {ahead:.2f}, {stale:.2f} dB")
    check("none.mcap" in run(EXAMPLE, f"replay:{folder}/none.mcap", expect=1).stderr, "a recording that is not there")
    check("usage" in run(EXAMPLE, expect=1).stderr, "no source")
done()
