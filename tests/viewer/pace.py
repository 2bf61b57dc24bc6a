#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""pace.py TRIM3R [SCENE...]: prints how fast the page of `trim3r view` draws in a headless Chromium without a GPU: seconds
from opening it to its first whole picture, and pictures a second while a mouse drags the scene, as a page in a file with
one thread. Without SCENE, scenes of 13,107, 150,000 and 1.5 million Gaussians are built from the built-in room. A rate
below LEAST is an error."""
import os
import sys
import tempfile
import time

import browser
from checks import check, done, run, skip
from common import need_page

TRIM3R, SCENES = sys.argv[1], sys.argv[2:]
BUILT = ((13107, 256), (150000, 512), (1500000, 1024))  # Gaussians, width of the two frames
WINDOWS = ((1280, 800), (2560, 1440))
SECONDS = 4
LEAST = 15  # pictures a second: half of those that the page aims at, for a busy machine
COUNTING = """globalThis.seen = [], done.draw = ((draw) => (answer) => { draw(answer);
    if (answer.coarse) seen.push([performance.now(), answer.width, answer.height, answer.gaussians]); })(done.draw)"""


def built(folder):
    for gaussians, side in BUILT:
        room, scene = f"{folder}/room-{side}.mcap", f"{folder}/{gaussians}.ply"
        run(TRIM3R, "room", "--size", f"{side}x{side}", "-o", room)
        run(TRIM3R, "build", room, "--context", "0,2", "--gaussians", gaussians, "--refine", "0", "-o", scene)
        yield scene


def dragged(page):
    """Drags to and fro for some seconds; returns pictures a second, and width, height and Gaussians of the last one."""
    x, y = page.place("#picture")
    page.value(COUNTING)
    page.mouse("mousePressed", (x, y), button="left", clickCount=1)
    begun, step = time.monotonic(), 0
    while time.monotonic() < begun + SECONDS:
        step += 1
        page.mouse("mouseMoved", (x + abs(step % 120 - 60), y + abs(step % 50 - 25)), button="left", buttons=1)
        time.sleep(0.01)
    page.mouse("mouseReleased", (x, y), button="left", clickCount=1)
    seen = [each for each in page.value("seen") if each[0] > page.value("seen[0][0]") + 1000]  # the pace is found by then
    return 1000 * (len(seen) - 1) / (seen[-1][0] - seen[0][0]), seen[-1][1:]


def measure(program, scene, folder):
    path = f"{folder}/page.html"
    run(TRIM3R, "view", scene, "-o", path, "--force")
    for window in WINDOWS:
        page = browser.Page(program, *window, timeout=120)
        try:
            begun = time.monotonic()
            page.open(path)
            page.wait("document.body.dataset.drawn !== undefined")
            first = time.monotonic() - begun
            page.wait("isStill()")
            rate, last = dragged(page)
            page.wait("isStill()")
            whole = page.value("document.getElementById('drawn').textContent")
            print(f"{os.path.basename(scene)}, {page.value('document.body.dataset.gaussians')} Gaussians, {window[0]}x{window[1]}: "
                  f"first picture after {first:.1f} s, {rate:.1f} pictures a second of {last[0]}x{last[1]} and {last[2]} Gaussians; at rest {whole}", flush=True)
            check(rate >= LEAST, f"{rate:.1f} pictures a second, not {LEAST}")
        finally:
            page.close()


program = browser.find()
if program is None:
    skip("there is no Chromium (tools/setup --tests installs it)")
with tempfile.TemporaryDirectory() as scratch:
    need_page(TRIM3R, scratch)
    for each in SCENES or built(scratch):
        measure(program, each, scratch)
done()
