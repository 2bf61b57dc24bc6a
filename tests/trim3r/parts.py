#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""parts.py TRIM3R: nothing partial stays, whether a signal ends a command or the disk is full; and a failed output
is an error."""
import os
import shutil
import signal
import subprocess
import time

from outputs import commands
from program import HEADS, TRIM3R, check, expect, fill_disk, in_scratch, room, write

SIZE = ("--size", "64x64")
# For each command, a line that succeeds and prints something; and its outputs.
LINES = {
    "scene": (["room.mcap", "-o", "out.ply"], ["out.ply"]),
    "import": (["posed", "-o", "out.mcap"], ["out.mcap"]),
    "capture": (["--source", "replay:room.mcap", "-o", "out.mcap"], []), # a truncated recording is one, too
    "room": ([*SIZE, "-o", "out.mcap"], ["out.mcap"]),
    "info": (["scene.ply", "--svg", "out.svg"], ["out.svg"]),
    "build": (["room.mcap", "--keep", "10", "-o", "out.ply", "--colmap", "start"], ["out.ply", "start"]),
    "convert": (["scene.ply", "-o", "out.spz"], ["out.spz"]),
    "render": (["scene.ply", "room.mcap", "--view", "1", "-o", "out.png"], ["out.png"]),
    "view": (["room.mcap", "-o", "out.html"], ["out.html"]),
    "eval": (["room.mcap", "--keep", "10", "--html", "out.html", "--images", "pictures"], ["out.html"]),
    "chart": (["scores.csv", "-o", "out.html", "--svg", "out.svg"], ["out.html", "out.svg"]),
    "stress": (["room.mcap", "--rows", "noise", "--strengths", "1", "--captures", "0", "--html", "out.html"],
               ["out.html"]),
    "trouble": (["room.mcap", "--with", "black", "--at", "1", "--for", "1", "-o", "out.mcap"], ["out.mcap"]),
    "replay": (["room.mcap"], []),
    "diff": (["scene.ply", "scene.ply"], []),
    "plan": ([*SIZE, "--gaussians", "9", "--svg", "out.svg", "--header", "out.h"], ["out.svg", "out.h"]),
    "bench": (["--runs", "1", "--stages", "texture_ns_per_pixel"], []),
    "doctor": ([], []),
    "quantize": ([os.path.join(HEADS, "small.safetensors"), "--calibrate", "room.mcap", "-o", "out.t3w"], ["out.t3w"]),
    "completion": (["bash", "-o", "out.bash"], ["out.bash"]),
    "head-info": ([os.path.join(HEADS, "small.safetensors")], []),
}


def prepare():
    room()
    expect(0, "build", "room.mcap", "--keep", 10, "-o", "scene.ply")
    expect(0, "eval", "room.mcap", "--keep", 10, "--csv", "scores.csv", "--images", "posed")
    shutil.copy("posed/1/target.png", "posed/a.png")
    write("posed/transforms.json", '{"fl_x": 60, "fl_y": 60, "cx": 32, "cy": 32, "frames": [{"file_path": "a.png", '
          '"transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}')
    check(sorted(LINES) == sorted(commands()), f"not the commands that there are: {commands()}")


def parts():
    return [os.path.join(folder, name) for folder, folders, files in os.walk(".") for name in folders + files
            if ".part" in name]


def on_a_full_disk():
    for command, (line, written) in LINES.items():
        if not written:
            continue
        done = subprocess.run([TRIM3R, command, *line], capture_output=True, text=True, timeout=300,
                              preexec_fn=fill_disk)
        check(done.returncode == 1 and done.stderr != "", f"{command} on a full disk: {done.returncode} {done.stderr}")
        left = [path for path in written if os.path.lexists(path)] + parts()
        check(not left, f"{command} on a full disk leaves {left}")


def to_a_full_terminal():
    for command, (line, written) in LINES.items():
        for arguments in (line, ["--help"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([TRIM3R, command, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
            if command == "chart" and arguments == line: # it prints nothing
                continue
            check(done.returncode == 1 and "standard output: " in done.stderr,
                  f"{command} {arguments} to a full terminal: {done.returncode} {done.stderr}")
        for path in written:
            check(os.path.exists(path), f"{command} did not write {path}")
            shutil.rmtree(path) if os.path.isdir(path) else os.unlink(path)


# Lines that write long enough for their partial file to be seen.
LONG = {
    "a recording": ["room", "--size", "640x480", "--frames", "1000", "-o", "long.mcap"],
    "a folder": ["build", "room.mcap", "--context", "0,1,2,3,4,5", "--keep", "20", "--method", "pup+finetune",
                 "--finetune-iterations", "2000", "--colmap", "long"],
    "a folder that was there": ["build", "room.mcap", "--context", "0,1,2,3,4,5", "--keep", "20", "--method",
                                "pup+finetune", "--finetune-iterations", "2000", "--colmap", "empty"],
    "a page, by several processes": ["eval", "room.mcap", "--keep", "50", "--methods", "pup+finetune",
                                     "--finetune-iterations", "2000", "--jobs", "3", "--from-file", "--html",
                                     "long.html"],
}


def as_usual():
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def by_a_signal():
    os.mkdir("empty")
    for what, line in LONG.items():
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            running = subprocess.Popen([TRIM3R, *line], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                       preexec_fn=as_usual)
            end = time.monotonic() + 60
            while not parts() and running.poll() is None and time.monotonic() < end:
                time.sleep(0.005)
            check(parts() != [], f"{what}: no part was seen")
            running.send_signal(number)
            running.communicate(timeout=60)
            check(running.returncode == -number, f"{what}: ended by {running.returncode}, not {number.name}")
            check(parts() == [] and not any(name.startswith("long") for name in os.listdir(".")) and
                  os.listdir("empty") == [], f"{what}: {number.name} leaves {parts()}, {os.listdir('.')}")
    # an ignored signal stays ignored, and a second one ends a capture
    ignored = subprocess.Popen([TRIM3R, "room", "--size", "320x240", "--frames", "8", "-o", "done.mcap"],
                               stdout=subprocess.DEVNULL, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    while not parts() and ignored.poll() is None:
        time.sleep(0.005)
    ignored.send_signal(signal.SIGHUP)
    check(ignored.wait(timeout=60) == 0 and os.path.exists("done.mcap"), "a signal that is ignored ended the command")


# Lines that make rows for long, while a table exists.
ROWS = {
    "eval": ["eval", "room.mcap", "--keep", "60,50,40", "--methods", "trim3r,pup+finetune", "--finetune-iterations",
             "2000", "--csv", "rows.csv"],
    "stress": ["stress", "room.mcap", "--working", "128x128", "--csv", "rows.csv"],
}


def until_a_row_is_made(line, beside):
    """Starts the command and waits for the second line of the table that it writes, `beside` the existing one or in
    its place."""
    running = subprocess.Popen([TRIM3R, *line], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               preexec_fn=as_usual)
    end = time.monotonic() + 60
    while running.poll() is None and time.monotonic() < end:
        made = parts() if beside else ["rows.csv"]
        if made and open(made[0], encoding="utf-8").read().count("\n") > 1:
            break
        time.sleep(0.005)
    check(running.poll() is None, f"{line}: it ended before it was interrupted")
    return running


def an_older_table():
    """An older table stays until the new one is complete; without one, rows appear as they are made."""
    for what, line in ROWS.items():
        write("rows.csv", "")
        running = until_a_row_is_made(line, False)
        check(parts() == [], f"{what}: rows beside an empty table: {parts()}")
        running.send_signal(signal.SIGINT)
        running.wait(timeout=60)
        table = open("rows.csv", encoding="utf-8").read()
        check(table.count("\n") > 1, f"{what}: an interrupted run leaves {table!r}")
        running = until_a_row_is_made(line, True)
        check(parts() != [], f"{what}: nothing is written beside the older table")
        running.send_signal(signal.SIGINT)
        running.wait(timeout=60)
        check(open("rows.csv", encoding="utf-8").read() == table and parts() == [], f"{what}: the older table is lost")
    # refused cases leave the table, rows of any kind replace it
    expect(1, "eval", "room.mcap", "--keep", 10, "--context", "0,5", "--target", 1, "--depth", "stereo", "--working",
           "32x32", "--csv", "rows.csv")
    check(open("rows.csv", encoding="utf-8").read() == table and parts() == [], "a refusal replaced the older table")
    expect(0, "eval", "room.mcap", "--keep", 10, "--csv", "rows.csv")
    table = open("rows.csv", encoding="utf-8").read()
    check(table.startswith("scene,context,target,method") and parts() == [], f"no new table: {table}")


def left_by_the_killed():
    """A killed process leaves a partial file, which does no harm."""
    line = [TRIM3R, *LONG["a folder that was there"]]
    running = subprocess.Popen(line, stdout=subprocess.DEVNULL)
    while not parts() and running.poll() is None:
        time.sleep(0.005)
    running.kill()
    running.wait()
    check(parts() != [], "no part was left")
    expect(0, "build", "room.mcap", "--keep", 10, "--colmap", "empty")
    check({"images", "sparse"} <= set(os.listdir("empty")), f"no model: {os.listdir('empty')}")
    expect(1, "build", "room.mcap", "--keep", 10, "--colmap", "empty", err="the folder is not empty")


if __name__ == "__main__":
    in_scratch(prepare, on_a_full_disk, to_a_full_terminal, by_a_signal, an_older_table, left_by_the_killed)
