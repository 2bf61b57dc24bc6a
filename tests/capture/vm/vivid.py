#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""vivid.py TRIM3R INJECT FOLDER [FRAMES]: capture with V4L2 from the kernel's own virtual camera, in a virtual
machine: frames of every pixel format recorded and replayed with the same hash, then every fault that the driver
can inject."""
import sys

from trial import RECORD, Trial

TRIM3R, INJECT, FOLDER = sys.argv[1:4]
FRAMES = int(sys.argv[4]) if len(sys.argv) > 4 else 1000
FORMATS = ("YUYV", "UYVY", "NV12", "RGB3", "BGR3", "GREY")

# vivid's controls: the colour bars are quick to draw; faults are injected one by one
JOB = f"""{RECORD}
camera="--source v4l2:/dev/video0 --size 320x180"
capture() {{ trim3r capture $camera --json --quiet "$@"; }}
vivid_inject /dev/video0 0x00f0f001 2
for f in {" ".join(FORMATS)}; do
    record $f $camera --format $f --rate 120 --frames {FRAMES} --buffers 16
done
# colour and depth from two nodes, which know nothing of each other
record pairs $camera --depth-source /dev/video1 --depth-size 320x180 --rate 30 --frames 90
# faults, while it runs
capture --rate 30 --seconds 14 --stall 1000 --reconnect 10 -o a.mcap > out/faults.live 2> out/faults.told &
sleep 2
for control in 0x00f0f042 0x00f0f044 0x00f0f046 0x00f0f041; do
    vivid_inject /dev/video0 $control 1
    sleep 2.5
done
wait $!
echo $? > out/faults.rc
trim3r info --json a.mcap > out/faults.info
# faults of opening: refused once, told, and good the next time
for control in 0x00f0f043 0x00f0f045; do
    vivid_inject /dev/video0 $control 1
    capture --frames 3 -o b.mcap > /dev/null 2>> out/refused.told
    echo $? >> out/refused.rc
    capture --frames 3 --json -o b.mcap > /dev/null 2>> out/refused.told
    echo $? >> out/refused.rc
done
# half of the images dropped by the driver; all of them: a camera that stands still
vivid_inject /dev/video0 0x00f0f040 50
capture --rate 60 --frames 60 -o b.mcap > out/dropping.live
vivid_inject /dev/video0 0x00f0f040 100
capture --rate 60 --frames 60 --stall 1000 --reconnect 1 -o b.mcap > out/still.live 2> out/still.told
echo $? > out/still.rc
vivid_inject /dev/video0 0x00f0f040 0
trim3r info --json b.mcap > out/still.info
trim3r capture --list > out/list
"""

trial = Trial(FOLDER, [TRIM3R, INJECT], JOB, "vivid", ("faults.told", "refused.told", "still.told"))
check = trial.check

print("| format | frames | dropped | frames/s | latency, mean / worst ms | a frame's work, mean / worst ms |")
print("|---|---|---|---|---|---|")
for name in FORMATS:
    live = trial.recorded(name, FRAMES)
    check(live["corrupted"] == 0 and live["clock"] == "monotonic", f"{name}: {live}")
    # vivid's stamps come from an ideal clock, which may be ahead
    latency = "{mean:.1f} / {worst:.1f}".format(**live["latency_ms"]) if "latency_ms" in live else "-"
    print(f"| {name} | {live['frames']} | {live['dropped_driver']} + {live['dropped_slow']} | {live['rate']:.1f} | "
          f"{latency} | "
          f"{live['frame_ms']['mean']:.2f} / {live['frame_ms']['worst']:.2f} |")

live, info = trial.recorded("pairs", 90), trial.json("pairs.info")
check(live["paired"] + live["alone"] == 90 and live["paired"] >= 80, f"pairs: {live}")
check(info["depth_frames"] == live["paired"], "and in the recording")
told = next(s["messages"] for s in info["streams"] if s["topic"] == "/camera/events")
check(told >= 90, f"every decision is told: {told}")
print(f"pairs: {live['paired']} of 90, colour alone {live['alone']}, depth unused {live['depth_dropped']}")

live, told = trial.json("faults.live"), trial.text("faults.told")
check(trial.text("faults.rc").strip() == "0", "the capture outlives every fault")
check(live["corrupted"] >= 1, f"an image with the error flag: {live}")
check(live["faults"] >= 1, f"a buffer that was refused: {live}")
check(live["reopened"] >= 2, f"a queue in error and a disconnect, both overcome: {live}")
check("Input/output error" in told or "in error" in told, f"the fatal error is told: {told}")
check("No such device" in told, f"the disconnect is told: {told}")
check(trial.json("faults.info")["frames"] == live["frames"], "no frame is lost that was delivered")
check(trial.text("refused.rc").split() == ["1", "0", "1", "0"], f"refusals: {trial.text('refused.rc')}")
told = trial.text("refused.told")
check("no buffers" in told and "does not start" in told, told)
live = trial.json("dropping.live")
check(live["frames"] == 60 and live["dropped_driver"] + live["dropped_slow"] >= 20, f"dropped images are told: {live}")
check(trial.text("still.rc").strip() == "1" and "no image for" in trial.text("still.told"),
      "a camera that stands still")
check("vivid" in trial.text("list"), f"--list: {trial.text('list')}")
trial.done()
