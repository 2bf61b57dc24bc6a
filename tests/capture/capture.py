#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""capture.py TRIM3R: the command for users: sources, signals, files that roll over, poses, events, --build."""
import json
import os
import pty
import signal
import subprocess
import tempfile
import time

import mcap_read
from checks import check, done
from program import TRIM3R, expect, expect_json


def capture(source, *options, code=0, words=""):
    out = expect(code, "capture", "--source", source, "--json", *options, err=words)
    return json.loads(out) if code == 0 else None


def read(path):
    with open(path, "rb") as file:
        return file.read()


def of_topic(path, topic):
    return [message for name, _, message in mcap_read.messages(read(path)) if name == topic]


def copies():
    """A recording of a recording has exactly the same frames."""
    room = capture("replay:room.mcap", "--hash", "-o", "copy.mcap")
    again = capture("replay:copy.mcap", "--hash")
    check(room["frames"] == again["frames"] == 12 and room["paired"] == 12, "all frames")
    check(room["frames_hash"] == again["frames_hash"], "the frames' hash")
    check(room["bytes"] == os.path.getsize("copy.mcap"), "bytes told are those on the disk")
    room = expect_json("replay", "room.mcap", "--refine", 0)
    copy = expect_json("replay", "copy.mcap", "--refine", 0)
    check(room["hash"] == copy["hash"], "every stage")
    thrice = capture("replay:room.mcap", "--repeat", 3, "-o", "thrice.mcap")
    stamps = [mcap_read.stamp(mcap_read.Cdr(m)) for m in of_topic("thrice.mcap", "/camera/image")]
    check(thrice["frames"] == 36 and stamps == sorted(set(stamps)), "repeated, its clock going on")
    check(capture("replay:room.mcap", "--frames", 5, "--hash")["frames"] == 5, "--frames")


def builds():
    live = capture("replay:room.mcap", "--build", "live.ply", "--context", "1,4", "--gaussians", 700, "--refine", 1)
    later = expect_json("build", "room.mcap", "-o", "later.ply", "--context", "1,4", "--gaussians", 700, "--refine",
                           1)
    check(live["hash"] == later["hash"] and live["context"] == [1, 4], "live is what build makes")
    check(read("live.ply") == read("later.ply"), "the scenes' files")
    often = capture("replay:room.mcap", "--build", "often.ply", "--every", 4, "--keep", "5%", "--refine", 0)
    check(often["builds"] == 2 and often["context"] == [4, 8], "builds of every fourth frame")
    later = json.loads(expect(0, "build", "room.mcap", "-o", "later.ply", "--context", "4,8", "--keep", "5%", "--refine", 0,
                           "--json"))
    check(often["hash"] == later["hash"] and read("often.ply") == read("later.ply"), "the last of them")
    few = capture("replay:room.mcap", "--build", "auto.ply", "--auto", "--max-loss", 3, "--refine", 1)
    later = expect_json("build", "room.mcap", "-o", "later.ply", "--auto", "--max-loss", 3, "--refine",
                           1)
    check(few["hash"] == later["hash"] and few["gaussians"] == later["gaussians"] < 6144, "--auto, live")
    capture("replay:room.mcap", "--build", "no.ply", "--context", "0,40", code=1, words="nothing was built")
    capture("replay:bare.mcap", "--build", "no.ply", code=1, words="has no pose")
    capture("replay:room.mcap", "--build", "no.ply", "--arena", 1000, code=3, words="too small")


def rows_of(path):
    with open(path) as file:
        return [{key: value for key, value in json.loads(line).items() if key not in ("ms", "psnr_before", "stages_ms")} for line in file]


