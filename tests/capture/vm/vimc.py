#!/usr/bin/env python3
"""vimc.py TRIM3R MODULE FOLDER [FRAMES]: capture by libcamera from the kernel's virtual camera vimc, in a virtual
machine: frames of its formats recorded and replayed with the same hash. MODULE is the adapter's."""
import glob
import json
import os
import sys
import time

import machine

TRIM3R, MODULE, FOLDER = map(os.path.abspath, sys.argv[1:4])
FRAMES = int(sys.argv[4]) if len(sys.argv) > 4 else 30
FORMATS = ("BGR3", "RGB3")
checks = 0

JOB = f"""
export LIBCAMERA_LOG_LEVELS=*:ERROR
trim3r capture --list > out/list
for f in {" ".join(FORMATS)}; do
    trim3r capture --source libcamera:0 --size 640x480 --format $f --frames {FRAMES} --seconds 60 --hash --json \\
        -o a.mcap > out/$f.live
    trim3r capture --source replay:a.mcap --hash --json > out/$f.replay
    trim3r info --json a.mcap > out/$f.info
    rm a.mcap
done
trim3r capture --source libcamera:7 --frames 1 --hash 2> out/refused
echo $? >> out/refused
trim3r capture --source libcamera:0 --format GREY --frames 1 --hash 2>> out/refused
echo $? >> out/refused
"""


def check(condition, text):
    global checks
    checks += 1
    if not condition:
        print(f"FAILED: {text}\n{files.get('log', b'').decode(errors='replace')[-3000:]}")
        sys.exit(1)


def got(name):
    check(name in files and files[name].strip(), f"{name} is there")
    return json.loads(files[name])


start = time.monotonic()
ipa = glob.glob("/usr/lib/*/libcamera/ipa_vimc.so*") + glob.glob("/usr/share/libcamera/ipa/vimc/*")
if not ipa:
    machine.skip("libcamera-ipa is not there (tools/setup --cameras)")
files, accelerator, said = machine.run(FOLDER, [TRIM3R, MODULE], JOB, 400, "vimc", ipa)
if "log" not in files:
    print(f"FAILED: the machine ({accelerator}) did not come to its end:\n{said[-3000:]}")
    sys.exit(1)
check(b"libcamera:0" in files["list"], f"--list: {files['list']}")
for name in FORMATS:
    live, replay, info = got(f"{name}.live"), got(f"{name}.replay"), got(f"{name}.info")
    check(live["frames"] == FRAMES and live["clock"] == "boottime", f"{name}: {live}")
    check(replay["frames_hash"] == live["frames_hash"], f"{name}: the replay's hash is the live one")
    check(info["frames"] == FRAMES and info["note"] == "", f"{name}: {info}")
    print(f"{name}: {live['width']}x{live['height']}, {live['frames']} frames, {live['rate']:.1f}/s, dropped "
          f"{live['dropped_driver']} + {live['dropped_slow']}, corrupted {live['corrupted']}")
told = files["refused"].decode()
check("no such camera" in told and "does not offer the format" in told and told.count("1\n") == 2, told)
print(f"{checks} checks, {accelerator}, {time.monotonic() - start:.0f} s")
