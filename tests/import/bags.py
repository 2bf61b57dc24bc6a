# SPDX-License-Identifier: Apache-2.0
"""Bags as drivers and robots write them: which topics are chosen, which messages are left out, which files are named.

bags.py TRIM3R
"""
import json
import os
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not there")
    sys.exit(77)

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../capture/vm"))
from checks import check, done  # noqa: E402
import flat_jpeg  # noqa: E402
import frames  # noqa: E402
from png import png  # noqa: E402
from program import run  # noqa: E402
import ros_bag as ros  # noqa: E402
from ros_bag import Bag, SECOND  # noqa: E402

NAN = float("nan")


def imported(bag, *options, status=0):
    """Imports a bag. Returns its report, with the frames that were written, or the error."""
    if isinstance(bag, Bag):
        bag.write("bag.mcap")
    code, out, error = run("import", bag if isinstance(bag, str) else "bag.mcap", *options, "--json", "-o", "out.mcap")
    check(code == status, f"{options}: status {code}: {error}")
    if code != 0:
        return error
    report = json.loads(out)
    report["read"] = frames.read("out.mcap")
    report["use"] = {topic["topic"]: topic["use"] for topic in report["topics"]}
    report["why"] = {topic["topic"]: topic["unused"] for topic in report["unused"]}
    return report


def info(path="bag.mcap"):
    code, out, error = run("info", path, "--json")
    check(code == 0, f"info: {error}")
    return json.loads(out)


def positions(report):
    return [tuple(np.round(pose[:3, 3], 6)) for pose in report["read"]["pose"]]


def camera(bag, count=2, topic="/cam/image_raw", frame="cam", poses="/pose", first=0):
    """Adds pictures, intrinsics and poses of a camera, a second apart."""
    for i in range(first, first + count):
        ns = (i + 1) * SECOND
        bag.put(os.path.dirname(topic) + "/camera_info", ros.INFO, ns, ros.info(ns, frame))
        if poses is not None:
            bag.put(poses, ros.POSE, ns, ros.pose(ns, "map", (i, 0, 0)))
        bag.put(topic, ros.IMAGE, ns, ros.image(ns, frame, "rgb8", ros.colour(10 * i)))
    return bag


def depth(bag, topic, encoding, value, frame="cam", count=2, kind="<f4"):
    for i in range(count):
        ns = (i + 1) * SECOND
        bag.put(topic, ros.IMAGE, ns, ros.image(ns, frame, encoding, np.full((ros.HEIGHT, ros.WIDTH), value, kind)))
    return bag


# --- topics ----------------------------------------------------------------------------------------------------------


def depth_is_chosen_by_name_and_type():
    for other, encoding, kind in (("/cam/confidence/confidence_map", "32FC1", "<f4"), ("/cam/ir/image_raw", "mono16", "<u2"),
                                  ("/cam/amplitude", "16UC1", "<u2"), ("/cam/second", "mono16", "<u2")):
        bag = depth(Bag(), other, encoding, 37, kind=kind)
        report = imported(camera(depth(bag, "/cam/registered/depth", "32FC1", 1.5)))
        check(report["use"].get("/cam/registered/depth") == "depth", f"{other}: {report['use']}")
        check((report["read"]["depth"][0] == 1500).all(), f"{other}: {report['read']['depth'][0]}")
    bag = camera(depth(Bag(), "/cam/confidence", "32FC1", 37.0))
    report = imported(bag)
    check(report["depth_frames"] == 0 and "--depth-topic" in report["why"]["/cam/confidence"], f"alone: {report['why']}")
    check(imported(bag, "--depth-topic", "/cam/confidence")["depth_frames"] == 2, "a named topic is taken")
    check(info()["depth_frames"] == 0, "info takes no confidence as depth")
    bag = camera(Bag())
    for topic, frame in (("/one/depth", "one"), ("/two/depth", "two")):
        depth(bag, topic, "16UC1", 1, frame=frame, kind="<u2")
    check("--depth-topic" in imported(bag)["why"]["/two/depth"], "of two equally good ones one must be named")


def poses_are_not_goals():
    for topic in ("/goal_pose", "/move_base_simple/goal", "/cmd/target_pose", "/initialpose", "/aruco/pose", "/object_tracker/pose"):
        bag = camera(Bag(), count=3, poses=None)
        for i in (0, 2):
            bag.put(topic, ros.POSE, (i + 1) * SECOND, ros.pose((i + 1) * SECOND, "map", (50, 60, 0)))
        check(imported(bag)["posed_frames"] == 0, f"{topic} alone")
        for i in range(3):
            bag.put("/tf", ros.TF, (i + 1) * SECOND, ros.transforms(((i + 1) * SECOND, "map", "cam", (i, 0, 0), ros.UPRIGHT)))
        report = imported(bag)
        check(positions(report) == [(0, 0, 0), (1, 0, 0), (2, 0, 0)], f"{topic}: {positions(report)}")
        check("--pose-topic" in report["why"][topic], f"{report['why']}")
        check(positions(imported(bag, "--pose-topic", topic))[0] == (50, 60, 0), f"{topic} by name")
    bag = camera(Bag(), count=2)
    for i in range(2):
        bag.put("/tf", ros.TF, (i + 1) * SECOND, ros.transforms(((i + 1) * SECOND, "map", "cam", (0, i, 0), ros.UPRIGHT)))
    check(positions(imported(bag)) == [(0, 0, 0), (1, 0, 0)], "the pose topic, if there is one")
    check(positions(imported(bag, "--pose-topic", "/tf")) == [(0, 0, 0), (0, 1, 0)], "--pose-topic /tf")
    bag = camera(Bag(), poses=None)
    bag.put("/marker", ros.POSE, SECOND, ros.pose(SECOND, "cam", (0, 0, 1)))
    check("own frame" in imported(bag)["why"]["/marker"], "a pose in the camera's frame is of a thing that it sees")