def streams():
    """A map of live frames is that of their replay, and continues from its state."""
    base = ("--gaussians", 300, "--every", 1, "--refine", 1)
    replayed = expect_json("replay", "room.mcap", "--stream", *base, "-o", "replayed.ply", "--lines", "replayed.jsonl")
    live = ("--build", "map.ply", "--stream", *base)
    found = capture("replay:room.mcap", *live, "--lines", "map.jsonl", "--snapshot", 5)
    check(rows_of("map.jsonl") == rows_of("replayed.jsonl"), "the rows of a replay")
    check(read("map.ply") == read("replayed.ply"), "and its map")
    check(found["keyframes"] == 12 and found["gaussians"] == 300 and found["hash"] == replayed["keyframes"][-1]["hash"], f"{found}")
    twice = capture("replay:room.mcap", "--repeat", 2, *live)
    capture("replay:room.mcap", *live, "--state", "room.t3s")
    again = capture("replay:room.mcap", *live, "--state", "room.t3s", "--resume", "--lines", "more.jsonl")
    check(again["hash"] == twice["hash"] and rows_of("more.jsonl")[0]["keyframe"] == 13, "it continues")
    table = expect(0, "capture", "--source", "replay:room.mcap", *live)
    check(table.count(" taken\n") == 12 and "300 Gaussians after 12 keyframes" in table, f"a row a keyframe: {table}")
    hurried = capture("replay:room.mcap", *live, "--max-ms", 10000)
    check("hash" not in hurried, "no hash that cannot be compared")
    capture("replay:bare.mcap", *live, code=1, words="ended before the first keyframe")
    expect(2, "capture", "--source", "replay:room.mcap", "-o", "no.mcap", "--stream", err="--stream needs --build")
    expect(2, "capture", "--source", "replay:room.mcap", *live, "--local", err="takes no --local")
    expect(2, "capture", "--source", "replay:room.mcap", "--build", "a.ply", "--half-life", 5, err="--half-life belongs to --stream")
    expect(2, "capture", "--source", "replay:room.mcap", "--build", "a.ply", "--snapshot", 5, err="--snapshot belongs to --stream")


