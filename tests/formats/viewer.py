#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""viewer.py TRIM3R VIEWER [FOLDER]: two commands make a scene of a folder of pictures with poses. PlayCanvas's
SuperSplat viewer, whose page and code lie in VIEWER, opens the scene in a headless Chromium and shows what trim3r draws
from the same place. With FOLDER, screenshots go there."""
import functools
import http.server
import json
import math
import os
import shutil
import sys
import tempfile
import threading
import time

import browser
from checks import check, done, run, skip

TRIM3R, VIEWER = sys.argv[1:3]
looks = sys.argv[3] if len(sys.argv) > 3 else None
SIDE, FIELD = 256, 60  # pixels; degrees from edge to edge
LEAST = 22  # dB between the two pictures; a camera that is off by a degree has 17
FORMATS = (".ply", ".compressed.ply", ".sog")  # formats that the viewer opens
program = browser.find()
if program is None:
    skip("there is no Chromium (tools/setup --tests installs it)")


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def served(folder):
    """Serves the folder on the loopback address; yields the server's address."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server, f"http://127.0.0.1:{server.server_address[1]}"


def own_folder(folder):
    """Writes pictures with poses as a user of COLMAP has them, here of the built-in room."""
    run(TRIM3R, "room", "--frames", 3, "-o", f"{folder}/room.mcap")
    run(TRIM3R, "build", f"{folder}/room.mcap", "--context", "0,1,2", "--head", "none", "--refine", 0, "--gaussians", 9,
        "--colmap", f"{folder}/own")
    return f"{folder}/own"


def look_at(eye, target):
    """Returns camera to world as in transforms.json (x right, y up, z backward); the world's y points down."""
    back = [a - b for a, b in zip(eye, target)]
    size = math.sqrt(sum(a * a for a in back))
    back = [a / size for a in back]
    across = math.hypot(back[0], back[2])
    right = [-back[2] / across, 0, back[0] / across]
    up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2], back[0] * right[1] - back[1] * right[0]]
    return [[*row] for row in zip(right, up, back, eye)] + [[0, 0, 0, 1]]


def ours(scene, eye, target, picture):
    """Renders the scene with trim3r."""
    focal = SIDE / 2 / math.tan(math.radians(FIELD / 2))
    with open(picture + ".json", "w", encoding="utf-8") as file:
        json.dump({"fl_x": focal, "fl_y": focal, "cx": SIDE / 2, "cy": SIDE / 2, "w": SIDE, "h": SIDE,
                   "transform_matrix": look_at(eye, target)}, file)
    run(TRIM3R, "render", scene, "--pose", picture + ".json", "-o", picture)
    return picture


def settings(eye, target):
    """Returns the viewer's settings. It turns a .ply by half a turn about z, so that y points up."""
    def turned(point):
        return [-point[0], -point[1], point[2]]
    off = {"enabled": False}
    return {"version": 2, "tonemapping": "none", "highPrecisionRendering": False, "background": {"color": [0, 0, 0]},
            "postEffectSettings": {
                "sharpness": off | {"amount": 0}, "bloom": off | {"intensity": 0, "blurLevel": 2},
                "grading": off | {"brightness": 1, "contrast": 1, "saturation": 1, "tint": [1, 1, 1]},
                "vignette": off | {"intensity": 0, "inner": 0, "outer": 1, "curvature": 1}, "fringing": off | {"intensity": 0}},
            "animTracks": [], "annotations": [], "startMode": "default",
            "cameras": [{"initial": {"position": turned(eye), "target": turned(target), "fov": FIELD}}]}


def theirs(page, address, ending, picture):
    """Takes a screenshot of the scene in the viewer."""
    page.open(f"{address}/index.html?content=scene{ending}&webgl&noui&nofx&noanim")
    page.wait("window.isDrawn === true")
    time.sleep(1)  # the viewer sorts what it drew first
    page.shot(picture)
    return picture


def compared(a, b):
    told = json.loads(run(TRIM3R, "diff", a, b, "--json", expect=1).stdout)
    return told["psnr"]


with tempfile.TemporaryDirectory() as folder:
    site = shutil.copytree(VIEWER, f"{folder}/site")
    own, eye, target = own_folder(folder), [-0.3, 0, -0.1], [-0.1, 0.1, 1.5]
    run(TRIM3R, "import", own, "-o", f"{folder}/own.mcap")
    for ending in FORMATS:
        run(TRIM3R, "build", f"{folder}/own.mcap", "--context", "0,2", "--keep", "20%", "--depth", "stereo", "-o",
            f"{site}/scene{ending}")
    with open(f"{site}/settings.json", "w", encoding="utf-8") as file:
        json.dump(settings(eye, target), file)
    server, address = served(site)
    page = browser.Page(program, SIDE, SIDE, timeout=120, webgl=True)
    page.before_all("window.firstFrame = () => { window.isDrawn = true; };")
    for ending in FORMATS:
        here = ours(f"{site}/scene{ending}", eye, target, f"{folder}/ours.png")
        there = theirs(page, address, ending, f"{folder}/theirs.png")
        if looks:
            os.makedirs(looks, exist_ok=True)
            shutil.copy(here, f"{looks}/ours{ending}.png")
            shutil.copy(there, f"{looks}/theirs{ending}.png")
        found = compared(here, there)
        print(f"{ending}: {found:.1f} dB between their view and ours")
        check(found >= LEAST, f"{ending}: {found:.1f} dB, less than {LEAST}")
    page.close()
    server.shutdown()
done()
