# SPDX-License-Identifier: Apache-2.0
"""Photos without poses: `import` names the remedy, takes the focal length from EXIF or estimates it, and `scene` makes a
scene of them, or of anything else that can be read, by commands that do the same when they are pasted.

photos.py TRIM3R
"""

import glob
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not there")
    sys.exit(77)

from checks import check, done  # noqa: E402
from folder_makers import quaternion
from frames import picture, read
from program import TRIM3R, expect, expect_json, run
import ros_bag as ros

WIDTH, HEIGHT, PHOTOS = 192, 144, 4
FOCAL_35MM = 30 # mm, nearest to the room's lens


def with_exif(data, orientation=1, focal=0):
    """Returns a PNG with EXIF: the orientation in its first directory, the focal length in its second."""
    first = struct.pack(">H HHIHH HHII I", 2, 0x112, 3, 1, orientation, 0, 0x8769, 4, 1, 38, 0)
    second = struct.pack(">H HHIHH I", 1, 0xA405, 3, 1, focal, 0, 0)
    tiff = b"MM\0*" + struct.pack(">I", 8) + first + second
    check(len(b"MM\0*") + 4 + len(first) == 38, "the second directory is elsewhere")
    chunk = b"eXIf" + tiff
    head = 8 + 25  # the signature and IHDR
    return data[:head] + struct.pack(">I", len(tiff)) + chunk + struct.pack(">I", zlib.crc32(chunk)) + data[head:]


def photos(name, change=lambda i, rgb: rgb, **exif):
    """Writes the room's pictures as a folder of photos."""
    os.makedirs(name)
    for i, rgb in enumerate(ROOM["image"]):
        with open(f"{name}/photo {i}.png", "wb") as file:
            file.write(with_exif(picture(np.ascontiguousarray(change(i, rgb))), **exif))
    return name


def blurred(rgb):
    out = rgb.astype(float)
    for _ in range(3):
        out = (np.roll(out, 1, 1) + out + np.roll(out, -1, 1)) / 3
    return out.astype(np.uint8)


def focal_lengths():
    photos("plain")
    for command in (["import", "plain"], ["build", "plain", "--keep", 10]):
        out = "no.mcap" if command[0] == "import" else "no.ply"
        message = run(*command, "-o", out)[2]
        check("--poses estimate" in message and (command[0] == "build" or "trim3r scene plain" in message), message)
    # by EXIF, also of pictures that are turned, and of those that do not state it
    photos("stated", focal=FOCAL_35MM)
    with open("stated/photo 1.png", "wb") as file:
        file.write(picture(ROOM["image"][1]))
    with open("stated/photo 2.png", "wb") as file: # stored lying; turned clockwise by 90 degrees it is upright
        file.write(with_exif(picture(np.ascontiguousarray(np.rot90(ROOM["image"][2]))), 6, FOCAL_35MM))
    report = expect_json("import", "stated", "--poses", "estimate", "-o", "stated.mcap")
    check(f"by EXIF of {PHOTOS - 1} of {PHOTOS} pictures, the first {FOCAL_35MM} mm" in report["focal_length"], f"EXIF: {report}")
    got = read("stated.mcap")
    fx = FOCAL_35MM * np.hypot(WIDTH, HEIGHT) / np.hypot(36, 24)
    check(np.abs(np.stack(got["camera_info"])[:, 0, 0] - fx).max() < 1e-3, f"fx is {got['camera_info'][0][0, 0]}, not {fx}")
    check(np.array_equal(got["image"][2], ROOM["image"][2]), "a picture is not turned upright")
    # estimated
    report = expect_json("import", "plain", "--poses", "estimate", "-o", "plain.mcap")
    check("estimated from the pictures" in report["focal_length"], f"an estimate: {report}")
    fx, known = read("plain.mcap")["camera_info"][0][0, 0], ROOM["camera_info"][0][0, 0]
    check(abs(fx / known - 1) < 0.12, f"the estimated focal length is {fx}, not {known}")


def pasted(*arguments):
    """Runs the lines of --dry-run in a shell; returns them."""
    lines = expect(0, "scene", *arguments, "--dry-run")
    bin_folder = os.path.dirname(TRIM3R)
    subprocess.run(["sh", "-ec", lines], check=True, stdout=subprocess.DEVNULL, timeout=300,
                   env={**os.environ, "PATH": f"{bin_folder}:{os.environ['PATH']}"})
    return lines.splitlines()


