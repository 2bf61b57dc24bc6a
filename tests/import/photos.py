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


def directory(entries, at):
    """Returns a directory of TIFF that begins at that byte, with ratios (type 5) after it."""
    after, body = at + 2 + 12 * len(entries) + 4, struct.pack(">H", len(entries))
    for i, (tag, kind, value) in enumerate(entries):
        body += struct.pack(">HHIHH" if kind == 3 else ">HHII", tag, kind, 1, *((value, 0) if kind == 3 else
                            (value if kind == 4 else after + 8 * i,)))
    return body + bytes(4) + b"".join(struct.pack(">II", *value) if kind == 5 else bytes(8) for _, kind, value in entries)


def with_exif(data, orientation=1, focal=0, sensor=()):
    """Returns a PNG with EXIF: the orientation in its first directory; in its second the focal length in terms of 35 mm
    film, or entries for focal length and sensor."""
    second = sensor or ((0xA405, 3, focal),)
    first = directory(((0x112, 3, orientation), (0x8769, 4, 54)), 8)
    tiff = b"MM\0*" + struct.pack(">I", 8) + first + directory(second, 54)
    check(8 + len(first) == 54, "the second directory is elsewhere")
    chunk = b"eXIf" + tiff
    head = 8 + 25  # the signature and IHDR
    return data[:head] + struct.pack(">I", len(tiff)) + chunk + struct.pack(">I", zlib.crc32(chunk)) + data[head:]


def by_sensor(unit_mm, *unit, width=(0xA002, 4, WIDTH)):
    """Returns entries that state the same focal length by a lens of 4.5 mm and the pixels in a unit of the sensor."""
    per_unit = round(1000 * FOCAL_35MM / 4.5 * np.hypot(WIDTH, HEIGHT) / np.hypot(36, 24) * unit_mm)
    return ((0x920A, 5, (45, 10)), width, (0xA003, 3, HEIGHT), (0xA20E, 5, (per_unit, 1000)), *unit)


def photos(name, change=lambda i, rgb: rgb, **exif):
    """Writes the room's pictures as a folder of photos."""
    os.makedirs(name)
    for i, rgb in enumerate(ROOM["image"]):
        with open(f"{name}/photo {i}.png", "wb") as file:
            file.write(with_exif(picture(np.ascontiguousarray(change(i, rgb))), **exif))
    return name


def sensors(name, *entries):
    """Writes a folder of photos, each with its own entries in EXIF."""
    os.makedirs(name)
    for i, (rgb, stated) in enumerate(zip(ROOM["image"], entries, strict=True)):
        with open(f"{name}/photo {i}.png", "wb") as file:
            file.write(with_exif(picture(rgb), sensor=stated))


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
    # by the sensor, in inches, which is the usual unit, or in others
    centimetres = (0xA210, 3, 3)
    sensors("sensors", by_sensor(25.4), by_sensor(10, centimetres), by_sensor(1, (0xA210, 3, 4)),
            by_sensor(10, centimetres, width=(0xA002, 3, WIDTH)))
    report = expect_json("import", "sensors", "--poses", "estimate", "-o", "sensors.mcap")
    check(f"by EXIF of {PHOTOS} of {PHOTOS} pictures, the first {FOCAL_35MM} mm" in report["focal_length"], f"sensors: {report}")
    found = np.stack(read("sensors.mcap")["camera_info"])[:, 0, 0]
    check(np.abs(found / fx - 1).max() < 1e-3, f"fx is {found}, not {fx}")
    # an unknown unit, an implausible length, no width and no length of the lens state nothing
    sensors("unstated", by_sensor(10, (0xA210, 3, 9)), by_sensor(0.01), by_sensor(25.4, width=(0xA002, 3, 0)), by_sensor(25.4)[1:])
    # estimated
    report = expect_json("import", "unstated", "--poses", "estimate", "-o", "plain.mcap")
    check("estimated from the pictures" in report["focal_length"], f"an estimate: {report}")
    fx, known = read("plain.mcap")["camera_info"][0][0, 0], ROOM["camera_info"][0][0, 0]
    check(abs(fx / known - 1) < 0.12, f"the estimated focal length is {fx}, not {known}")