def stream_stops(number):
    """A signal: exit status 0, and a whole map of all keyframes so far."""
    command = [TRIM3R, "capture", "--source", "replay:room.mcap", "--repeat", "4000000000", "--json", "--build", "stop.ply",
               "--stream", "--gaussians", "300", "--lines", "stop.jsonl"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        until = time.monotonic() + 60
        while not (os.path.exists("stop.jsonl") and read("stop.jsonl").count(b"\n") > 9):
            check(time.monotonic() < until, "it takes keyframes")
            time.sleep(0.005)
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
    check(process.returncode == 0, f"signal {number}: {process.returncode} {err}")
    found, rows = json.loads(out), rows_of("stop.jsonl")
    check(found["keyframes"] == len(rows) and found["hash"] == rows[-1]["hash"], f"all keyframes: {found}")
    check(expect_json("info", "stop.ply")["scenes"][0]["gaussians"] == 300, "a whole map")
    os.remove("stop.jsonl")
    os.remove("stop.ply")


def bare():
    """A recording without poses and intrinsics, like one of a camera alone."""
    with open("far.txt", "w", encoding="ascii") as file:
        file.write("9000 0 0 0 0 0 0 1\n9000.1 0 0 0 0 0 0 1\n")
    told = capture("replay:room.mcap", "--poses", "far.txt", "-o", "bare.mcap")
    check(told["unposed"] == 12 and not of_topic("bare.mcap", "/camera/pose"), "no pose is made up")


def poses():
    room = [mcap_read.pose(m) for m in of_topic("room.mcap", "/camera/pose")]
    with open("tum.txt", "w", encoding="ascii") as file:
        for stamp, pose in room:
            file.write(f"{stamp // 10**9 + 100}.{stamp % 10**9:09d} " + " ".join(map(repr, pose)) + "\n")
    asked = ("--hash", "--poses")
    expected = capture("replay:room.mcap", "--hash")["frames_hash"]
    for source, offset in (("tum.txt", "100"), ("room.mcap", "0")):
        told = capture("replay:bare.mcap", *asked, source, "--clock-offset", offset)
        check(told["frames_hash"] == expected and told["unposed"] == 0, f"poses by {source}")
    half = capture("replay:bare.mcap", *asked, "tum.txt", "--clock-offset", "100.016666666", "-o", "half.mcap")
    between = [mcap_read.pose(m)[1] for m in of_topic("half.mcap", "/camera/pose")]
    check(half["unposed"] == 1 and len(between) == 11, "the last frame lies behind the trajectory")
    check(all(abs(b - (r[1][i] + s[1][i]) / 2) < 1e-6 for b_, r, s in zip(between, room, room[1:])
              for i, b in enumerate(b_[:3])), "positions in the middle")
    lens = capture("replay:bare.mcap", "--intrinsics", "70,71,31.5,23.5,0.1,-0.2,0.001,0.002,0.05", "-o", "lens.mcap")
    check(lens["frames"] == 12, "intrinsics")
    check(expect_json("info", "lens.mcap")["distortion"] == "radtan", "a lens with distortion")
    expect(1, "capture", "--source", "replay:bare.mcap", "--poses", "tum.txt", "--clock-offset", "estimate", "--hash", err="offset cannot")
    for far in ("4000000000", "79999999999", "-18446744073", "99999999999999999999", "estimate:4000000000"):
        expect(2, "capture", "--source", "replay:bare.mcap", "--poses", "tum.txt", "--clock-offset", far, "--hash", err="--clock-offset takes")
    told = capture("replay:bare.mcap", *asked, "tum.txt", "--clock-offset", "-3999999999.999999999")
    check(told["unposed"] == 12, "the farthest offset there is")
    expect(2, "capture", "--source", "v4l2:/dev/video0", "--poses", "tum.txt", "--clock-offset", "estimate", "--hash", err="record, then")


def rolls_over():
    most = 40000
    told = capture("replay:room.mcap", "--repeat", 4, "--max-bytes", most, "-o", "roll.mcap")
    names = ["roll.mcap"] + [f"roll-{i}.mcap" for i in range(1, told["files"])]
    sizes = [os.path.getsize(name) for name in names]
    check(len(names) > 4 and max(sizes) <= most and sum(sizes) == told["bytes"], f"{sizes}")
    frames = [expect_json("info", name)["frames"] for name in names]
    check(sum(frames) == 48, f"no frame is lost between files: {frames}")
    capture("replay:room.mcap", "--max-bytes", "20k", "-o", "no.mcap", code=1, words="does not hold one frame")


def spares_what_it_reads():
    """Neither the first file nor a later one replaces the recording or the poses, by whatever name."""
    with open("spare-1.mcap", "wb") as file:
        file.write(read("room.mcap"))
    os.symlink("spare-1.mcap", "link-2.mcap")
    for name in ("spare.mcap", "link.mcap"):
        capture("replay:spare-1.mcap", "--repeat", 4, "--max-bytes", 40000, "-o", name, code=1,
                words="is --source spare-1.mcap, too: it is not overwritten")
        check(read("spare-1.mcap") == read("room.mcap"), "the recording that is replayed is whole")
        check(expect_json("info", name)["note"] == "", "and the file before is")
    capture("replay:room.mcap", "--poses", "spare-1.mcap", "-o", "spare-1.mcap", code=2, words="are one file")
    check(read("spare-1.mcap") == read("room.mcap"), "the poses are whole")


def stops(number):
    """A signal: exit status 0, and a complete recording."""
    command = [TRIM3R, "capture", "--source", "replay:room.mcap", "--repeat", "4000000000", "--json", "-o",
               "signal.mcap"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        until = time.monotonic() + 60
        while not (os.path.exists("signal.mcap") and os.path.getsize("signal.mcap") > 200000):
            check(time.monotonic() < until, "it records")
            time.sleep(0.005)
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
    check(process.returncode == 0, f"signal {number}: {process.returncode} {err}")
    told, info = json.loads(out), expect_json("info", "signal.mcap")
    check(info["frames"] == told["frames"] and info["note"] == "", f"a whole recording: {info['note']}")
    os.remove("signal.mcap")


def peak_kilobytes(*options):
    process = subprocess.Popen([TRIM3R, "capture", "--source", "replay:room.mcap", "--quiet", "-o", "/dev/null",
                                *options], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    check(status == 0, f"capture {options}")
    return used.ru_maxrss


def memory():
    few, many = peak_kilobytes("--repeat", "9"), peak_kilobytes("--repeat", "834")
    check(many <= few * 1.05 + 256, f"10,000 frames take the memory of 100: {few} and {many} KB")


def progress():
    """On a terminal a line with rate, drops and size of the work; elsewhere none."""
    leader, follower = pty.openpty()
    process = subprocess.Popen([TRIM3R, "capture", "--source", "replay:room.mcap", "--repeat", "4000000000", "--hash"],
                               stdout=subprocess.DEVNULL, stderr=follower)
    os.close(follower)
    said = b""
    while said.count(b"frames, ") < 3:
        said += os.read(leader, 4096)
    process.send_signal(signal.SIGINT)
    check(process.wait(60) == 0, "Ctrl-C")
    os.close(leader)
    check(b"/s, dropped 0 (0 slow), corrupted 0" in said, said.decode())
    check(subprocess.run([TRIM3R, "capture", "--source", "replay:room.mcap", "--repeat", "2000", "--hash"],
                         capture_output=True).stderr == b"", "no line where nobody looks")


def stops_before_it_begins():
    """Ctrl-C while the clocks' offset is estimated: an existing file with the output's name stays."""
    with open("kept.mcap", "wb") as file:
        file.write(b"\x89MCAP0\r\nof before")
    expect(0, "room", "--size", "640x480", "--frames", 2, "-o", "large.mcap")  # so that it takes long
    leader, follower = pty.openpty()
    process = subprocess.Popen([TRIM3R, "capture", "--source", "replay:large.mcap", "--repeat", "4000000000", "--poses",
                                "tum.txt", "--clock-offset", "estimate", "-o", "kept.mcap"],
                               stdout=subprocess.DEVNULL, stderr=follower)
    os.close(follower)
    said = b""
    while b"clocks' offset" not in said:
        said += os.read(leader, 4096)
    process.send_signal(signal.SIGINT)
    try:
        while more := os.read(leader, 4096):
            said += more
    except OSError:  # the other end is closed
        pass
    check(process.wait(60) == 1 and b"stopped before the capture began" in said, said.decode())
    os.close(leader)
    check(read("kept.mcap") == b"\x89MCAP0\r\nof before", "the output is not touched")


def killed():
    command = [TRIM3R, "capture", "--source", "replay:room.mcap", "--repeat", "4000000000", "-o", "kill.mcap"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        until = time.monotonic() + 60
        while not (os.path.exists("kill.mcap") and os.path.getsize("kill.mcap") > 200000):
            check(time.monotonic() < until, "it records")
            time.sleep(0.005)
        process.kill()
    info = expect_json("info", "kill.mcap")
    check(info["frames"] > 5 and "cut off" in info["note"], "what was whole is there")
    os.remove("kill.mcap")


def refusals():
    expect(2, "capture", err="--source is missing")
    expect(2, "capture", "--source", "replay:room.mcap", err="-o REC.mcap or --build")
    expect(1, "capture", "--source", "nothing:at-all", "--hash", err="is none of")
    expect(1, "capture", "--source", "replay:missing.mcap", "--hash", err="No such file")
    expect(1, "capture", "--source", "v4l2:/dev/null", "--hash", err="is not a video device")
    expect(1, "capture", "--source", "v4l2:missing", "--hash", err="No such file")
    expect(2, "capture", "--source", "replay:room.mcap", "--build", "a.ply", "--context", "2,1",
        err="must ascend")
    expect(2, "capture", "--source", "replay:room.mcap", "--build", "a.ply", "--context", "1,2", "--every", 2,
        err="exclude")
    expect(2, "capture", "--source", "replay:room.mcap", "--build", "a.ply", "--depth", "stereo",
        err="--depth stereo needs a recording")
    expect(2, "capture", "--source", "replay:room.mcap", "--hash", "--max-bytes", "10X", err="--max-bytes")
    expect(1, "capture", "--source", "replay:room.mcap", "-o", "/dev/full", err="cannot be written")
    expect(2, "capture", "--source", "replay:room.mcap", "--hash", "--intrinsics", "1,2", err="--intrinsics")
    expect(1, "capture", "--source", "replay:room.mcap", "--hash", "--intrinsics", "5,5,5,5", err="focal length")
    expect(2, "capture", "--source", "replay:room.mcap", "-o", "../" + os.path.basename(os.getcwd()) + "/room.mcap",
        err="are one file")
    for source, options, words in (
            ("replay:room.mcap", ("--size", "64x48"), "--size is of no use to replay: it belongs to v4l2 libcamera"),
            ("replay:room.mcap", ("--rate", "30"), "--rate is of no use"),
            ("replay:room.mcap", ("--format", "GREY"), "--format is of no use"),
            ("replay:room.mcap", ("--depth-source", "a"), "--depth-source is of no use"),
            ("replay:room.mcap", ("--pair", "5"), "--pair is of no use"),
            ("replay:room.mcap", ("--reconnect", "5"), "--reconnect is of no use"),
            ("v4l2:/dev/null", ("--repeat", "2"), "--repeat is of no use to v4l2: it belongs to replay"),
            ("v4l2:/dev/null", ("--backend", "V4L2"), "--backend is of no use"),
            ("opencv:a.avi", ("--buffers", "3"), "--buffers is of no use"),
            ("libcamera:0", ("--depth-source", "a"), "--depth-source is of no use"),
            ("v4l2:/dev/null", ("--depth-size", "64x48"), "--depth-size belongs to --depth-source"),
            ("v4l2:/dev/null", ("--depth-unit", "0.001"), "--depth-unit belongs to"),
            ("v4l2:/dev/null", ("--pair", "5"), "--pair belongs to"),
            ("v4l2:/dev/null", ("--sync",), "belong to -o")):
        expect(2, "capture", "--source", source, "--hash", *options, err=words)
    expect(1, "capture", "--source", "v4l2:/dev/null", "--hash", "--depth-source", "/dev/null", "--pair", 5, "--depth-size",
        "64x48", "--depth-unit", 0.001, "--size", "64x48", "--rate", 30, "--format", "GREY", "--buffers", 3, "--stall",
        100, "--reconnect", 0, err="is not a video device")
    listed = expect(0, "capture", "--list")
    check(all(name in listed for name in ("replay", "v4l2", "libcamera", "opencv")), "--list names every adapter")
    for name in ("v4l2", "libcamera", "opencv"):
        line = next(line for line in listed.splitlines() if line.startswith(name))
        check(" yes " in line or "not in this build" in line or "does not load" in line, f"--list: {line}")


def events():
    """The counts are also in the recording, each with its level."""
    expect(0, "capture", "--source", "replay:room.mcap", "-o", "quiet.mcap", "--quiet")
    schemas = [content for opcode, content in mcap_read.records(read("quiet.mcap")) if opcode == 0x03]
    check(any(b"rcl_interfaces/msg/Log" in content for content in schemas), "the topic of events")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    expect(0, "room", "--size", "64x48", "--frames", 12, "-o", "room.mcap")
    copies()
    bare()
    builds()
    streams()
    stream_stops(signal.SIGINT)
    stream_stops(signal.SIGTERM)
    poses()
    rolls_over()
    spares_what_it_reads()
    stops(signal.SIGINT)
    stops(signal.SIGTERM)
    stops_before_it_begins()
    killed()
    memory()
    progress()
    refusals()
    events()
done()