def frames_with_two_parents():
    """The first parent of a frame counts, and the transforms of another are counted and named."""
    for parents in (("map", "odom"), ("odom", "map")):
        bag = camera(Bag(), poses=None)
        for i in range(2):
            ns = (i + 1) * SECOND
            bag.put("/tf", ros.TF, ns, ros.transforms(*((ns, parent, "cam", (i + 9 * k, 0, 0), ros.UPRIGHT) for k, parent in enumerate(parents))))
        report = imported(bag)
        check(positions(report) == [(0, 0, 0), (1, 0, 0)] and report["transforms_left_out"] == 2, f"{parents}: {report}")
        out = run("import", "bag.mcap", "-o", "out.mcap", "--force")[1]
        check(f"2 transforms of frames with another parent, the first of 'cam' in '{parents[1]}', as it is in '{parents[0]}'" in out, out)


def depth_of_another_clock():
    bag = camera(depth(Bag(), "/cam/depth", "16UC1", 1500, kind="<u2"), count=3)
    check(imported(bag)["depth_unpaired"] == 1, "a frame without depth")
    bag = camera(Bag(), count=2)
    for i in range(2):
        ns = (i + 6) * SECOND
        bag.put("/cam/depth", ros.IMAGE, ns, ros.image(ns, "cam", "16UC1", ros.steps(1500)))
    report = imported(bag)
    check(report["depth_frames"] == 0 and report["depth_unpaired"] == 2, f"another clock: {report}")
    out = run("import", "bag.mcap", "-o", "out.mcap", "--force")[1]
    check("depth: 2 of 2 frames have no message of it near in time (--pair)" in out, out)


def colour_is_chosen_by_votes():
    grey, rgb = ros.colour(7)[..., 0].copy(), ros.colour(9)
    for topic, encoding, rows in (("/cam/infra1/image", "mono8", grey), ("/cam/overlay", "rgb8", rgb), ("/cam/depth/colours", "rgb8", rgb),
                                  ("/foo/image", "rgb8", rgb)):
        bag = Bag()
        for i in range(2):
            bag.put(topic, ros.IMAGE, (i + 1) * SECOND, ros.image((i + 1) * SECOND, "other", encoding, rows))
        report = imported(camera(bag, topic="/cam/colour/image"))
        check(report["use"].get("/cam/colour/image") == "colour", f"{topic}: {report['use']}")
    bag = camera(camera(Bag(), topic="/left/image_raw", frame="left"), topic="/right/image_raw", frame="right", poses=None)
    error = imported(bag, status=1)
    check(all(word in error for word in ("/left/image_raw", "/right/image_raw", "--colour-topic")), error)
    check("--colour-topic" in info()["note"], "info asks, too")
    for command in (("build", "bag.mcap", "--context", "0,1", "--gaussians", "9", "-o", "s.ply"), ("replay", "bag.mcap")):
        code, _, error = run(*command)
        check(code == 1 and "--colour-topic" in error, f"{command[0]}: {error}")
    check(imported(bag, "--colour-topic", "/right/image_raw")["use"]["/right/camera_info"] == "camera_info", "and takes a name")


def intrinsics_are_of_the_same_frame():
    bag = Bag()
    for i in range(2):
        ns = (i + 1) * SECOND
        bag.put("/rig/left", ros.IMAGE, ns, ros.image(ns, "left", "rgb8", ros.colour(1)))
        bag.put("/rig/camera_info", ros.INFO, ns, ros.info(ns, "right", lens=(44, 44, 12, 9)))
    report = imported(bag)
    check("camera_info" not in report["read"] and "--camera-info-topic" in report["why"]["/rig/camera_info"], f"{report['why']}")
    check(info()["pairing"]["with_intrinsics"] == 0, "info, too")
    for i in range(2):
        bag.put("/rig/left_info", ros.INFO, SECOND, ros.info(SECOND, "/left", lens=(20, 20, 12, 9)))
    check(imported(bag)["read"]["camera_info"][0][0, 0] == 20, "one of the frame, with a slash")
    check(imported(bag, "--camera-info-topic", "/rig/camera_info")["read"]["camera_info"][0][0, 0] == 44, "a named one")
    lens = imported(bag, "--intrinsics", "25,26,15,11")["read"]["camera_info"][0]
    check((lens[0, 0], lens[1, 1], lens[0, 2], lens[1, 2]) == (25, 26, 15, 11), f"--intrinsics: {lens}")