def heic():
    """HEIC and AVIF are pictures like others, upright, with the focal length of their EXIF; or they are named."""
    os.makedirs("heic")
    if expect_json("doctor")["heif"] is None:
        for ending in ("heic", "avif"):
            with open(f"heic/a.{ending}", "wb") as file:
                file.write(b"\0\0\0\x18ftypheic")
        expect(1, "scene", "heic", "-o", "no.ply", err="heif-convert")
        return
    if shutil.which("heif-enc") is None:
        print("left out: HEIC, as heif-enc is not there")
        return
    for i, rgb in enumerate(ROOM["image"]):
        with open("one.png", "wb") as file:
            file.write(with_exif(picture(rgb), 1, FOCAL_35MM))
        name = f"heic/photo {i}." + ("avif" if i == 0 else "HEIC")
        subprocess.run(["heif-enc", "-L", "-p", "chroma=444", "--matrix_coefficients=0", "one.png", "-o", name], check=True, capture_output=True)
    report = expect_json("import", "heic", "--poses", "estimate", "-o", "heic.mcap")
    check(f"of {PHOTOS} pictures, the first {FOCAL_35MM} mm" in report["focal_length"], f"HEIC: {report}")
    for i, rgb in enumerate(read("heic.mcap")["image"]):
        check(np.abs(rgb.astype(int) - ROOM["image"][i]).max() <= 2, f"HEIC: picture {i} differs")
    with open("heic/photo 1.HEIC", "r+b") as file:
        file.truncate(os.path.getsize("heic/photo 1.HEIC") // 2)
    report = expect_json("import", "heic", "--poses", "estimate", "-o", "cut.mcap")
    check(report["frames"] == PHOTOS - 1 and "photo 1.HEIC: HEIF: " in report["left_out"][0], f"a cut HEIC: {report}")


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
    code, _, message = run("scene", "my photos", "-o", "page.html")
    check((code == 0 and os.path.getsize("page.html") > 100000) or "without the page" in message, f"a page: {code} {message}")
    if code == 0:
        with open("page.html", encoding="utf-8") as file:
            page = file.read()
        check('"my photos"' in page and "trim3r-scene-" not in page, "the page is not named after the photos")
    text = expect(0, "scene", "my photos", "--recording", "kept.mcap", "--size", "96x72", "--keep", "5%", "-o", "small.spz")
    lines = text.splitlines()
    check(sum(not line.startswith("  ") for line in lines) == 6 and max(map(len, lines)) <= 80 and "photo 3.png" in text,
          f"not six lines: {text}")
    chosen, others = lines[[line.startswith("frames: ") for line in lines].index(True)], "; not chosen: " in " ".join(text.split())
    check(("sharp ones that together show most" in chosen) == others, f"why some are chosen: {text}")
    check(read("kept.mcap")["image"][0].shape == (72, 96, 3), "--size")


def bag_of_the_room(path, k, kind):
    bag = ros.Bag()
    bag.put("/tf_static", ros.TF, 0, ros.transforms((0, "base", "cam", (0, 0, 0), ros.UPRIGHT)))
    for i, rgb in enumerate(ROOM["image"]):
        ns, place, (w, x, y, z) = (i + 1) * ros.SECOND, ROOM["pose"][i][:3, 3], quaternion(ROOM["pose"][i])
        bag.put("/cam/camera_info", ros.INFO, ns, ros.info(ns, "cam", (k[0, 0], k[1, 1], k[0, 2], k[1, 2]), (WIDTH, HEIGHT)))
        if kind == ros.POSE:
            bag.put("/pose", ros.POSE, ns, ros.pose(ns, "map", place, (x, y, z, w)))
        if kind == ros.TF:
            bag.put("/tf", ros.TF, ns, ros.transforms((ns, "map", "base", place, (x, y, z, w))))
        bag.put("/cam/image_raw", ros.IMAGE, ns, ros.image(ns, "cam", "rgb8", rgb))
    bag.write(path)


def posed(folder, pictures, **lens):
    """Writes a folder of the room's pictures, or of others of the same cameras, with their poses."""
    os.makedirs(folder)
    frames = []
    for i, rgb in enumerate(pictures):
        with open(f"{folder}/{i}.png", "wb") as file:
            file.write(picture(rgb))
        frames.append({"file_path": f"{i}.png", "transform_matrix": (ROOM["pose"][i] @ np.diag([1, -1, -1, 1])).tolist()})
    k = ROOM["camera_info"][0]
    with open(f"{folder}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"frames": frames, "fl_x": k[0, 0], "cx": k[0, 2] + 0.5, "cy": k[1, 2] + 0.5, **lens}, file)


def bent(rgb, k1):
    """Returns the picture that a lens with distortion takes of the same view, by nearest pixels."""
    k = ROOM["camera_info"][0]
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    seen = np.stack([(x - k[0, 2]) / k[0, 0], (y - k[1, 2]) / k[1, 1]])
    far, straight = np.hypot(*seen), np.hypot(*seen)
    for _ in range(30):
        straight = far / (1 + k1 * straight ** 2)
    x, y = (seen * (straight / np.maximum(far, 1e-9))) * k[[0, 1], [0, 1]][:, None, None] + k[:2, 2][:, None, None]
    return rgb[np.rint(y).astype(int), np.rint(x).astype(int)]


def scene_by_a_lens():
    """A lens with distortion leaves pixels at the border without a picture: they do not count where a scene is compared."""
    k1 = 0.3
    posed("bent", [bent(rgb, k1) for rgb in ROOM["image"]], k1=k1)
    scores = {name: [p["psnr"] for p in expect_json("scene", name, "-o", f"{name}.ply")["pictures"] if p["chosen"]]
              for name in ("posed", "bent")}
    check(min(scores["bent"]) > min(scores["posed"]) - 4, f"drawn: {scores}")
    # eval has the same number for the same picture, but for the last digits of the pose, which alignment corrects
    expect(0, "import", "bent", "-o", "bent.mcap")
    row = expect_json("eval", "bent.mcap", "--scene", "bent.ply", "--depth", "stereo", "--context", "0,1", "--target", "2",
                      "--images", "bent pictures")["rows"][0]
    check(abs(row["psnr_all"] - scores["bent"][2]) < 5e-3, f"by scene {scores['bent'][2]}, by eval {row['psnr_all']}")
    check("shown.png" in os.listdir("bent pictures/2"), "the pixels that count are not written")


def scene_of_others():
    # a recording with poses and depth is not imported
    lines = pasted("room.mcap", "-o", "sensed.ply")
    check(len(lines) == 1 and "stereo" not in lines[0], f"a recording: {lines}")
    report = expect_json("scene", "room.mcap", "-o", "sensed.ply")
    check(report["depth"] == "sensor" and not report["estimated"] and
          all(p["psnr"] > 25 for p in report["pictures"] if p["chosen"]), f"a recording: {report}")
    # a folder of a known kind
    posed("posed", ROOM["image"])
    report = expect_json("scene", "posed", "-o", "posed.ply")
    check(report["kind"] == "transforms.json" and report["depth"] == "stereo" and not report["estimated"], f"a folder: {report}")
    check("--poses" not in expect(0, "scene", "posed", "--dry-run", "-o", "posed.ply"), "given poses are estimated")
    # bags: poses of the camera, or of a body by transforms, and transforms that say nothing of where the camera is
    for name, kind in (("posed bag", ros.POSE), ("robot", ros.TF), ("still", None)):
        bag_of_the_room(f"{name}.mcap", ROOM["camera_info"][0], kind)
        lines = expect(0, "scene", f"{name}.mcap", "--dry-run", "-o", "bag.ply")
        check(("--poses estimate" in lines) == (kind is None), f"{name}: {lines}")
    report = expect_json("scene", "robot.mcap", "-o", "bag.ply")
    check(report["posed_frames"] == PHOTOS and not report["estimated"] and report["depth"] == "stereo" and
          all(p["psnr"] > 22 for p in report["pictures"] if p["chosen"]), f"a bag: {report}")
    # what cannot become a scene
    os.makedirs("one")
    shutil.copy(glob.glob("plain/*.png")[0], "one/a.png")
    expect(1, "scene", "one", "-o", "no.ply", err="two or more are needed")
    os.makedirs("none")
    expect(1, "scene", "none", "-o", "no.ply", err="no pictures")
    expect(1, "scene", "bag.ply", "-o", "no.ply", err="a scene, not a recording")
    expect(1, "scene", "one/a.png", "-o", "no.ply", err="name the folder")
    expect(1, "scene", "absent", "-o", "no.ply", err="No such file")
    expect(2, "scene", "plain", "-o", "no.txt", err="no.txt")
    expect(2, "scene", "plain", "--keep", 5, "--gaussians", 5, "-o", "no.ply", err="exclude each other")
    for option, value in (("--keep", "0"), ("--keep", "ten"), ("--gaussians", "0"), ("--min-psnr", "400"), ("--intrinsics", "9,9")):
        code, _, error = run("scene", "absent", option, value, "-o", "no.ply") # before the input is read
        check(code == 2 and error.startswith(f"trim3r scene: {option}") and "trim3r scene --help" in error, f"{option} {value}: {error}")
    expect(0, "scene", "room.mcap", "--min-psnr", 20, "-o", "few.ply")
    check(not glob.glob("no.*"), f"files are left: {glob.glob('no.*')}")


with tempfile.TemporaryDirectory(prefix="trim3r-photos-") as folder:
    os.chdir(folder)
    expect(0, "room", "--frames", PHOTOS, "--size", f"{WIDTH}x{HEIGHT}", "-o", "room.mcap")
    ROOM = read("room.mcap")
    focal_lengths()
    heic()
    scene_of_photos()
    scene_of_others()
    scene_by_a_lens()
    os.chdir("/")
done()