def scene_of_photos():
    photos("my photos", lambda i, rgb: blurred(rgb) if i == 3 else rgb, focal=FOCAL_35MM)
    os.makedirs("temporary")
    os.environ["TMPDIR"] = os.path.abspath("temporary")
    report = expect_json("scene", "my photos", "-o", "scene.ply")
    check(os.listdir("temporary") == [], f"a recording is left: {os.listdir('temporary')}")
    drawn = {p["name"]: p for p in report["pictures"]}
    check(sorted(drawn) == [f"photo {i}.png" for i in range(PHOTOS)], f"pictures: {sorted(drawn)}")
    check([name for name, p in drawn.items() if p["blurred"]] == ["photo 3.png"], f"blurred: {report}")
    check(sum(p["chosen"] for p in drawn.values()) >= 2, f"chosen: {report}")
    check(all(p["psnr"] > 22 for p in drawn.values() if p["chosen"] and not p["blurred"]), f"drawn: {report}")
    check(report["posed_frames"] == PHOTOS and report["depth"] == "stereo" and report["estimated"], f"{report}")
    with open("scene.ply", "rb") as file:
        scene = file.read()
    os.unlink("scene.ply")
    lines = pasted("my photos", "-o", "scene.ply")
    check([line.split()[1] for line in lines] == ["import", "build"], f"the commands: {lines}")
    with open("scene.ply", "rb") as file:
        check(file.read() == scene, "the pasted commands make another scene")
    code, _, message = run("scene", "room.mcap", "-o", "page.html")
    check((code == 0 and os.path.getsize("page.html") > 100000) or "without the page" in message, f"a page: {code} {message}")
    text = expect(0, "scene", "my photos", "--recording", "kept.mcap", "--size", "96x72", "--keep", "5%", "-o", "small.spz")
    check(len(text.splitlines()) == 5 and "photo 3.png" in text, f"not five lines: {text}")
    check(read("kept.mcap")["image"][0].shape == (72, 96, 3), "--size")


def scene_of_others():
    # a recording with poses and depth is not imported
    lines = pasted("room.mcap", "-o", "sensed.ply")
    check(len(lines) == 1 and "stereo" not in lines[0], f"a recording: {lines}")
    report = expect_json("scene", "room.mcap", "-o", "sensed.ply")
    check(report["depth"] == "sensor" and not report["estimated"] and
          all(p["psnr"] > 25 for p in report["pictures"] if p["chosen"]), f"a recording: {report}")
    # a folder of a known kind
    os.makedirs("posed")
    frames = []
    for i, rgb in enumerate(ROOM["image"]):
        with open(f"posed/{i}.png", "wb") as file:
            file.write(picture(rgb))
        frames.append({"file_path": f"{i}.png", "transform_matrix": (ROOM["pose"][i] @ np.diag([1, -1, -1, 1])).tolist()})
    k = ROOM["camera_info"][0]
    with open("posed/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"frames": frames, "fl_x": k[0, 0], "cx": k[0, 2] + 0.5, "cy": k[1, 2] + 0.5}, file)
    report = expect_json("scene", "posed", "-o", "posed.ply")
    check(report["kind"] == "transforms.json" and report["depth"] == "stereo" and not report["estimated"], f"a folder: {report}")
    check("--poses" not in expect(0, "scene", "posed", "--dry-run", "-o", "posed.ply"), "given poses are estimated")
    # a bag
    bag = ros.Bag()
    for i, rgb in enumerate(ROOM["image"]):
        ns, place, (w, x, y, z) = (i + 1) * ros.SECOND, ROOM["pose"][i][:3, 3], quaternion(ROOM["pose"][i])
        bag.put("/cam/camera_info", ros.INFO, ns, ros.info(ns, "cam", (k[0, 0], k[1, 1], k[0, 2], k[1, 2]), (WIDTH, HEIGHT)))
        bag.put("/pose", ros.POSE, ns, ros.pose(ns, "map", place, (x, y, z, w)))
        bag.put("/cam/image_raw", ros.IMAGE, ns, ros.image(ns, "cam", "rgb8", rgb))
    bag.write("bag.mcap")
    report = expect_json("scene", "bag.mcap", "-o", "bag.ply")
    check(report["posed_frames"] == PHOTOS and not report["estimated"] and report["depth"] == "stereo" and
          all(p["psnr"] > 22 for p in report["pictures"] if p["chosen"]), f"a bag: {report}")
    # what cannot become a scene
    os.makedirs("one")
    shutil.copy(glob.glob("plain/*.png")[0], "one/a.png")
    expect(1, "scene", "one", "-o", "no.ply", err="two or more are needed")
    os.makedirs("none")
    expect(1, "scene", "none", "-o", "no.ply", err="no pictures")
    expect(1, "scene", "absent", "-o", "no.ply", err="No such file")
    expect(2, "scene", "plain", "-o", "no.txt", err="no.txt")
    expect(2, "scene", "plain", "--keep", 5, "--gaussians", 5, "-o", "no.ply", err="exclude each other")
    expect(0, "scene", "room.mcap", "--min-psnr", 20, "-o", "few.ply")
    check(not glob.glob("no.*"), f"files are left: {glob.glob('no.*')}")


with tempfile.TemporaryDirectory(prefix="trim3r-photos-") as folder:
    os.chdir(folder)
    expect(0, "room", "--frames", PHOTOS, "--size", f"{WIDTH}x{HEIGHT}", "-o", "room.mcap")
    ROOM = read("room.mcap")
    focal_lengths()
    scene_of_photos()
    scene_of_others()
    os.chdir("/")
done()