def channels_of_a_topic_are_one_stream():
    bag = Bag()
    for i in range(6):
        ns = (i + 1) * SECOND
        for topic, kind, message in (("/cam/image", ros.IMAGE, ros.image(ns, "cam", "rgb8", ros.colour(i))),
                                     ("/cam/depth", ros.IMAGE, ros.image(ns, "cam", "16UC1", ros.steps(1000 + i))),
                                     ("/pose", ros.POSE, ros.pose(ns, "map", (i, 0, 0)))):
            bag.put(topic, kind, ns, message, key=i // 2)
    report = imported(bag)
    check(report["frames"] == report["depth_frames"] == report["posed_frames"] == 6, f"{report['frames']}")
    check([z[0, 0] for z in report["read"]["depth"]] == list(range(1000, 1006)), "depth of every publisher")
    check(len(info()["streams"]) == 3 and info()["frames"] == 6, "info lists three streams")


# --- time ------------------------------------------------------------------------------------------------------------


def clocks_that_begin_again():
    for name, stamps in (("again", [1, 2, 3, 1, 2, 3]), ("earlier", [5, 6, 7, 1.5, 2.5, 3.5])):
        bag = Bag()
        for i, stamp in enumerate(stamps):
            ns, log = int(stamp * SECOND), (i + 1) * SECOND
            bag.put("/cam/camera_info", ros.INFO, log, ros.info(ns, "cam"))
            bag.put("/cam/depth", ros.IMAGE, log, ros.image(ns, "cam", "16UC1", ros.steps(1000 + i)))
            bag.put("/tf", ros.TF, log, ros.transforms((ns, "map", "cam", (i, 0, 0), ros.UPRIGHT)))
            bag.put("/cam/image", ros.IMAGE, log, ros.image(ns, "cam", "rgb8", ros.colour(i)))
        report = imported(bag)
        check([z[0, 0] for z in report["read"]["depth"]] == list(range(1000, 1006)), f"{name}: depth of its own pass")
        check(positions(report) == [(i, 0, 0) for i in range(6)], f"{name}: {positions(report)}")
        check("log times" in report["note"] and "log times" in info()["note"], f"{name}: {report['note']}")
    check(run("replay", "out.mcap", "--gaussians", "9")[0] == 0, "what is written replays")
    bag = Bag()
    for i, stamp in enumerate((1, 1, 2, 2)):
        ns, log = stamp * SECOND, (i + 1) * SECOND
        bag.put("/cam/depth", ros.IMAGE, log, ros.image(ns, "cam", "16UC1", ros.steps(1000 + i)))
        bag.put("/cam/image", ros.IMAGE, log, ros.image(ns, "cam", "rgb8", ros.colour(i)))
    depths = [z[0, 0] for z in imported(bag)["read"]["depth"]]
    check(depths == list(range(1000, 1004)), f"repeated stamps are paired by log times: {depths}")
    bag = Bag()
    for stamp in (1, 2, 1, 2):
        bag.put("/cam/image", ros.IMAGE, stamp * SECOND, ros.image(stamp * SECOND, "cam", "rgb8", ros.colour(stamp)))
    check(imported(bag)["frames"] == 4, "images alone need no pairing")
    bag.put("/cam/depth", ros.IMAGE, SECOND, ros.image(SECOND, "cam", "16UC1", ros.steps(1)))
    check("go back" in imported(bag, status=1), "log times that go back, too, are refused")


def clocks_that_stand():
    """Where all stamps of a topic are the same, or it begins again, log times pair the messages."""
    def bag_of(still, stamp, log=lambda i: (i + 1) * SECOND):
        bag = Bag()
        for i in range(6):
            def at(topic, i=i):
                return stamp(i) if topic in still else log(i)
            bag.put("/cam/depth", ros.IMAGE, log(i), ros.image(at("/cam/depth"), "cam", "16UC1", ros.steps(1000 + i)))
            if "/tf" in still:
                bag.put("/tf", ros.TF, log(i), ros.transforms((at("/tf"), "map", "cam", (i, 0, 0), ros.UPRIGHT)))
            else:
                bag.put("/pose", ros.POSE, log(i), ros.pose(at("/pose"), "map", (i, 0, 0)))
            bag.put("/cam/image", ros.IMAGE, log(i), ros.image(at("/cam/image"), "cam", "rgb8", ros.colour(i)))
        return bag
    topics = ("/cam/image", "/cam/depth", "/pose")
    for still in (*((topic,) for topic in (*topics, "/tf")), topics, (*topics, "/tf")):
        for name, stamp in (("stand", lambda i: 7 * SECOND), ("begin again", lambda i: (10 + i % 3) * SECOND)):
            if name == "begin again" and still == ("/tf",):
                continue  # each frame has a pose of either pass
            report = imported(bag_of(still, stamp))
            check(positions(report) == [(i, 0, 0) for i in range(6)], f"{still} {name}: {positions(report)}")
            check([z[0, 0] for z in report["read"]["depth"]] == list(range(1000, 1006)), f"{still} {name}: depth")
            check("log times" in report["note"] and any(topic in report["note"] for topic in still), f"{still} {name}: {report['note']}")
    folder = folder_of("still", "still_0.mcap")
    bag_of(("/pose",), lambda i: 7 * SECOND).write(f"{folder}/still_0.mcap")
    check(positions(imported(folder)) == [(i, 0, 0) for i in range(6)], "a folder of rosbag2")
    error = imported(bag_of(topics, lambda i: 7 * SECOND, lambda i: 9 * SECOND if i < 5 else 10 * SECOND), status=1)
    check("/cam/image repeat, and the log times of /cam/image do not rise" in error, error)


# --- messages --------------------------------------------------------------------------------------------------------


def bad_poses_are_left_out():
    for message in (ros.pose(3 * SECOND, "map", (NAN, 0, 0)), ros.pose(3 * SECOND, "map", (0, 0, 0), (0, 0, 0, 0)),
                    ros.pose(3 * SECOND, "map", (0, 0, 0), (0, NAN, 0, 1)), b"", b"\0\1\0\0\1"):
        bag = camera(Bag())
        bag.put("/pose", ros.POSE, 3 * SECOND, message)
        report = imported(camera(bag, first=2, count=1, poses=None))
        check(report["frames"] == 3 and report["posed_frames"] == 2, f"{report['frames']}, {report['posed_frames']}")
        check(report["unreadable"][0]["topic"] == "/pose" and report["unreadable"][0]["left_out"] == 1, f"{report['unreadable']}")
        check("/pose" in imported(bag, "--strict", status=1), "--strict refuses")
        check("1 of its messages are left out" in info()["note"], "info tells")
    for edge in ((SECOND, "base", "wheel", (NAN, 0, 0), ros.UPRIGHT), (SECOND, "map", "cam", (0, 0, 0), (0, 0, 0, 0)),
                 (SECOND, "cam", "cam", (0, 0, 0), ros.UPRIGHT), (SECOND, "", "cam", (0, 0, 0), ros.UPRIGHT)):
        bag = camera(Bag(), poses=None)
        for i in range(2):
            bag.put("/tf", ros.TF, SECOND, ros.transforms(((i + 1) * SECOND, "map", "cam", (i, 0, 0), ros.UPRIGHT), edge))
        report = imported(bag)
        check(positions(report) == [(0, 0, 0), (1, 0, 0)], f"{edge}: {positions(report)}")
        check(report["unreadable"] == [report["unreadable"][0]] and report["unreadable"][0]["left_out"] == 2, f"{edge}")
        check("/tf" in imported(bag, "--strict", status=1), "--strict refuses")


def bad_images_are_left_out():
    whole = ros.image(2 * SECOND, "cam", "rgb8", ros.colour(5))
    short = ros.Cdr().header(2 * SECOND, "cam").put("I", ros.HEIGHT, ros.WIDTH).text("rgb8").put("B", 0).put("I", 96).rows(b"").done()
    for name, message, counted in (("empty", b"", False), ("cut", whole[:-100], False), ("short", short, True)):
        bag = camera(depth(Bag(), "/cam/depth", "16UC1", 1000, count=3, kind="<u2"), count=1)
        bag.put("/cam/image_raw", ros.IMAGE, 2 * SECOND, message)
        report = imported(camera(bag, count=1, first=2))
        check(report["frames"] == 2, f"{name}: {report['frames']}")
        check([p[0, 0, 0] for p in report["read"]["image"]] == [0, 20], f"{name}: the other two")
        check(report["frames_left_out"] == counted and len(report["unreadable"]) == (not counted), f"{name}: is counted")
        check("/cam/image_raw" in imported(bag, "--strict", status=1), f"{name}: --strict refuses")
        check(info()["frames"] == 2 + counted and info()["unreadable_frames"] == counted, f"{name}: info goes on")
        text = run("import", "bag.mcap", "-o", "out.mcap")[1]
        check("left out: 1 of" in text and "/cam/image_raw" in text, f"{name}: {text}")
        good = str(1 + counted)
        code, _, error = run("build", "bag.mcap", "--context", f"0,{good}", "--gaussians", "9", "-o", "s.ply")
        check(code == 0, f"{name}: build goes on: {error}")
    bag = camera(Bag(), count=3)
    bag.put("/cam/depth", ros.IMAGE, SECOND, ros.image(SECOND, "cam", "16UC1", ros.steps(1000)))
    bad = ros.image(2 * SECOND, "cam", "16UC1", ros.steps(1, (2, 9000)))
    bag.put("/cam/depth", ros.IMAGE, 2 * SECOND, bad)
    report = imported(bag)
    check(report["frames"] == 3 and report["depth_frames"] == 1 and report["parts_left_out"] == 1, "bad depth alone is left out")
    bag = camera(Bag(), count=2)
    bag.put("/cam/depth", ros.IMAGE, 2 * SECOND, bad)
    check("/cam/depth" in imported(bag, status=1), "a bag whose depth is all bad is refused")


def jpegs_without_their_end():
    whole = flat_jpeg.jpeg(ros.WIDTH, ros.HEIGHT, [[(120, 120, 100, 160)] * (ros.WIDTH // 16)] * (ros.HEIGHT // 8))
    rows = flat_jpeg.rgb(120, 100, 160) * (ros.WIDTH * ros.HEIGHT)
    for name, data, good in (("no end marker", whole[:-2], True), ("half", whole[:-(len(whole) // 20) - 2], False),
                             ("empty", b"", False)):
        bag = Bag()
        for i, jpeg in enumerate((whole, data, whole)):
            ns = (i + 1) * SECOND
            bag.put("/cam/image/compressed", ros.COMPRESSED, ns, ros.compressed(ns, "cam", "jpeg", jpeg))
        report = imported(bag)
        check(report["frames"] == 2 + good and report["frames_left_out"] == (not good), f"{name}: {report['frames']}")
        check(all(picture.tobytes() == rows for picture in report["read"]["image"]), f"{name}: pixels")
        check(info()["frames"] == 3, f"{name}: info")
        if not good:
            check("frame 1, /cam/image/compressed" in imported(bag, "--strict", status=1), f"{name}: --strict")


def triplets_follow_the_frames():
    """Triplets without the frame that is left out are kept, with new numbers."""
    bag = camera(Bag(), count=1)
    bag.put("/cam/image_raw", ros.IMAGE, 2 * SECOND, ros.image(2 * SECOND, "cam", "rgb8", ros.colour(1)[:, :9]))
    bag.metadata("trim3r_triplets", "triplets", "0,2,1;0,3,2")
    report = imported(camera(bag, first=2))
    check(report["frames"] == 3 and report["triplets"] == 1, f"{report['frames']}, {report['triplets']}")
    check(info("out.mcap")["triplets"] == [{"context": [0, 2], "target": 1}], f"{info('out.mcap')['triplets']}")


# --- geometry --------------------------------------------------------------------------------------------------------


def rectified_images_have_the_lens_of_p():
    p = (27, 28, 15, 11)
    for topic in ("/cam/image_rect", "/cam/image_rect_color", "/cam/image_raw"):
        bag = Bag()
        bag.put("/cam/camera_info", ros.INFO, SECOND, ros.info(SECOND, "cam", d=(-0.3, 0.1, 0, 0, 0), p=p))
        bag.put("/pose", ros.POSE, SECOND, ros.pose(SECOND, "map", (0, 0, 0)))
        bag.put(topic, ros.IMAGE, SECOND, ros.image(SECOND, "cam", "rgb8", ros.colour(1)))
        lens = imported(bag)["read"]["camera_info"][0]
        raw = topic.endswith("raw")
        check((lens[0, 0], lens[1, 1]) == ((30, 30) if raw else (27, 28)), f"{topic}: {lens}")
        check(info()["distortion"] == ("radtan" if raw else "none"), f"{topic}: info reads {info()['distortion']}")
    bag = Bag()
    bag.put("/cam/camera_info", ros.INFO, SECOND, ros.info(SECOND, "cam", d=(-0.3, 0.1, 0, 0, 0), p=(0, 0, 0, 0)))
    bag.put("/cam/image_rect", ros.IMAGE, SECOND, ros.image(SECOND, "cam", "rgb8", ros.colour(1)))
    check("P is 0" in imported(bag, status=1), "without P")


def depth_of_another_aspect_needs_its_own_lens():
    for size, good in (((ros.HEIGHT, ros.HEIGHT), False), ((12, 16), True), ((11, 15), True), ((20, 32), False)):
        bag = camera(Bag(), count=1)
        bag.put("/cam/depth", ros.IMAGE, SECOND, ros.image(SECOND, "cam", "16UC1", ros.steps(1000, size)))
        if good:
            check(imported(bag)["depth_frames"] == 1, f"{size}")
            continue
        check("--depth-camera-info-topic" in imported(bag, status=1), f"{size}")
        for command in (("build", "bag.mcap", "--context", "0,0", "--gaussians", "9", "-o", "s.ply"), ("info", "bag.mcap")):
            code, _, error = run(*command)
            check(code == 1 and "another aspect" in error, f"{command[0]}, {size}: {error}")
        bag.put("/other/info", ros.INFO, SECOND, ros.info(SECOND, "cam", size=(size[1], size[0])))
        check(imported(bag, "--depth-camera-info-topic", "/other/info")["registered"] == 1, f"{size}, registered")


# --- encodings and files ---------------------------------------------------------------------------------------------


def encodings():
    rgb = np.zeros((ros.HEIGHT, ros.WIDTH, 3), np.uint8)
    rgb[:] = (200, 100, 50)
    alpha = np.full((ros.HEIGHT, ros.WIDTH, 1), 9, np.uint8)
    bayer = {"rggb": (0, 1, 1, 2), "bggr": (2, 1, 1, 0), "gbrg": (1, 2, 0, 1), "grbg": (1, 0, 2, 1)}
    cases = {"rgba8": np.concatenate([rgb, alpha], 2), "bgra8": np.concatenate([rgb[..., ::-1], alpha], 2),
             "8UC4": np.concatenate([rgb[..., ::-1], alpha], 2), "8UC3": rgb[..., ::-1].copy()}
    for name, channels in bayer.items():
        rows = np.zeros((ros.HEIGHT, ros.WIDTH), np.uint8)
        for i, channel in enumerate(channels):
            rows[i // 2::2, i % 2::2] = rgb[0, 0, channel]
        cases["bayer_" + name + "8"] = rows
    for encoding, rows in cases.items():
        bag = Bag()
        bag.put("/pose", ros.POSE, SECOND, ros.pose(SECOND, "map", (0, 0, 0)))
        bag.put("/cam/camera_info", ros.INFO, SECOND, ros.info(SECOND, "cam"))
        bag.put("/cam/image", ros.IMAGE, SECOND, ros.image(SECOND, "cam", encoding, rows))
        picture = imported(bag)["read"]["image"][0]
        expected = rgb[..., ::-1] if encoding == "8UC3" else rgb  # stored as bgr8
        check(np.array_equal(picture, expected), f"{encoding}: {picture[5, 5]}")
        check(info()["width"] == ros.WIDTH, f"{encoding}: info")
        code, _, error = run("build", "bag.mcap", "--context", "0,0", "--gaussians", "9", "-o", "s.ply")
        check(encoding == "8UC3" or (code == 1 and "trim3r import" in error), f"{encoding}: {error}")


def transparent_pixels_are_none():
    alpha = np.full((ros.HEIGHT, ros.WIDTH, 1), 255, np.uint8)
    alpha[:10, :12] = 100
    rows = np.concatenate([ros.colour(50), alpha], 2)
    for encoding in ("rgba8", "png"):
        bag = camera(Bag(), count=0)
        bag.put("/cam/camera_info", ros.INFO, SECOND, ros.info(SECOND, "cam"))
        bag.put("/cam/depth", ros.IMAGE, SECOND, ros.image(SECOND, "cam", "16UC1", ros.steps(1000, (12, 16))))
        if encoding == "png":
            bag.put("/cam/image/compressed", ros.COMPRESSED, SECOND, ros.compressed(SECOND, "cam", "png", png([row.tobytes() for row in rows], channels=4)))
        else:
            bag.put("/cam/image", ros.IMAGE, SECOND, ros.image(SECOND, "cam", encoding, rows))
        read = imported(bag)["read"]
        colour, z = read["image"][0], read["depth"][0]
        check(not colour[:10, :12].any() and (colour[10:] == 50).all() and (colour[:, 12:] == 50).all(), f"{encoding}: colour")
        check(not z[:5, :6].any() and (z[5:] == 1000).all() and (z[:, 6:] == 1000).all(), f"{encoding}: depth")


def images_that_exif_turns():
    whole = flat_jpeg.jpeg(ros.WIDTH, ros.HEIGHT, [[(120, 120, 100, 160)] * (ros.WIDTH // 16)] * (ros.HEIGHT // 8))
    for orientation, good in ((1, True), (3, False), (4, False)):
        tiff = b"II*\0" + struct.pack("<IHHHIHHI", 8, 1, 0x112, 3, 1, orientation, 0, 0)
        exif = b"\xff\xe1" + struct.pack(">H", 8 + len(tiff)) + b"Exif\0\0" + tiff
        bag = Bag()
        for i, data in enumerate((whole, whole[:2] + exif + whole[2:])):
            bag.put("/cam/image/compressed", ros.COMPRESSED, (i + 1) * SECOND, ros.compressed((i + 1) * SECOND, "cam", "jpeg", data))
        report = imported(bag)
        check(report["frames"] == 1 + good and (good or "EXIF turns" in report["left_out"][0]), f"{orientation}: {report['left_out']}")


def depth_units():
    bag = camera(depth(Bag(), "/cam/depth", "32FC1", 80.0))
    report = imported(bag)
    check(report["depth_beyond"] == 2 * ros.WIDTH * ros.HEIGHT, f"{report['depth_beyond']}")
    check("--depth-unit 0.002" in run("import", "bag.mcap", "-o", "out.mcap")[1], "the remedy is printed")
    report = imported(bag, "--depth-unit", "0.002")
    check((report["read"]["depth"][0] == 40000).all() and report["depth_beyond"] == 0, "metres in other steps")
    check(abs(info("out.mcap")["depth_unit"] - 0.002) < 1e-9, "the unit is stored")
    os.rename("out.mcap", "own.mcap")
    check("states its own depth unit" in imported("own.mcap", "--depth-unit", "0.01", status=1), "a recording has its unit")


def other_files():
    connection = sqlite3.connect("bag.db3")
    connection.execute("create table topics(id integer)")
    connection.commit()
    connection.close()
    contents = {"old.bag": b"#ROSBAG V2.0\n" + bytes(99), "packed.mcap": b"\x28\xb5\x2f\xfd\0" + bytes(98), "film.mp4": b"\0\0\0\x18ftypisom" + bytes(64),
                "scan.r3d": b"PK\3\4" + bytes(99)}
    for name, content in contents.items():
        with open(name, "wb") as file:
            file.write(content)
    for name, word in (("bag.db3", "mcap convert"), ("old.bag", "rosbags-convert"), ("packed.mcap", "zstd -d"), ("film.mp4", "ffmpeg"),
                       ("scan.r3d", "unzip")):
        for command in (("import", name, "-o", "out.mcap"), ("info", name), ("replay", name)):
            code, _, error = run(*command)
            check(code == 1 and word in error, f"{command}: {error}")
    bag = Bag(encoding="ros1")
    bag.put("/cam/image", "sensor_msgs/Image", SECOND, bytes(40))
    check("ROS 1" in imported(bag, status=1), "messages of ROS 1")
    bag = Bag()
    bag.put("/cam/image", ros.IMAGE, SECOND, b"\x28\xb5\x2f\xfd" + bytes(99))
    check("packed with zstd" in imported(bag, status=1), "messages packed one by one")


def folder_of(name, *files, listed=None):
    """Writes a folder of rosbag2, with two frames a file. Files of another suffix than .mcap are only listed."""
    os.makedirs(name)
    for i, file in enumerate(files):
        if file.endswith(".mcap"):
            camera(Bag(), first=2 * i).write(f"{name}/{file}")
    with open(f"{name}/metadata.yaml", "w", encoding="utf-8") as text:
        text.write("rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n  relative_file_paths:\n"
                   + "".join(f"    - {file}\n" for file in listed or files) + "  duration:\n    nanoseconds: 1\n")
    return name


def folders_of_rosbag2():
    check(imported(folder_of("one", "one_0.mcap"))["frames"] == 2, "a folder of one file")
    parts = [f"many_{i}.mcap" for i in (0, 1, 10, 2)]
    report = imported(folder_of("many", *parts))
    check(report["frames"] == report["posed_frames"] == 8, f"a folder of four: {report['frames']}")
    check([p[0, 0, 0] for p in report["read"]["image"]] == [10 * i for i in range(8)], "in the order of metadata.yaml")
    check(positions(report) == [(i, 0, 0) for i in range(8)], f"{positions(report)}")
    check(info("many")["frames"] == 8 and len(info("many")["streams"]) == 3, "info: topics of all files are one")
    quoted = folder_of("quoted", "a b_0.mcap", "a b_1.mcap", listed=("'a b_0.mcap'", '"a b_1.mcap"'))
    check(imported(quoted)["frames"] == 4, "quoted names")
    error = imported(folder_of("gone", "gone_0.mcap", listed=("gone_0.mcap", "gone_1.mcap")), status=1)
    check("gone/gone_1.mcap: file 2 of the 2 that metadata.yaml names is not there" in error, error)
    check("mcap convert lite/lite_0.db3 lite/lite_0.mcap" in imported(folder_of("lite", "lite_0.db3"), status=1), "of SQLite")
    check("mcap convert mix/m_1.db3" in imported(folder_of("mix", "m_0.mcap", "m_1.db3"), status=1), "one file of SQLite")
    check("names no file" in imported(folder_of("none", listed=("",)), status=1), "no file")
    before = open("many/many_1.mcap", "rb").read()
    code, _, error = run("import", "many", "-o", "many/many_1.mcap")
    check(code == 2 and "is read" in error and open("many/many_1.mcap", "rb").read() == before, f"its own file: {error}")


def bad_files_of_a_folder():
    folder = folder_of("cut", "cut_0.mcap", "cut_1.mcap")
    data = open(f"{folder}/cut_0.mcap", "rb").read()
    with open(f"{folder}/cut_0.mcap", "wb") as file:
        file.write(data[:-120])
    report = imported(folder)
    check(report["frames"] == 3 and "cut_0.mcap is cut" in report["lost"], f"a cut file: {report['frames']}, {report['lost']}")
    check("cut_0.mcap: cut off at byte" in info(folder)["note"], f"info: {info(folder)['note']}")
    with open(f"{folder}/cut_1.mcap", "wb") as file:
        file.write(b"no bag")
    check(f"{folder}/cut_1.mcap: " in imported(folder, status=1), "a file that is none")
    folder = folder_of("bad", "bad_0.mcap", "bad_1.mcap")
    bag = camera(Bag(), first=2)
    bag.put("/pose", ros.POSE, 9 * SECOND, ros.pose(9 * SECOND, "map", (NAN, 0, 0)))
    bag.write(f"{folder}/bad_1.mcap")
    report = imported(folder)
    check(report["frames"] == 4 and "of bad_1.mcap: " in report["unreadable"][0]["first"], f"{report['unreadable']}")
    check(f"{folder}/bad_1.mcap: " in imported(folder, "--strict", status=1), "--strict names the file")


def packed_files():
    if shutil.which("zstd") is None:
        print("zstd is not there: no packed files")
        return
    folder = folder_of("packed", "p_0.mcap", "p_1.mcap", listed=("p_0.mcap.zstd", "p_1.mcap.zstd"))
    for i in range(2):
        subprocess.run(["zstd", "-q", "--rm", f"{folder}/p_{i}.mcap", "-o", f"{folder}/p_{i}.mcap.zstd"], check=True)
    report = imported(folder)
    check([p[0, 0, 0] for p in report["read"]["image"]] == [0, 10, 20, 30], f"packed files: {report['frames']}")
    check(imported(f"{folder}/p_1.mcap.zstd")["frames"] == 2 and info(f"{folder}/p_1.mcap.zstd")["frames"] == 2, "one alone")
    whole = open(f"{folder}/p_1.mcap.zstd", "rb").read()
    with open("text.txt", "w", encoding="ascii") as file:
        file.write("no bag")
    text = subprocess.run(["zstd", "-q", "-c", "text.txt"], stdout=subprocess.PIPE, check=True).stdout
    stream = subprocess.run(["zstd", "-q", "-c"], input=b"x" * 99, stdout=subprocess.PIPE, check=True).stdout
    for name, data, why in (("cut", whole[:-40], ""), ("flipped", whole[:90] + bytes([whole[90] ^ 1]) + whole[91:], ""),
                            ("unsized", stream, "zstd -d"), ("other", text, "not an MCAP file")):
        with open(f"{folder}/p_1.mcap.zstd", "wb") as file:
            file.write(data)
        error = imported(folder, status=1)
        check(f"{folder}/p_1.mcap.zstd: " in error and why in error, f"{name}: {error}")


def lenses_that_no_recording_holds():
    """k4 to k6, and coefficients beyond 128: import redraws colour, and depth of its view, as a pinhole's."""
    rows, columns = np.mgrid[:ros.HEIGHT, :ros.WIDTH]
    picture = np.stack([columns * 8, rows * 10, np.full_like(rows, 90)], 2).astype(np.uint8)
    steps = (1000 + 10 * columns).astype("<u2")
    rational = (0.6, -0.2, 0.001, -0.002, 0.05, 0.5, -0.15, 0.02)

    def seen(k, x, y):
        """Returns where the lens draws what a pinhole draws at (x, y)."""
        u, v = (x - 15.5) / 30, (y - 11.5) / 30
        r2 = u * u + v * v
        k = (*k, *[0] * (8 - len(k)))
        scale = (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])))
        return (30 * (u * scale + 2 * k[2] * u * v + k[3] * (r2 + 2 * u * u)) + 15.5,
                30 * (v * scale + k[2] * (r2 + 2 * v * v) + 2 * k[3] * u * v) + 11.5)

    for name, k, model, lens in (("k4 to k6", rational, "rational_polynomial", ros.LENS),
                                 ("k1 of 200", (200.0, 0, 0, 0, 0), "plumb_bob", (900.0, 900.0, 15.5, 11.5))):
        for own in (False, True):
            bag = Bag()
            message = ros.info(SECOND, "cam", lens=lens, d=k, model=model)
            bag.put("/cam/camera_info", ros.INFO, SECOND, message)
            if own:
                bag.put("/cam/depth/camera_info", ros.INFO, SECOND, message)
            bag.put("/cam/depth/image", ros.IMAGE, SECOND, ros.image(SECOND, "cam", "16UC1", steps))
            bag.put("/pose", ros.POSE, SECOND, ros.pose(SECOND, "map", (0, 0, 0)))
            bag.put("/cam/image", ros.IMAGE, SECOND, ros.image(SECOND, "cam", "bgr8", picture[..., ::-1].copy()))
            report = imported(bag)
            check(report["straightened"] == report["depth_frames"] == 1, f"{name}: {report['straightened']}")
            check(info("out.mcap")["distortion"] == "none" and info()["distortion"] == "rational", f"{name}: lens")
            got, z = report["read"]["image"][0], report["read"]["depth"][0]
            for y, x in ((3, 4), (12, 16), (20, 25)):
                due = seen(k, x, y) if name[1] == "4" else (x, y)
                off = np.abs(got[y, x, :2] - np.array([due[0] * 8, due[1] * 10])).max()
                check(off < 9 if name[1] == "4" else off < 20, f"{name}: ({x}, {y}) shows {got[y, x]}, due {due}")
                check(abs(int(z[y, x]) - (1000 + 10 * due[0])) <= (6 if name[1] == "4" else 25), f"{name}, {own}: depth at {x}, {y}")
    code, _, error = run("build", "bag.mcap", "--context", "0,0", "--gaussians", "9", "-o", "s.ply")
    check(code == 1 and "128" in error, f"build: {error}")


def large_pictures():
    """Sides above 4096: refused with the remedy, and resampled on reading with --size."""
    width, height = 4200, 16
    lens = (4000.0, 4000.0, 2099.5, 7.5)
    grey = np.tile((np.arange(width) // 20).astype(np.uint8), (height, 1))
    rgb = np.stack([grey, np.full_like(grey, 40), np.full_like(grey, 90)], 2)
    flat = np.full_like(grey, 128)
    yuyv = np.stack([grey, flat], 2).reshape(height, 2 * width)
    bayer = np.where((np.add.outer(np.arange(height), np.arange(width)) % 2 == 1), 40, grey).astype(np.uint8)
    bayer[1::2, 1::2] = 90
    cases = {"rgb8": rgb, "bgr8": rgb[..., ::-1].copy(), "mono8": grey, "yuv422_yuy2": yuyv, "nv12": np.concatenate([grey, flat[::2]]),
             "rgba8": np.concatenate([rgb, flat[..., None]], 2), "bayer_rggb8": bayer, "png": rgb, "rational": rgb}
    for name, rows in cases.items():
        bag = Bag()
        model = ("rational_polynomial", (0.02, 0, 0, 0, 0, 0.02, 0, 0)) if name == "rational" else ("plumb_bob", ())
        bag.put("/cam/camera_info", ros.INFO, SECOND, ros.info(SECOND, "cam", lens=lens, size=(width, height), model=model[0], d=model[1]))
        bag.put("/cam/depth", ros.IMAGE, SECOND, ros.image(SECOND, "cam", "16UC1", np.tile(np.arange(1050, dtype="<u2"), (4, 1))))
        bag.put("/pose", ros.POSE, SECOND, ros.pose(SECOND, "map", (0, 0, 0)))
        if name == "png":
            bag.put("/cam/image/compressed", ros.COMPRESSED, SECOND, ros.compressed(SECOND, "cam", "png", png([row.tobytes() for row in rows], channels=3)))
        else:
            encoding = "rgb8" if name == "rational" else name
            bag.put("/cam/image", ros.IMAGE, SECOND, ros.image(SECOND, "cam", encoding, rows, (height, width)))
        remedy = "4200x16 pixels; sides of up to 4096 are supported, larger ones with --size"
        check(remedy in imported(bag, status=1), f"{name}: refused")
        if encoding_is_stored(name):
            code, _, error = run("build", "bag.mcap", "--context", "0,0", "--gaussians", "9", "-o", "s.ply")
            check(code == 1 and remedy in error, f"{name}: build: {error}")
        report = imported("bag.mcap", "--size", "2100x8")
        picture, z = report["read"]["image"][0], report["read"]["depth"][0]
        k = report["read"]["camera_info"][0]
        check(np.abs(k - [[2000, 0, 1049.5], [0, 2000, 3.5], [0, 0, 1]]).max() < 1e-3, f"{name}: {k}")
        due = np.arange(2100) // 10
        if name in ("yuv422_yuy2", "nv12"):  # BT.601, limited range
            due = np.clip((due - 16) * 255 / 219, 0, 255)
        off = np.abs(picture[4, :, 0].astype(int) - due)
        check(picture.shape == (8, 2100, 3) and off.max() <= (20 if name == "bayer_rggb8" else 2), f"{name}: picture off by {off.max()}")
        check(np.abs(z[4].astype(int) - np.arange(2100) // 2).max() <= 1, f"{name}: depth")
        check(report["straightened"] == (name == "rational"), f"{name}: lens")
    lens = ",".join(map(str, lens))
    report = imported("bag.mcap", "--size", "300x8", "--intrinsics", lens)
    k = report["read"]["camera_info"][0]
    check(np.abs(k - [[2000, 0, 149.5], [0, 2000, 3.5], [0, 0, 1]]).max() < 1e-3, f"cropped: {k}")


def intrinsics_for_another_size():
    """--intrinsics state no size: they are for the first frame's, and their principal point lies in it."""
    bag = Bag()
    for i, side in enumerate((1, 2, 1)):
        ns = (i + 1) * SECOND
        bag.put("/pose", ros.POSE, ns, ros.pose(ns, "map", (i, 0, 0)))
        bag.put("/cam/image", ros.IMAGE, ns, ros.image(ns, "cam", "rgb8", np.full((side * ros.HEIGHT, side * ros.WIDTH, 3), 9, np.uint8)))
    report = imported(bag, "--intrinsics", "30,30,15.5,11.5")
    check(report["frames"] == 2 and "64x48 pixels, but --intrinsics are of the first frame's size, 32x24" in report["left_out"][0], f"{report}")
    for outside in ("30,30,32,11.5", "30,30,15.5,-1"):
        check("principal point of --intrinsics is outside its 32x24 pixels" in imported("bag.mcap", "--intrinsics", outside, status=1), outside)
    check(imported("bag.mcap", "--intrinsics", "30,30,31.5,-0.5")["frames"] == 2, "in the corner")


def encoding_is_stored(name):
    return name in ("rgb8", "bgr8", "mono8", "yuv422_yuy2", "nv12")


with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    for case in (depth_is_chosen_by_name_and_type, poses_are_not_goals, frames_with_two_parents, depth_of_another_clock, colour_is_chosen_by_votes, intrinsics_are_of_the_same_frame,
                 channels_of_a_topic_are_one_stream, clocks_that_begin_again, clocks_that_stand, bad_poses_are_left_out, bad_images_are_left_out,
                 jpegs_without_their_end, triplets_follow_the_frames, rectified_images_have_the_lens_of_p, depth_of_another_aspect_needs_its_own_lens, encodings, transparent_pixels_are_none, images_that_exif_turns, depth_units, other_files,
                 folders_of_rosbag2, bad_files_of_a_folder, packed_files, lenses_that_no_recording_holds, large_pictures, intrinsics_for_another_size):
        case()
    done()
