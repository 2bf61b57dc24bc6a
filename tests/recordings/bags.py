# SPDX-License-Identifier: Apache-2.0
"""Bags by a foreign writer: trim3r import reads them, and its output has the known contents.

bags.py TRIM3R FOLDER; FOLDER has node's packages and modules (bags.sh).
"""
import base64
import json
import math
import os
import struct
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, ".."), os.path.join(HERE, "../import"), os.path.join(HERE, "../capture/vm")]
import flat_jpeg  # noqa: E402
import frames  # noqa: E402
from checks import check, done, run  # noqa: E402

TRIM3R, NODE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
WIDTH, HEIGHT, MS = 64, 48, 10**6
START = 1_700_000_000 * 10**9
OPTICAL = (0.5, -0.5, 0.5, -0.5)  # w x y z: x right, y down, z forward, in a body of x forward, y left, z up


# --- messages --------------------------------------------------------------------------------------------------------


def stamp_of(ns):
    # the name, nsec or nanosec, depends on the writer's version
    return {"sec": ns // 10**9, "nsec": ns % 10**9, "nanosec": ns % 10**9}


def header(ns, frame):
    return {"stamp": stamp_of(ns), "frame_id": frame}


def xyz(v):
    return dict(zip("xyz", map(float, v)))


def wxyz(q):
    return dict(zip("wxyz", map(float, q)))


def message(topic, kind, ns, content, data=None):
    out = {"topic": topic, "type": kind, "stamp": ns, "message": content}
    if data is not None:
        out["data"] = base64.b64encode(data).decode()
    return out


def image(topic, ns, frame, encoding, width, height, data):
    return message(topic, "sensor_msgs/msg/Image", ns, {
        "header": header(ns, frame), "height": height, "width": width, "encoding": encoding, "is_bigendian": 0,
        "step": len(data) // height}, data)


def compressed(topic, ns, frame, form, data):
    return message(topic, "sensor_msgs/msg/CompressedImage", ns, {"header": header(ns, frame), "format": form}, data)


def camera_info(topic, ns, frame, width, height, f, c=None, model="plumb_bob", d=()):
    cx, cy = c or ((width - 1) / 2, (height - 1) / 2)
    return message(topic, "sensor_msgs/msg/CameraInfo", ns, {
        "header": header(ns, frame), "height": height, "width": width, "distortion_model": model, "d": list(d),
        "k": [f, 0, cx, 0, f, cy, 0, 0, 1], "r": [1, 0, 0, 0, 1, 0, 0, 0, 1],
        "p": [f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0], "binning_x": 0, "binning_y": 0,
        "roi": {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False}})


def transforms(topic, ns, *edges):
    return message(topic, "tf2_msgs/msg/TFMessage", ns, {"transforms": [
        {"header": header(ns, parent), "child_frame_id": child,
         "transform": {"translation": xyz(t), "rotation": wxyz(q)}} for parent, child, t, q in edges]})


def pose_with_covariance(t, q):
    return {"pose": {"position": xyz(t), "orientation": wxyz(q)}, "covariance": [0.5] * 36}


def odometry(topic, ns, frame, child, t, q):
    return message(topic, "nav_msgs/msg/Odometry", ns, {
        "header": header(ns, frame), "child_frame_id": child, "pose": pose_with_covariance(t, q),
        "twist": {"twist": {"linear": xyz((0, 0, 0)), "angular": xyz((0, 0, 0))}, "covariance": [0.0] * 36}})


def posed(topic, kind, ns, frame, t, q):
    pose = pose_with_covariance(t, q)
    return message(topic, f"geometry_msgs/msg/{kind}", ns, {
        "header": header(ns, frame), "pose": pose["pose"] if kind == "PoseStamped" else pose})


def bag(name, messages, packing="none"):
    messages = sorted(messages, key=lambda m: m["stamp"])
    with open("spec.json", "w", encoding="utf-8") as file:
        json.dump({"packing": packing, "messages": messages}, file)
    ended = subprocess.run(["node", os.path.join(NODE, "write_bag.mjs"), "spec.json", name], capture_output=True,
                           text=True, check=False)
    check(ended.returncode == 0, ended.stderr)


def imported(name, *options, expect=0):
    ended = run(TRIM3R, "import", name, *options, "--json", "-o", "out.mcap", expect=expect)
    if expect != 0:
        return ended.stderr
    told = json.loads(ended.stdout)
    told["read"] = frames.read("out.mcap")
    return told


# --- geometry --------------------------------------------------------------------------------------------------------


def yaw(angle):
    return (math.cos(angle / 2), 0, 0, math.sin(angle / 2))


def same_pose(a, b, text, bound=1e-7):
    check(np.abs(np.asarray(a) - np.asarray(b)).max() < bound, f"{text}:\n{a}\n{b}")


def colour_rows(i):
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    return np.stack([x * 3 + i, y * 5, x + y], axis=2).astype(np.uint8)


# --- cases -----------------------------------------------------------------------------------------------------------


def robot(packing):
    """Compressed colour at 30 Hz, depth of a second camera at 15 Hz, poses as transforms at 10 Hz."""
    messages = [transforms("/tf_static", START, ("base_link", "camera_link", (0.1, 0, 0.3), yaw(0.2)),
                           ("camera_link", "colour_optical", (0, 0, 0), OPTICAL),
                           ("camera_link", "depth_optical", (0, -0.25, 0), OPTICAL))]
    count, depth_side = 7, (32, 24)
    for i in range(count):
        ns = START + 10 * MS + i * 33 * MS
        messages += [compressed("/cam/color/image_raw/compressed", ns, "colour_optical", "rgb8; png compressed bgr8",
                                frames.picture(colour_rows(i))),
                     camera_info("/cam/color/camera_info", ns, "colour_optical", WIDTH, HEIGHT, 60.0)]
        if i % 2 == 0:
            z = np.full(depth_side[::-1], 2000, "<u2")
            messages += [image("/cam/depth/image_rect_raw", ns + 4 * MS, "depth_optical", "16UC1", *depth_side, z.tobytes()),
                         camera_info("/cam/depth/camera_info", ns + 4 * MS, "depth_optical", *depth_side, 30.0)]
    for i in range(4):
        ns = START + i * 100 * MS
        messages.append(transforms("/tf", ns, ("map", "odom", (1, 2, 0), yaw(0)),
                                   ("odom", "base_link", (0.5 * i, 0, 0), yaw(0.4 * i))))
    messages.append(message("/imu", "sensor_msgs/msg/Imu", START, {
        "header": header(START, "imu"), "orientation": wxyz((1, 0, 0, 0)), "orientation_covariance": [0.0] * 9,
        "angular_velocity": xyz((0, 0, 0)), "angular_velocity_covariance": [0.0] * 9,
        "linear_acceleration": xyz((0, 0, 9)), "linear_acceleration_covariance": [0.0] * 9}))
    bag("robot.mcap", messages, packing)

    told = imported("robot.mcap")
    check(told["frames"] == count and told["posed_frames"] == count and told["lost"] == "", f"{told['frames']}")
    check(told["depth_frames"] == 4 and told["registered"] == 4, "depth within 20 ms of colour, registered")
    use = {t["topic"]: t["use"] for t in told["topics"]}
    check(use == {"/cam/color/image_raw/compressed": "colour", "/cam/color/camera_info": "camera_info",
                  "/cam/depth/image_rect_raw": "depth", "/cam/depth/camera_info": "camera_info of depth",
                  "/tf": "transforms", "/tf_static": "transforms"}, f"{use}")
    check([(t["topic"], t["unused"]) for t in told["unused"]] == [("/imu", "its type is not read")],
          f"{told['unused']}")
    still = frames.matrix(yaw(0.2), (0.1, 0, 0.3)) @ frames.matrix(OPTICAL, (0, 0, 0))
    for i in range(count):
        check(np.array_equal(told["read"]["image"][i], colour_rows(i)), f"picture {i}")
        at = (10 + 33 * i) / 100  # in tenths of a second; yaw changes evenly, so the arc is proportional to the angle
        moving = frames.matrix(yaw(0.4 * at), (1 + 0.5 * at, 2, 0))
        same_pose(told["read"]["pose"][i], moving @ still, f"pose {i}")
    for z in told["read"]["depth"]:
        # the depth camera is 0.25 to the right, which moves its content by 30 x 0.25 / 2 = 3.75 pixels to the right
        check(z.shape == (24, 32), f"{z.shape}")
        check((z[:, 4:] == 2000).all() and (z[:, :3] == 0).all(), f"{z}")
    wide = imported("robot.mcap", "--pair", 40)
    check(wide["depth_frames"] == count, "--pair 40 finds depth for every colour image")
    base = imported("robot.mcap", "--fixed-frame", "odom")
    same_pose(np.array(base["read"]["pose"]) + [[[0] * 3 + [1], [0] * 3 + [2], [0] * 4, [0] * 4]],
              np.array(told["read"]["pose"]), "--fixed-frame odom", 2e-7)
    check("no transform and no pose has the frame nowhere" in imported("robot.mcap", "--fixed-frame", "nowhere", expect=1),
          "a frame that is not there")
    check("there is no topic /x" in imported("robot.mcap", "--depth-topic", "/x", expect=1), "a topic that is not there")
    check("holds no depth" in imported("robot.mcap", "--depth-topic", "/imu", expect=1), "a topic of another kind")
    other = imported("robot.mcap", "--camera-frame", "depth_optical")
    check(other["registered"] == 0 and other["depth_frames"] == 4, "the camera's own frame needs no registration")
    info = json.loads(run(TRIM3R, "info", "robot.mcap", "--json").stdout)
    check("images are compressed" in info["note"] and "poses are transforms" in info["note"], info["note"])
    for command in (("build", "--context", "0,2", "--keep", "10%", "-o", "s.ply"), ("eval", "--keep", "10"), ("replay", ),
                    ("eval", "--context", "0,2", "--target", "1", "--keep", "10")):
        refused = run(TRIM3R, command[0], "robot.mcap", *command[1:], expect=1)
        check("trim3r import robot.mcap -o NAME.mcap" in refused.stderr, f"{command}: {refused.stderr}")
    text = run(TRIM3R, "import", "robot.mcap", "-o", "out.mcap").stdout
    check("not used /imu (sensor_msgs/msg/Imu, 1 messages): its type is not read" in " ".join(text.split()), text)


def odometry_and_named_topics():
    """Poses of the body, with the camera's place in it; an option names one of several pose topics."""
    messages = [transforms("/tf_static", START, ("base", "cam", (0, 0, 0.5), OPTICAL))]
    for i in range(3):
        ns = START + i * 100 * MS
        messages += [image("/cam/image", ns, "cam", "rgb8", WIDTH, HEIGHT, colour_rows(i).tobytes()),
                     camera_info("/cam/camera_info", ns, "cam", WIDTH, HEIGHT, 60.0),
                     odometry("/odom", ns - 20 * MS, "map", "base", (i, 0, 0), yaw(0.3 * i)),
                     posed("/slam", "PoseWithCovarianceStamped", ns, "map", (0, i, 0), yaw(0)),
                     posed("/mocap", "PoseStamped", ns, "lab", (0, 0, i), yaw(0))]
    bag("odometry.mcap", messages, "lz4")
    told = imported("odometry.mcap")
    check(told["posed_frames"] == 0, "three pose topics, none of them near: none is used")
    check(sum("--pose-topic names one" in t["unused"] for t in told["unused"]) == 3, f"{told['unused']}")
    told = imported("odometry.mcap", "--pose-topic", "/odom")
    for i in range(2):
        expected = frames.matrix(yaw(0.3 * (i + 0.2)), (i + 0.2, 0, 0)) @ frames.matrix(OPTICAL, (0, 0, 0.5))
        same_pose(told["read"]["pose"][i], expected, f"odometry {i}")
    check("/tf_static" in [t["topic"] for t in told["topics"]], "/tf_static leads from the body to the camera")
    check(told["posed_frames"] == 3 and told["interpolated"] == 3, "the last one is within 20 ms of the end")
    check(imported("odometry.mcap", "--pose-topic", "/odom", "--pair", 19)["posed_frames"] == 2, "and not within 19")
    told = imported("odometry.mcap", "--pose-topic", "/slam", "--fixed-frame", "map")
    check("/tf_static" in [t["topic"] for t in told["unused"]], "no transform is needed where the frames are those asked for")
    for i in range(3):
        same_pose(told["read"]["pose"][i], frames.matrix(yaw(0), (0, i, 0)), f"PoseWithCovarianceStamped {i}")
    told = imported("odometry.mcap", "--pose-topic", "/mocap")
    same_pose(told["read"]["pose"][2], frames.matrix(yaw(0), (0, 0, 2)), "PoseStamped")
    check("comes from /mocap" in {t["topic"]: t["unused"] for t in told["unused"]}["/odom"], f"{told['unused']}")


def depth_kinds():
    """Depth in every encoding, in colour's own frame, gives the same steps."""
    steps = (np.arange(WIDTH * HEIGHT) % 3000 + 500).reshape(HEIGHT, WIDTH).astype(np.uint16)
    steps[0, 0] = 0
    a, b = 20000.0, -20.0  # metres are a / (sample - b)
    quantized = np.where(steps > 0, np.round(a / (np.maximum(steps, 1) * 0.001) + b), 0).astype(np.uint16)
    metres = np.where(quantized > 0, a / (quantized - b), 0)
    png = frames.picture
    kinds = {"16UC1": (image, "16UC1", steps.astype("<u2").tobytes()), "mono16": (image, "mono16", steps.astype("<u2").tobytes()),
             "32FC1": (image, "32FC1", (steps * np.float32(0.001)).astype("<f4").tobytes()),
             "png": (compressed, "16UC1; png compressed ", png(steps)),
             "compressedDepth": (compressed, "16UC1; compressedDepth png", struct.pack("<iff", 0, 0, 0) + png(steps)),
             "compressedDepth of metres": (compressed, "32FC1; compressedDepth png", struct.pack("<iff", 0, a, b) + png(quantized))}
    luma, cb, cr = 120, 100, 160
    jpeg = flat_jpeg.jpeg(WIDTH, HEIGHT, [[(luma, luma, cb, cr)] * (WIDTH // 16)] * (HEIGHT // 8))
    for name, (make, form, data) in kinds.items():
        topic = "/c/depth" if make is image else "/c/depth/compressedDepth"
        messages = [compressed("/c/image/compressed", START, "c", "jpeg", jpeg),
                    camera_info("/c/camera_info", START, "c", WIDTH, HEIGHT, 60.0), posed("/c/pose", "PoseStamped", START, "w", (0, 0, 0), yaw(0)),
                    make(topic, START, "c", form, WIDTH, HEIGHT, data) if make is image else make(topic, START, "c", form, data)]
        bag("depth.mcap", messages, "zstd")
        told = imported("depth.mcap")
        check(told["depth_frames"] == 1 and told["registered"] == 0, f"{name}: {told['depth_frames']}")
        expected = np.round(metres * 1000) if "metres" in name else steps
        check(np.array_equal(told["read"]["depth"][0], expected), f"{name}: {told['read']['depth'][0]}")
        check(told["read"]["image"][0].tobytes() == flat_jpeg.rgb(luma, cb, cr) * (WIDTH * HEIGHT), f"{name}: the JPEG")
    for form, data, words in (("16UC1; compressedDepth png", b"short", "cut short"),
                              ("16UC1; compressedDepth png", bytes(12) + png(colour_rows(0)), "no 16-bit grey"),
                              ("16UC1; compressedDepth png", bytes(12) + png(steps)[:90], "PNG")):
        messages[3] = compressed("/c/depth/compressedDepth", START, "c", form, data)
        bag("bad.mcap", messages)
        check(words in imported("bad.mcap", expect=1), f"{words}")
    messages[3] = compressed("/c/depth/compressedDepth", START, "c", "16UC1; compressedDepth rvl", b"123")
    bag("rvl.mcap", messages)
    told = imported("rvl.mcap")
    check("its format '16UC1; compressedDepth rvl' is not supported" in told["unused"][0]["unused"], f"{told['unused']}")


def lenses():
    """Depth through a rational_polynomial or equidistant lens lands where the lens model says."""
    for model, d in (("rational_polynomial", (0.2, -0.1, 0.001, -0.002, 0.03, 0.15, -0.05, 0.01)), ("equidistant", (0.05, -0.02, 0.01, 0))):
        z = np.full((HEIGHT, WIDTH), 1000, "<u2")
        mark = (10, 12)  # y, x of a near block, seen in the depth camera
        z[mark[0]:mark[0] + 4, mark[1]:mark[1] + 4] = 500
        messages = [image("/c/image", START, "c", "rgb8", WIDTH, HEIGHT, colour_rows(0).tobytes()),
                    camera_info("/c/camera_info", START, "c", WIDTH, HEIGHT, 60.0),
                    image("/d/image", START, "c", "16UC1", WIDTH, HEIGHT, z.tobytes()),
                    camera_info("/d/camera_info", START, "c", WIDTH, HEIGHT, 40.0, model=model, d=d)]
        bag("lens.mcap", messages)
        told = imported("lens.mcap")
        check(told["registered"] == 1, f"{model}: registered")
        found = np.argwhere(told["read"]["depth"][0] == 500).mean(axis=0)
        seen = np.array([(mark[1] + 1.5 - (WIDTH - 1) / 2) / 40, (mark[0] + 1.5 - (HEIGHT - 1) / 2) / 40])
        ray = seen.copy()
        for _ in range(100):
            ray += seen - distorted(model, d, ray)
        expected = ray * 60 + [(WIDTH - 1) / 2, (HEIGHT - 1) / 2]
        check(np.abs(found[::-1] - expected).max() < 0.6, f"{model}: {found[::-1]} and {expected}")


def distorted(model, d, p):
    x, y = p
    r2 = x * x + y * y
    if model == "equidistant":
        r = math.sqrt(r2)
        angle = math.atan(r)
        a2 = angle * angle
        return p * (angle * (1 + a2 * (d[0] + a2 * (d[1] + a2 * (d[2] + a2 * d[3])))) / r)
    k1, k2, p1, p2, k3, k4, k5, k6 = d
    scale = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
    return np.array([x * scale + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * scale + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y])


def broken_bags_are_mended():
    """Files cut anywhere: complete messages are written, and the line reports the loss."""
    messages = []
    for i in range(6):
        ns = START + i * 33 * MS
        messages += [camera_info("/c/camera_info", ns, "c", WIDTH, HEIGHT, 60.0), posed("/c/pose", "PoseStamped", ns, "w", (i, 0, 0), yaw(0)),
                     image("/c/image", ns, "c", "rgb8", WIDTH, HEIGHT, colour_rows(i).tobytes())]
    for packing in ("none", "zstd", "lz4"):
        bag("whole.mcap", messages, packing)
        with open("whole.mcap", "rb") as file:
            data = file.read()
        last = 0
        for cut in [len(data) * k // 12 for k in range(3, 12)] + [len(data) - 8, len(data) - 1]:
            with open("broken.mcap", "wb") as file:
                file.write(data[:cut])
            if imported_frames("broken.mcap") == 0:
                check("no frames" in imported("broken.mcap", expect=1), "nothing is left")
                continue
            told = imported("broken.mcap")
            check(told["frames"] >= last and "cut" in told["lost"] + "cut", told["lost"])
            check(told["lost"] != "", f"{packing}, {cut} of {len(data)} bytes: what was lost")
            last = told["frames"]
            for i, picture in enumerate(told["read"]["image"]):
                check(np.array_equal(picture, colour_rows(i)), f"picture {i} of a bag cut at {cut}")
            mended = json.loads(run(TRIM3R, "info", "out.mcap", "--json").stdout)
            check(mended["note"] == "" and mended["frames"] == told["frames"], f"mended: {mended['note']}")
        check(last == 6, f"{packing}: {last}")


def imported_frames(name):
    return json.loads(run(TRIM3R, "info", name, "--json").stdout)["frames"]


def built_from():
    """A recorded room, rewritten by import with every compression, gives the same scene."""
    run(TRIM3R, "room", "--size", "96x96", "-o", "room.mcap")
    hashes = set()
    for stored in (("--unchunked",), ("--compression", "zstd"), ("--compression", "lz4"), ()):
        run(TRIM3R, "import", "room.mcap", *stored, "-o", "copy.mcap")
        hashes.add(run(TRIM3R, "replay", "copy.mcap", "--context", "0,2").stdout.splitlines()[-1])
    hashes.add(run(TRIM3R, "replay", "room.mcap", "--context", "0,2").stdout.splitlines()[-1])
    check(len(hashes) == 1, f"{hashes}")
    for options, words in ((("--compression", "gzip"), "there are none, zstd, lz4"),
                           (("--compression", "zstd", "--unchunked"), "which --unchunked leaves out")):
        refused = run(TRIM3R, "room", *options, "-o", "x.mcap", expect=2).stderr
        check(words in refused, refused)
    folder_usage = run(TRIM3R, "import", ".", "--pose-topic", "/odom", "-o", "x.mcap", expect=2).stderr
    check("is for bags and recordings" in folder_usage, folder_usage)
    bag_usage = run(TRIM3R, "import", "room.mcap", "--min-confidence", "1", "-o", "x.mcap", expect=2).stderr
    check("belong to folders" in bag_usage, bag_usage)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for storage in ("none", "zstd", "lz4"):
        robot(storage)
    odometry_and_named_topics()
    depth_kinds()
    lenses()
    broken_bags_are_mended()
    built_from()
done()
