#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""follow.py TRIM3R [FOLDER]: the page of a growing map in a headless Chromium: it loads new lines and new maps while
`replay --stream` runs, and stays after its end. With FOLDER, screenshots go there."""
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

import browser
from checks import check, done, run, skip
from common import need_page

TRIM3R = sys.argv[1]
looks = sys.argv[2] if len(sys.argv) > 2 else None
FRAMES = 36
program = browser.find()
if program is None:
    skip("there is no Chromium (tools/setup --tests installs it)")

PIXELS = """((id) => { const c = document.getElementById(id), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
    let n = 0; for (let i = 3; i < d.length; i += 4) n += d[i] > 0; return n; })"""

PICTURE = """(() => { const c = document.getElementById('picture'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
    let h = 2166136261; for (let i = 0; i < d.length; i++) h = Math.imul(h ^ d[i], 16777619); return h >>> 0; })()"""


def rows(page):
    return int(page.value("document.body.dataset.rows ?? 0"))


def count_lines(path):
    with open(path, "rb") as file:
        return file.read().count(b"\n")


def grows(page, running, lines):
    """The page shows each line that the run has written, until its end."""
    seen = set()
    while running.poll() is None:
        seen.add(rows(page))
        time.sleep(0.2)
    check(running.returncode == 0 and len(seen) > 2, f"rows appear while it runs: {sorted(seen)}")
    page.wait(f"Number(document.body.dataset.rows) === {count_lines(lines)}")


def shows(page):
    for canvas in ("timeline", "path"):
        check(page.value(f"{PIXELS}('{canvas}')") > 100, f"{canvas} is drawn")
    moment = page.value("document.getElementById('moment').textContent")
    check(re.search(r"keyframe 36, [0-9.]+ ms, [0-9.]+ dB before it.*36 keyframes: .* worst\. Not taken: none\.", moment), f"the newest: {moment}")
    x, y = page.place("#timeline")
    page.mouse("mouseMoved", (x, y))
    moment = page.value("document.getElementById('moment').textContent")
    check(re.match(r"Frame 1[5-9]: ", moment), f"the frame under the pointer: {moment}")
    page.mouse("mouseMoved", (x, y + 300))
    page.wait("isStill()")
    free = page.value("camera.position.join()")
    page.value("document.getElementById('ride').click()")
    page.wait("isStill()")
    check(page.value("camera.position.join()") != free, "the camera of the newest keyframe")
    browser.look(page, looks, "follow-ride")
    page.value("(() => { const s = document.getElementById('along'); s.value = 3; s.dispatchEvent(new Event('input')); })()")
    check(page.value("feed.rows[3].position.join() === camera.position.join() && !document.getElementById('ride').checked"), "an earlier keyframe")
    page.value("approach(3), moved()")
    page.wait("isStill()")
    browser.look(page, looks, "follow-path")
    page.value("document.getElementById('picture').focus()")
    page.key("ArrowUp", 38)
    check(not page.value("document.getElementById('ride').checked"), "a move by hand leaves the keyframe")
    page.wait("isStill()")
    with_path = page.value(PICTURE)
    page.value("document.getElementById('trace').click()")
    page.wait("isStill()")
    check(page.value(PICTURE) != with_path, "its path is drawn in the picture")


with tempfile.TemporaryDirectory() as scratch:
    need_page(TRIM3R, scratch)
    os.chdir(scratch)
    run(TRIM3R, "room", "--size", "160x120", "--frames", FRAMES, "-o", "walk.mcap")
    stream = [TRIM3R, "replay", "walk.mcap", "--stream", "--every", "1", "--gaussians", "3000", "--refine", "6", "--fit-passes",
              "off", "-o", "map.ply", "--snapshot", "4", "--lines", "run.jsonl"]
    server = subprocess.Popen([TRIM3R, "view", "map.ply", "--follow", "run.jsonl", "--json"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True)
    check("run.jsonl: waits until a stream writes it" in server.stderr.readline(), "the viewer waits")
    running = subprocess.Popen(stream, stdout=subprocess.DEVNULL)
    while not os.path.exists("map.ply"):
        check(running.poll() is None, "the run goes on")
        time.sleep(0.01)
    running.send_signal(signal.SIGSTOP)  # until there is a page
    page = browser.Page(program, timeout=120)
    try:
        page.open(json.loads(server.stdout.readline())["address"])
        page.wait("document.body.dataset.rows !== undefined")
        first = page.value("feed.version")
        browser.look(page, looks, "follow-early")
        running.send_signal(signal.SIGCONT)
        grows(page, running, "run.jsonl")
        page.wait(f"feed.version !== {json.dumps(first)} && isStill()")
        check(page.value("document.body.dataset.gaussians") == "3000", "the final map")
        browser.look(page, looks, "follow-end")
        for width, height in ((1280, 800), (2560, 1440)):
            page.size(width, height)
            page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            low = page.value("document.getElementById('moment').getBoundingClientRect().bottom")
            check(low <= height, f"{width}x{height}: the run is seen without scrolling, down to {low}")
            page.wait("isStill()")
            browser.look(page, looks, f"follow-{width}")
        page.size(1200, 1000)
        shows(page)
        page.scheme("dark")
        page.value("showRun()")
        browser.look(page, looks, "follow-dark")
        page.size(390, 844, True)
        check(page.value("document.documentElement.scrollWidth") <= 390, "nothing is wider than a phone")
        page.wait("isStill()")
        browser.look(page, looks, "follow-phone")
        with open("run.jsonl") as file:
            lines = file.readlines()
        refused = json.loads(lines[0]) | {"decision": "no depth", "keyframe": 0}
        with open("run.jsonl", "w") as file:  # another run, and a line that is still being written
            file.write("".join(lines[:5]) + json.dumps(refused) + "\n" + lines[6][:20])
        page.wait("document.body.dataset.rows === '6'")
        check("Not taken: 1 no depth." in page.value("document.getElementById('moment').textContent"), "frames that are refused")
        check(page.logged == [], f"nothing on the console: {page.logged}")
        check(all(url.startswith(("http://127.0.0.1:", "blob:", "data:")) for url in page.requested), f"{set(page.requested)}")
    finally:
        page.close()
        running.kill()
        running.wait(30)
        server.terminate()
        server.wait(30)
    refusals = (("needs a scene alone", "walk.mcap", "--follow", "run.jsonl"), ("page that is served", "map.ply", "--follow", "run.jsonl", "-o", "a.html"))
    for words, *line in refusals:
        check(words in run(TRIM3R, "view", *line, expect=2).stderr, f"{line}")
    os.chdir("/")
done()
