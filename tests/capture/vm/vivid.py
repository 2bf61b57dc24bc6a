#!/usr/bin/env python3
"""vivid.py TRIM3R FOLDER [FRAMES]: capture by V4L2 from the kernel's own virtual camera, in a virtual machine: frames
of every pixel format recorded and replayed with the same hash, then every fault that the driver can be asked for."""
import json
import os
import subprocess
import sys
import time

import machine

TRIM3R, FOLDER = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
FRAMES = int(sys.argv[3]) if len(sys.argv) > 3 else 1000
FORMATS = ("YUYV", "UYVY", "NV12", "RGB3", "BGR3", "GREY")
checks = 0

# vivid's controls: the colour bars need no time to be drawn; faults are asked for one by one
JOB = f"""
capture() {{ trim3r capture --source v4l2:/dev/video0 --size 320x180 --json --quiet "$@"; }}
inject /dev/video0 0x00f0f001 2
for f in {" ".join(FORMATS)}; do
    capture --format $f --rate 120 --frames {FRAMES} --buffers 16 --hash -o a.mcap > out/$f.live
    trim3r capture --source replay:a.mcap --hash --json > out/$f.replay
    trim3r info --json a.mcap > out/$f.info
    rm a.mcap
done
# colour and depth from two nodes, which know nothing of each other
capture --depth-source /dev/video1 --depth-size 320x180 --rate 30 --frames 90 --hash -o a.mcap > out/pairs.live
trim3r capture --source replay:a.mcap --hash --json > out/pairs.replay
trim3r info --json a.mcap > out/pairs.info
# faults, while it runs
capture --rate 30 --seconds 14 --stall 1000 --reconnect 10 -o a.mcap > out/faults.live 2> out/faults.told &
sleep 2
for control in 0x00f0f042 0x00f0f044 0x00f0f046 0x00f0f041; do
    inject /dev/video0 $control 1
    sleep 2.5
done
wait $!
echo $? > out/faults.rc
trim3r info --json a.mcap > out/faults.info
# faults of opening: refused once, told, and good the next time
for control in 0x00f0f043 0x00f0f045; do
    inject /dev/video0 $control 1
    capture --frames 3 -o b.mcap > /dev/null 2>> out/refused.told
    echo $? >> out/refused.rc
    capture --frames 3 --json -o b.mcap > /dev/null 2>> out/refused.told
    echo $? >> out/refused.rc
done
# half of the images dropped by the driver; all of them: a camera that stands still
inject /dev/video0 0x00f0f040 50
capture --rate 60 --frames 60 -o b.mcap > out/dropping.live
inject /dev/video0 0x00f0f040 100
capture --rate 60 --frames 60 --stall 1000 --reconnect 1 -o b.mcap > out/still.live 2> out/still.told
echo $? > out/still.rc
inject /dev/video0 0x00f0f040 0
trim3r info --json b.mcap > out/still.info
trim3r capture --list > out/list
"""


def check(condition, text):
    global checks
    checks += 1
    if not condition:
        print(f"FAILED: {text}")
        for name in ("log", "faults.told", "refused.told", "still.told"):
            print(f"--- {name}\n{files.get(name, b'').decode(errors='replace')[-1500:]}")
        sys.exit(1)


def got(name):
    check(name in files and files[name].strip(), f"{name} is there")
    return json.loads(files[name])


os.makedirs(FOLDER, exist_ok=True)
here = os.path.dirname(os.path.abspath(__file__))
inject = f"{FOLDER}/inject"
if subprocess.run(["cc", "-O1", "-o", inject, f"{here}/inject.c"]).returncode != 0:
    machine.skip("no C compiler")
start = time.monotonic()
files, accelerator, said = machine.run(FOLDER, [TRIM3R, inject], JOB, 600)
if "log" not in files:
    print(f"FAILED: the machine ({accelerator}) did not come to its end:\n{said[-2000:]}")
    sys.exit(1)

print("| format | frames | dropped | frames/s | latency, mean / worst ms | a frame's work, mean / worst ms |")
print("|---|---|---|---|---|---|")
for name in FORMATS:
    live, replay, info = got(f"{name}.live"), got(f"{name}.replay"), got(f"{name}.info")
    check(live["frames"] == FRAMES and live["corrupted"] == 0 and live["clock"] == "monotonic", f"{name}: {live}")
    check(replay["frames_hash"] == live["frames_hash"], f"{name}: the replay's hash is the live one")
    check(info["frames"] == FRAMES and info["note"] == "", f"{name}: {info['note']}")
    # vivid's stamps are of an ideal clock, which may run ahead
    latency = "{mean:.1f} / {worst:.1f}".format(**live["latency_ms"]) if "latency_ms" in live else "-"
    print(f"| {name} | {live['frames']} | {live['dropped_driver']} + {live['dropped_slow']} | {live['rate']:.1f} | "
          f"{latency} | "
          f"{live['frame_ms']['mean']:.2f} / {live['frame_ms']['worst']:.2f} |")

live, replay, info = got("pairs.live"), got("pairs.replay"), got("pairs.info")
check(live["frames"] == 90 and live["paired"] + live["alone"] == 90 and live["paired"] >= 80, f"pairs: {live}")
check(replay["frames_hash"] == live["frames_hash"] and info["depth_frames"] == live["paired"], "and in the replay")
told = next(s["messages"] for s in info["streams"] if s["topic"] == "/camera/events")
check(told >= 90, f"every decision is told: {told}")
print(f"pairs: {live['paired']} of 90, colour alone {live['alone']}, depth unused {live['depth_dropped']}")

live = got("faults.live")
told = files["faults.told"].decode()
check(files["faults.rc"].strip() == b"0", "the capture outlives every fault")
check(live["corrupted"] >= 1, f"an image with the error flag: {live}")
check(live["faults"] >= 1, f"a buffer that was refused: {live}")
check(live["reopened"] >= 2, f"a queue in error and a disconnect, both overcome: {live}")
check("Input/output error" in told or "in error" in told, f"the fatal error is told: {told}")
check("No such device" in told, f"the disconnect is told: {told}")
check(got("faults.info")["frames"] == live["frames"], "no frame is lost that was delivered")
check(files["refused.rc"].split() == [b"1", b"0", b"1", b"0"], f"refusals: {files['refused.rc']}")
told = files["refused.told"].decode()
check("no buffers" in told and "does not start" in told, told)
live = got("dropping.live")
check(live["frames"] == 60 and live["dropped_driver"] + live["dropped_slow"] >= 20, f"dropped images are told: {live}")
check(files["still.rc"].strip() == b"1" and b"no image for" in files["still.told"], "a camera that stands still")
check(b"vivid" in files["list"], f"--list: {files['list']}")
print(f"{checks} checks, {accelerator}, {time.monotonic() - start:.0f} s")
