#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""opencv.py TRIM3R MODULE INJECT FOLDER: the kernel's virtual camera vivid through OpenCV and through V4L2, in a
virtual machine: the same samples where OpenCV converts nothing, others where it does. MODULE is OpenCV's adapter."""
import sys

from trial import Trial
import mcap_read

TRIM3R, MODULE, INJECT, FOLDER = sys.argv[1:5]

# the driver's bars without its clock: all images are equal
JOB = """
vivid_inject /dev/video0 0x00f0f001 2
trim3r capture --source v4l2:/dev/video0 --size 320x180 --format BGR3 --frames 2 --json -o out/ours.mcap > out/ours
for f in BGR3 YUYV; do
    trim3r capture --source opencv:/dev/video0 --backend V4L2 --size 320x180 --format $f --frames 2 --json \\
        -o out/$f.mcap > out/$f
done
"""

trial = Trial(FOLDER, [TRIM3R, MODULE, INJECT], JOB, "vivid", megabytes=1536)
check = trial.check


def last_image(name):
    return [mcap_read.image(m) for t, _, m in mcap_read.messages(trial.files[name]) if t == "/camera/image"][-1]


check(trial.json("ours")["frames"] == 2, "by V4L2")
for name in ("BGR3", "YUYV"):
    told = trial.json(name)
    check(told["frames"] == 2 and told["format"] == "bgr24" and "V4L2" in told["note"], f"{name}: {told}")
*kind, ours = last_image("ours.mcap")
check((kind, len(ours)) == ([180, 320, "bgr8"], 180 * 320 * 3), f"{kind}")
check(last_image("BGR3.mcap") == (*kind, ours), "BGR comes as it is: the same samples, so the same Gaussians")
*kind, converted = last_image("YUYV.mcap")
check(kind[2] == "bgr8" and len(converted) == len(ours), "YUYV comes as OpenCV's BGR")
differing = sum(a != b for a, b in zip(ours, converted))
worst = max(abs(a - b) for a, b in zip(ours, converted))
print(f"YUYV converted by OpenCV: {differing} of {len(ours)} samples differ from the driver's own BGR, by {worst}")
trial.done()
