#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""vimc.py TRIM3R MODULE FOLDER [FRAMES]: capture with libcamera from the kernel's virtual camera vimc, in a virtual
machine: frames of its formats recorded and replayed with the same hash. MODULE is libcamera's adapter."""
import glob
import sys

from trial import RECORD, Trial, skip

TRIM3R, MODULE, FOLDER = sys.argv[1:4]
FRAMES = int(sys.argv[4]) if len(sys.argv) > 4 else 30
FORMATS = ("BGR3", "RGB3")

JOB = f"""{RECORD}
# libcamera asks udev what there is, which is not running: everything is, and known
mkdir -p /run/udev/data
touch /run/udev/control
for f in /sys/class/video4linux/*/dev /sys/bus/media/devices/*/dev; do
    echo I:1000000 > /run/udev/data/c$(cat $f)
done
export LIBCAMERA_LOG_LEVELS=*:ERROR
trim3r capture --list > out/list
for f in {" ".join(FORMATS)}; do
    record $f --source libcamera:0 --size 640x480 --format $f --frames {FRAMES} --seconds 60
done
trim3r capture --source libcamera:7 --frames 1 --hash 2> out/refused
echo $? >> out/refused
trim3r capture --source libcamera:0 --format GREY --frames 1 --hash 2>> out/refused
echo $? >> out/refused
"""

ipa = glob.glob("/usr/lib/*/libcamera/ipa_vimc.so*") + glob.glob("/usr/share/libcamera/ipa/vimc/*")
if not ipa:
    skip("libcamera-ipa is not there (tools/setup --cameras)")
trial = Trial(FOLDER, [TRIM3R, MODULE], JOB, "vimc", files=ipa)
trial.check("libcamera:0" in trial.text("list"), f"--list: {trial.text('list')}")
for name in FORMATS:
    live = trial.recorded(name, FRAMES)
    trial.check(live["clock"] == "boottime", f"{name}: {live}")
    print(f"{name}: {live['width']}x{live['height']}, {live['frames']} frames, {live['rate']:.1f}/s, dropped "
          f"{live['dropped_driver']} + {live['dropped_slow']}, corrupted {live['corrupted']}")
told = trial.text("refused")
trial.check("no such camera" in told and "does not offer the format" in told and told.count("1\n") == 2, told)
trial.done()
