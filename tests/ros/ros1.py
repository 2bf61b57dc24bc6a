#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""ros1.py TRIM3R ros1_node|none ros1_play|none: runs the node for ROS 1 as a process, with Debian's master. It gets a
recording as messages over TCP; clouds and hashes are compared with `trim3r replay --stream`, with pose messages and
with tf."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

from checks import check, done, skip
from common import EVERY, FRAMES, GAUSSIANS, SIDE, check_clouds, check_hashes, check_lines, check_points, walk

trim3r, node, play = sys.argv[1:]
master = shutil.which("rosmaster")
if node == "none" or master is None:
    skip("ROS 1 is missing, or this build leaves it out (tools/setup --tests installs it)")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_for_port(port, process):
    for _ in range(400):
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        check(process.poll() is None, "the master runs")
        time.sleep(0.05)
    check(False, "the master answers")


def stop(process, number):
    """Ends a process as a user or a supervisor does; returns its output."""
    process.send_signal(number)
    return process.communicate(timeout=60)[0]


def session(folder, environment, recording, replayed, kind):
    """Runs the node once; returns the output of the player and of the node."""
    scene, cloud, lines = f"{folder}/{kind}.ply", f"{folder}/{kind}.cloud", f"{folder}/{kind}.jsonl"
    given = {"width": SIDE, "height": SIDE, "gaussians": GAUSSIANS, "every": EVERY, "queue": 32,
             "patience_ms": 20000.0, "world": "world", "scene": scene, "pose": kind, "lines": lines, "snapshot": 4}
    settings = [f"_{name}:={value}" for name, value in given.items()]
    running = subprocess.Popen([node, *settings], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True)
    try:
        by_tf = ["tf"] if kind == "tf" else []
        heard = subprocess.run([play, recording, str(len(replayed["keyframes"])), cloud, *by_tf], env=environment,
                               capture_output=True, text=True, timeout=120)
        check(running.poll() is None, "the node runs")
    finally:
        log = stop(running, signal.SIGTERM if by_tf else signal.SIGINT)
    check(heard.returncode == 0, f"{kind}: {heard.stderr}{log}")
    check(running.returncode == 0, f"{kind}: the node ends well: {log}")
    check_hashes(log, replayed, kind)
    check_clouds(heard.stdout.splitlines(), replayed, kind)
    check(f"{FRAMES} colour images, {FRAMES} frames, 0 refused" in log and f"saved {scene}" in log, f"{kind}: {log}")
    check_points(cloud, scene, kind)
    check_lines(lines, replayed, kind)


with tempfile.TemporaryDirectory() as folder:
    recording, replayed = walk(trim3r, folder)
    port = free_port()
    environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "ROS_HOME": folder,
                   "ROS_LOG_DIR": str(pathlib.Path(folder) / "log")}
    core = subprocess.Popen([master, "--core", "-p", str(port)], env=environment, stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)
    try:
        wait_for_port(port, core)
        for poses in ("pose", "tf"):
            session(folder, environment, recording, replayed, poses)
    finally:
        core.terminate()
        core.wait(30)
done()
