#!/usr/bin/env python3
"""opencv.py TRIM3R MODULE FOLDER: the kernel's virtual camera vivid through OpenCV and through V4L2, in a virtual
machine: the same samples where OpenCV converts nothing, others where it does. MODULE is OpenCV's adapter."""
import json
import os
import subprocess
import sys
import time

import machine

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import mcap_read  # noqa: E402

TRIM3R, MODULE, FOLDER = map(os.path.abspath, sys.argv[1:4])
checks = 0

# the driver's bars without its clock: every image is the same
JOB = """
inject /dev/video0 0x00f0f001 2
trim3r capture --source v4l2:/dev/video0 --size 320x180 --format BGR3 --frames 2 --json -o out/ours.mcap > out/ours
for f in BGR3 YUYV; do
    trim3r capture --source opencv:/dev/video0 --backend V4L2 --size 320x180 --format $f --frames 2 --json \\
        -o out/$f.mcap > out/$f
done
"""


def check(condition, text):
    global checks
    checks += 1
    if not condition:
        print(f"FAILED: {text}\n{files.get('log', b'').decode(errors='replace')[-3000:]}")
        sys.exit(1)


def image(name):
    """The last image of a recording: its encoding, its bytes."""
    message = [m for topic, _, m in mcap_read.messages(files[name]) if topic == "/camera/image"][-1]
    cdr = mcap_read.Cdr(message)
    mcap_read.stamp(cdr)
    cdr.string()
    size = cdr.number("I"), cdr.number("I")
    encoding = cdr.string()
    cdr.number("B")
    cdr.number("I")
    count = cdr.number("I")
    return size, encoding, cdr.data[cdr.at:cdr.at + count]


start = time.monotonic()
here = os.path.dirname(os.path.abspath(__file__))
os.makedirs(FOLDER, exist_ok=True)
if subprocess.run(["cc", "-O1", "-o", f"{FOLDER}/inject", f"{here}/inject.c"]).returncode != 0:
    machine.skip("no C compiler")
files, accelerator, said = machine.run(FOLDER, [TRIM3R, MODULE, f"{FOLDER}/inject"], JOB, 500, megabytes=1536)
if "log" not in files:
    print(f"FAILED: the machine ({accelerator}) did not come to its end:\n{said[-3000:]}")
    sys.exit(1)
check("ours" in files and json.loads(files["ours"])["frames"] == 2, "by V4L2")
for name in ("BGR3", "YUYV"):
    check(files.get(name, b"").strip() != b"", f"{name} by OpenCV")
    told = json.loads(files[name])
    check(told["frames"] == 2 and told["format"] == "bgr24" and "V4L2" in told["note"], f"{name}: {told}")
size, encoding, ours = image("ours.mcap")
check((size, encoding, len(ours)) == ((180, 320), "bgr8", 180 * 320 * 3), f"{size} {encoding}")
check(image("BGR3.mcap") == (size, encoding, ours), "BGR comes as it is: the same samples, so the same Gaussians")
size, encoding, converted = image("YUYV.mcap")
check(encoding == "bgr8" and len(converted) == len(ours), "YUYV comes as OpenCV's BGR")
differing = sum(a != b for a, b in zip(ours, converted))
worst = max(abs(a - b) for a, b in zip(ours, converted))
print(f"YUYV converted by OpenCV: {differing} of {len(ours)} samples differ from the driver's own BGR, by {worst}")
print(f"{checks} checks, {accelerator}, {time.monotonic() - start:.0f} s")
