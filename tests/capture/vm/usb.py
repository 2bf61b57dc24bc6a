#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usb.py TRIM3R USB_CAMERA FOLDER MJPG [MODULE]: capture from a USB camera with the driver uvcvideo, in a virtual
machine with a virtual USB bus (vhci_hcd). USB_CAMERA is the camera; every image that it sends is known, so every
recorded image is checked, and every missing one must have been reported. MJPG is 1 if Motion JPEG can be read;
MODULE is libcamera's adapter, which is then tested too."""
import random
import re
import struct
import sys

from trial import RECORD, Trial
import flat_jpeg
import machine
import mcap_read

TRIM3R, USB_CAMERA, FOLDER, MJPG = sys.argv[1:5]
MODULE = sys.argv[5:6]
WIDTH, HEIGHT = 160, 120  # camera.h
PICTURES, STEP = 64, 16   # frame F of stream S shows picture STEP x S + F: stream.h

numbers = random.Random(1)
# rows are windows of one row: all images differ, and are small when compressed
row = numbers.randbytes(4 * WIDTH)
starts = [numbers.sample(range(2 * WIDTH), HEIGHT) for _ in range(PICTURES)]
yuyv = [b"".join(row[start:start + 2 * WIDTH] for start in picture) for picture in starts]
blocks = [[[tuple(numbers.randrange(256) for _ in range(4)) for _ in range(WIDTH // 16)] for _ in range(HEIGHT // 8)]
          for _ in range(PICTURES)]
jpegs = [flat_jpeg.jpeg(WIDTH, HEIGHT, picture) for picture in blocks]

# The camera's faults follow `plug`, as STREAM.FRAME; its streams count from there.
JOB = f"""{RECORD}
plug() {{
    usb_camera /data/yuyv /data/jpegs "$@" 2>> out/camera &
    for i in $(seq 100); do [ -e /dev/video0 ] && break; sleep 0.1; done
}}
unplug() {{
    kill $!
    for i in $(seq 100); do [ -e /dev/video0 ] || break; sleep 0.1; done
}}
# the recording stays, and the status
keep() {{
    name=$1
    record "$@"
    echo $status > out/$name.rc
    mv a.mcap out/$name.mcap
}}
# buffers for half a second, in which this machine may be held up
camera="--source v4l2:/dev/video0 --size {WIDTH}x{HEIGHT} --buffers 16"
# as a rule the driver keeps damaged images to itself; of a JPEG it does not know that it is cut
plug 0.20=error 0.30=cut 1.3=stall 2.0=stall 3.0=stall 4.0=stall 5.0=stall
keep yuyv $camera --format YUYV --frames 40
keep still $camera --format YUYV --frames 40 --stall 400 --reconnect 1
unplug
if [ {MJPG} = 1 ]; then
    plug 0.7=cut
    keep mjpg $camera --format MJPG --frames 15
    unplug
fi
# with nodrop it hands them on, marked
echo 1 > /sys/module/uvcvideo/parameters/nodrop
plug 0.5=error 0.9=cut 0.14=stall 1.6=unplug 3.4=leave
trim3r capture --list > out/list
keep faults $camera --format YUYV --frames 30 --stall 1500
keep left $camera --format YUYV --frames 30 --reconnect 1
"""

LIBCAMERA = f"""
# libcamera names a camera after its controller's node in the firmware's tables, which a virtual one has not: a folder
# that has one about the controller's own
mkdir -p platform/vhci_hcd.0 platform/firmware_node
echo '\\_SB.VHCI' > platform/firmware_node/path
mount -o bind /sys/devices/platform/vhci_hcd.0 platform/vhci_hcd.0
mount -o rbind platform /sys/devices/platform
# it hears of cameras from udevd
ln -s udevadm /bin/systemd-udevd
systemd-udevd --daemon
plug 0.5=error 0.9=cut 0.14=unplug 1.6=stall 3.4=unplug 5.6=unplug
udevadm settle -t 10
export LIBCAMERA_LOG_LEVELS=*:ERROR
camera="--source libcamera:0 --size {WIDTH}x{HEIGHT} --format YUYV"
trim3r capture --list > out/libcamera.list
keep libcamera $camera --frames 30 --stall 1500
# which it does not where udevd is on the other side of a container's wall; there the camera leaves once while its
# images are waited for, and once while they are not: the program is stopped after its first images until then
through="unshare -n"
keep unheard $camera --frames 10 --stall 1500
(for i in $(seq 300); do [ $(cat a.mcap* 2> /dev/null | wc -c) -gt 30000 ] && break; sleep 0.1; done
    kill -STOP $(pidof trim3r)
    for i in $(seq 100); do [ -z "$(ls /sys/class/video4linux)" ] && break; sleep 0.1; done
    kill -CONT $(pidof trim3r)) &
keep unseen $camera --frames 10 --stall 1500
"""


def account(name, pictures, stream=0, starts_late=False):
    """Checks that every recorded image is the one that the camera sent at its place, and that an event reports each
    missing one. Returns {(stream, frame): reason} of the missing images, and the events of no frame. A source
    that starts late counts from the first image that it gets."""
    frame, late, empty, missing, others = 0, 0, True, {}, []
    for topic, _, message in mcap_read.messages(trial.files[f"{name}.mcap"]):
        if topic == "/camera/events":
            told = mcap_read.log(message)[2]
            broken = re.fullmatch(r"frame (\d+) left out: (.*)", told)
            dropped = re.fullmatch(r"(\d+) (dropped .*before) colour (\d+).*", told)
            if broken:
                trial.check(int(broken[1]) == frame, f"{name}: {told}, not {frame}")
                missing[stream, late + frame] = broken[2]
                frame += 1
            elif dropped:
                trial.check(int(dropped[3]) == frame + int(dropped[1]), f"{name}: {told}, not {frame}")
                missing.update({(stream, late + frame + i): dropped[2] for i in range(int(dropped[1]))})
                frame = int(dropped[3])
            else:
                others.append(told)
            if told == "opened again":
                stream, frame, late, empty = stream + 1, 0, 0, True
        elif topic == "/camera/image":
            samples = mcap_read.image(message)[3]
            if empty and starts_late:
                late = next((i for i in range(5) if samples == pictures[(STEP * stream + i) % PICTURES]), 0)
            trial.check(samples == pictures[(STEP * stream + late + frame) % PICTURES],
                        f"{name}: frame {frame} of stream {stream} is as it was sent")
            frame, empty = frame + 1, False
    return missing, others


def lost(others):
    return [told for told in others if told != "opened again"]


def faults(name, first_loss, second_loss, broken, starts_late=False):
    """Checks a run through an error bit, a truncated image and two losses of the camera, which it survives."""
    live = trial.recorded(name, 30)
    missing, others = account(name, yuyv, starts_late=starts_late)
    trial.check(missing.get((0, 5)) == missing.get((0, 9)) == broken, f"{name}: {missing}")
    trial.check(live["corrupted"] == 2 and live["reopened"] == 2, f"{name}: {live}")
    trial.check(live["dropped_driver"] + live["dropped_slow"] == len(missing) - 2, f"{name}: {live} {missing}")
    first, second = lost(others)
    trial.check(re.search(first_loss, first) and re.search(second_loss, second), f"{name}: {others}")
    print(f"{name}: {live['rate']:.1f} frames/s, without {missing}; {others}")


def left(name, stream, words):
    """Checks that a camera gone for good, or one that does not recover, is reported, and that the recording has the
    earlier images."""
    _, others = account(name, yuyv, stream)
    trial.check(trial.text(f"{name}.rc").strip() == "1" and words in lost(others)[0], f"{name}: {others}")
    trial.check("not back within 1 s" in trial.text(f"{name}.told"), trial.text(f"{name}.told"))
    trial.check(trial.json(f"{name}.info")["frames"] > 0, trial.text(f"{name}.info"))


runs = ["yuyv", "mjpg", "still", "faults", "left", "libcamera", "unheard", "unseen"]
programs = [TRIM3R, USB_CAMERA, *MODULE, *([machine.unpack_udev(FOLDER)] if MODULE else [])]
trial = Trial(FOLDER, programs, JOB + (LIBCAMERA if MODULE else ""), "uvcvideo",
              ("camera", *(f"{name}.told" for name in runs)),
              data={"/data/yuyv": b"".join(yuyv),
                    "/data/jpegs": b"".join(struct.pack("<I", len(jpeg)) + jpeg for jpeg in jpegs)})

trial.check("test camera (uvcvideo): YUYV" in trial.text("list"), f"--list: {trial.text('list')}")
live = trial.recorded("yuyv", 40)
missing, others = account("yuyv", yuyv)
dropped = live["dropped_driver"] + live["dropped_slow"]
trial.check({(0, 20), (0, 30)} <= missing.keys() and dropped == len(missing), f"yuyv: {missing} {live}")
trial.check(live["corrupted"] == 0 and live["clock"] == "monotonic" and not others, f"yuyv: {live}")
print(f"yuyv: {live['rate']:.1f} frames/s, without {missing}")
left("still", 1, "no image for")
if MJPG == "1":
    live = trial.recorded("mjpg", 15)
    missing, _ = account("mjpg", [flat_jpeg.decoded(picture) for picture in blocks])
    trial.check("premature end" in missing.get((0, 7), "").lower() and live["corrupted"] == 1, f"mjpg: {missing} {live}")
    print(f"mjpg: {live['rate']:.1f} frames/s, without {missing}")
faults("faults", "no image for", "No such device", "the driver calls it corrupted")
left("left", 3, "No such device")
if MODULE:
    trial.check("libcamera:0" in trial.text("libcamera.list"), trial.text("libcamera.list"))
    faults("libcamera", "was unplugged|takes no buffers", "no image for", "the library calls it failed",
           starts_late=True)
    for name, stream, words in (("unheard", 3, "no image for|takes no buffers"), ("unseen", 5, "no image for|takes no buffers")):
        live = trial.recorded(name, 10)
        missing, others = account(name, yuyv, stream, starts_late=True)
        trial.check(live["reopened"] == 1 and re.search(words, lost(others)[0]), f"{name}: {missing} {others}")
        print(f"{name}: {live['rate']:.1f} frames/s, without {missing}; {others}")
trial.done()
