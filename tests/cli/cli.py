#!/usr/bin/env python3
"""The trim3r program from outside: exit codes, messages, JSON, and what must not change a bit.

    cli.py PATH/TO/trim3r"""
import csv
import json
import os
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.dom.minidom
import zlib

TRIM3R = os.path.abspath(sys.argv[1])
HEADS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "quant", "heads")
failures = []
checks = 0


def run(*arguments):
    done = subprocess.run([TRIM3R, *map(str, arguments)], capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


def check(condition, what):
    global checks
    checks += 1
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def expect(code, *arguments, err=None, out=None):
    """Runs and checks the exit code and a piece of either stream; an error must say something, and only there."""
    got, stdout, stderr = run(*arguments)
    line = " ".join(map(str, arguments))
    check(got == code, f"{line}: exit {got}, not {code}: {stderr.strip()}")
    if code != 0:
        check(stderr.strip() != "", f"{line}: no message")
    if err:
        check(err in stderr, f"{line}: '{stderr.strip()}' does not say '{err}'")
    if out:
        check(out in stdout, f"{line}: '{stdout.strip()}' does not say '{out}'")
    return stdout


def fill_disk():
    """In the child: no file grows beyond 64 bytes, as on a full disk."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (64, resource.RLIM_INFINITY))


def expect_full(target, *arguments):
    """Exit 1 that names `target` when the disk is full, and neither a whole nor a partial file left there."""
    # Python ignores the signal that would come first; the child must, too
    done = subprocess.run([TRIM3R, *map(str, arguments)], capture_output=True, text=True, timeout=300,
                          preexec_fn=fill_disk, restore_signals=False)
    line = " ".join(map(str, arguments))
    check(done.returncode == 1 and target in done.stderr, f"{line} on a full disk: {done.returncode} {done.stderr}")
    check(not [name for name in os.listdir(".") if name.startswith(target)], f"{line} on a full disk leaves a file")


def expect_json(*arguments):
    stdout = expect(0, *arguments, "--json")
    try:
        return json.loads(stdout)
    except ValueError:
        check(False, f"{' '.join(map(str, arguments))}: not JSON: {stdout[:200]}")
        return {}


def write(path, content):
    with open(path, "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())
    return path


def png(width, height):
    """A grey-brown RGB picture."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes((120, 110, 100)) * width for _ in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


COMMANDS = ["import", "room", "info", "build", "render", "eval", "replay", "diff", "plan", "bench", "quantize",
            "head-info", "stress"]
POSE = {"fl_x": 220, "w": 64, "h": 48, "transform_matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}


def test_dispatch():
    expect(2)
    expect(2, "paint", err="paint")
    expect(0, "--version", out="bits epoch")
    summary = expect(0, "--help", out="COMMAND")
    for command in COMMANDS:
        check(f"\n  {command} " in summary, f"--help does not list {command}")
        text = expect(0, command, "--help", out="trim3r " + command)
        check("Example" in text, f"{command} --help has no examples")
        check(all(len(line) < 80 for line in text.splitlines()), f"{command} --help is wider than 79 columns")
        check("--json" in text, f"{command} has no --json")
        expect(2, command, "--no-such-option", err="no-such-option")
    # a result that cannot be printed is an error
    with open("out.txt", "w") as out:
        done = subprocess.run([TRIM3R, "plan", "--size", "64x64", "--gaussians", "5"], stdout=out, text=True,
                              stderr=subprocess.PIPE, preexec_fn=fill_disk, restore_signals=False)
    check(done.returncode == 1 and "standard output: " in done.stderr, f"plan to a full disk: {done.returncode}")


def test_build(room):
    expect(2, "build", err="REC.mcap is missing")
    expect(2, "build", room, "--keep", 10, err="-o")
    expect(2, "build", room, room, "--keep", 10, "-o", "s.ply", err="too many")
    expect(2, "build", room, "--keep", 10, "-o", "s.obj", err=".ply")
    expect(2, "build", room, "-o", "s.ply", err="budget")
    expect(2, "build", room, "--keep", 10, "--gaussians", 5, "-o", "s.ply", err="exclude")
    for option, values in {
        "--keep": ["0", "101", "x", "-3", "10,20", ""],
        "--gaussians": ["0", "x", "-1", "16777217", "1.5"],
        "--context": ["", "a", "0,", "-1", ",".join(map(str, range(17)))],
        "--allocate": ["evenly", ""],
        "--head": ["big", "", "learned", ".t3w", "small.c"],
        "--wavelet": ["db9"],
        "--levels": ["0", "6"],
        "--clusters": ["0", "513"],
        "--gamma": ["-1", "2.1", "x", "nan"],
        "--keep-percent": ["101"],
        "--fill-radius": ["9"],
        "--bridge-radius": ["256"],
        "--flying": ["1", ""],
        "--redundancy": ["yes"],
        "--exposure": ["On"],
        "--seed": ["-1", "4294967296"],
        "--working": ["64", "4x64", "64x5000"],
        "--arena": ["x", "-1", "1k", ""],
        "--threads": ["0", "65"],
        "--cpu-mask": ["all"],
        "--method": ["best", "", "pup+", "+finetune"],
        "--finetune-iterations": ["0", "100001", "x"],
        "--depth": ["Stereo", "radar", ""],
        "--refine": ["17", "x"],
    }.items():
        for value in values:
            expect(2, "build", room, "-o", "s.ply", f"{option}={value}", err=option)
    for loss in ("0", "0.001", "11", "-1", "x", "1e3", ""):
        expect(2, "build", room, "--auto", f"--max-loss={loss}", "-o", "s.ply", err="--max-loss")
    expect(2, "build", room, "--keep", 10, "--max-loss", 1, "-o", "s.ply", err="belongs to --auto")
    expect(2, "build", room, "--auto", "--refine", 0, "-o", "s.ply", err="--refine 1 or more")
    expect(2, "build", room, "--auto", "--method", "eagles", "-o", "s.ply", err="not for eagles")
    expect(2, "build", room, "--keep", 10, "--context", "1,1", "-o", "s.ply", err="twice")
    expect(1, "build", room, "--keep", 10, "--context", "0,99", "-o", "s.ply", err="no frame 99")
    expect(1, "build", room, "--keep", 10, "-o", "missing/s.ply", err="missing/s.ply")
    os.mkdir("folder.ply")
    expect(1, "build", room, "--keep", 10, "-o", "folder.ply", err="folder.ply: not a regular file")
    expect_full("full.ply", "build", room, "--keep", 10, "-o", "full.ply")

    found = expect_json("build", room, "--context", "0,2", "--keep", "10%", "-o", "scene.ply")
    check(found["head"] == "small" and found["head_bits"] == "8", "small is not the head unless another is named")
    for key in ("gaussians", "arena_bytes", "hash", "valid_points", "bits_epoch", "origin", "exponent"):
        check(key in found, f"build --json has no {key}")
    check(found["gaussians"] == (found["valid_points"] * 10 + 50) // 100, "--keep 10% is not a tenth")
    exact = expect_json("build", room, "--gaussians", 777, "-o", "exact.ply")
    check(exact["gaussians"] == 777, "--gaussians is not met exactly")
    few = expect_json("build", room, "--context", "0,2", "--working", "64x64", "--auto", "--max-loss", 3, "-o", "few.ply")
    some = expect_json("build", room, "--context", "0,2", "--working", "64x64", "--auto", "-o", "some.ply")
    check(some["max_loss"] == 0.5 and 0 < few["gaussians"] < some["gaussians"] < some["valid_points"],
          "--auto takes no fewer for more loss")
    expect(0, "eval", room, "--working", "64x64", "--context", "0,2", "--target", 1, "--auto", "--csv", "auto.csv")
    with open("auto.csv", newline="") as table:
        row = next(csv.DictReader(table))
    check(row["settings"] == "max-loss-0.5 working-64x64" and int(row["gaussians"]) == some["gaussians"],
          "eval --auto does not take what build --auto takes")
    most = expect_json("build", room, "--context", "0,2", "--working", "64x64", "--auto", "--gaussians", 50, "-o", "most.ply")
    check(most["gaussians"] == 50, "--gaussians is not the most of --auto")
    text = expect(0, "build", room, "--working", "32x32", "--gaussians", 100000, "-o", "all.ply",
                  out="all valid points are used")
    check("100000" in text, "the count asked for is not told")
    expect(0, "build", room, "--working", "32x32", "--gaussians", 9, "--head", "none", "--method", "random",
           "--comments", "-o", "named.ply")
    named = open("named.ply", "rb").read()
    check(b"comment trim3r bits_epoch" in named, "--comments writes none")
    check(b"comment trim3r head none\n" in named, "--comments does not name the head")
    check(b"comment" not in open("exact.ply", "rb").read(), "a comment is in the header unasked")


def vertices(path, count=68):
    """The rows of a scene file, as a set, or the first `count` bytes of them: 12 are the positions."""
    body = open(path, "rb").read().split(b"end_header\n", 1)[1]
    return {body[i:i + count] for i in range(0, len(body), 68)}


def test_rivals(room):
    """Scenes of the rivals: exact counts, Gaussians of the unpruned scene or tuned ones; no hash."""
    small = ["build", room, "--context", "0,2", "--working", "32x32", "--refine", 1]
    whole = expect_json(*small, "--keep", 100, "--comments", "-o", "whole.ply")
    check("hash" in whole and whole["method"] == "trim3r", "a scene of trim3r has its hash")
    for rival in ("random", "eagles", "lightgaussian", "pup", "efficientgs"):
        found = expect_json(*small, "--gaussians", 300, "--method", rival, "-o", "rival.ply")
        check(found["gaussians"] == 300 and found["requested"] == 300, f"{rival} does not meet its count")
        check("hash" not in found and "allocate" not in found, "a scene of a rival promises bits")
        check(found["valid_points"] == whole["valid_points"] and found["head"] == "small", "what was pruned")
        check(vertices("rival.ply") < vertices("whole.ply"), f"{rival} changes what it keeps")
    tuned = expect_json(*small, "--gaussians", 300, "--method", "efficientgs+finetune", "--finetune-iterations", 2,
                        "-o", "tuned.ply")
    check(tuned["gaussians"] == 300 and "hash" not in tuned, "fine-tuning keeps the count")
    check(not vertices("tuned.ply") & vertices("rival.ply"), "fine-tuning leaves Gaussians as they are")
    expect(0, "render", "tuned.ply", room, "--view", 1, "-o", "tuned.png")
    text = expect(0, *small, "--gaussians", 100000, "--method", "eagles", "-o", "all.ply",
                  out="all valid points are used")
    check("100000" in text, "the count asked for is not told")
    expect(2, "replay", room, "--method", "pup", err="floats")

    prune = ["build", room, "--context", "0,2", "--working", "32x32", "--prune", "whole.ply"]
    found = expect_json(*prune, "--keep", "50%", "--method", "eagles", "-o", "half.ply")
    check(found["gaussians"] == (whole["gaussians"] + 1) // 2 and found["pruned"] == "whole.ply", "half of a scene")
    check("head" not in found and found["context"] == [0, 2] and found["width"] == 32, "what is told of a pruned scene")
    expect_json(*small, "--keep", 50, "--method", "eagles", "-o", "own.ply")
    check(len(vertices("half.ply", 12) & vertices("own.ply", 12)) > 0.98 * found["gaussians"],
          "a scene from a file is not pruned as the one that it was written from")
    found = expect_json(*prune, "--gaussians", 9, "--method", "pup+finetune", "--finetune-iterations", 1, "-o", "9.ply")
    check(found["gaussians"] == 9, "a pruned scene's count")
    found = expect_json(*prune, "--keep", 9, "-o", "x.ply")
    check((found["method"], found["head"], found["pruned"]) == ("trim3r", "small", "whole.ply") and "hash" in found and
          found["gaussians"] == int(whole["gaussians"] * 0.09 + 0.5), "trim3r prunes a scene, too")
    expect(2, *prune, "--keep", 9, "--method", "pup+head", "-o", "x.ply", err="+head")
    expect(1, "build", room, "--prune", "none.ply", "--keep", 9, "--method", "pup", "-o", "x.ply", err="none.ply")
    header = open("whole.ply", "rb").read().split(b"end_header\n", 1)[0]
    count = f"element vertex {whole['gaussians']}".encode()
    write("empty.ply", header.replace(count, b"element vertex 0") + b"end_header\n")
    expect(1, "build", room, "--prune", "empty.ply", "--keep", 9, "--method", "lightgaussian", "-o", "x.ply",
           err="no Gaussians")
    expect(1, *prune[:3], "0,99", *prune[4:], "--keep", 9, "--method", "pup", "-o", "x.ply", err="no frame 99")
    expect(2, *prune[:3], "0,0", *prune[4:], "--keep", 9, "--method", "pup", "-o", "x.ply", err="twice")


def weight_file(path, bits="8"):
    """The float head small, quantized under the file's name; the file's bytes."""
    expect(0, "quantize", os.path.join(HEADS, "small.safetensors"), "--calibrate", "tiny.mcap", "--weights", bits,
           "--activations", bits, "--name", path.split(".")[0], "-o", path)
    return open(path, "rb").read()


def test_heads(room):
    expect(0, "room", "--size", "32x32", "-o", "tiny.mcap")
    whole = weight_file("mine.t3w")
    weight_file("wide.t3w", "16")
    base = ["build", room, "--working", "64x64", "--gaussians", 500, "-o", "head.ply"]
    hashes = {}
    for head in ("analytic", "moment", "none", "nano", "small", "base", "mine.t3w", "wide.t3w"):
        found = expect_json(*base, "--head", head, "--comments")
        hashes[head] = found["hash"]
        name = head.split(".")[0]
        check(found["head"] == name, f"--head {head}: build names {found['head']}")
        comment = f"comment trim3r head {name}"
        if "head_crc" in found:
            comment += f" crc {found['head_crc']}"
            check(found["head_bits"] == ("16" if head == "wide.t3w" else "8"), f"--head {head}: bits")
        check((comment + "\n").encode() in open("head.ply", "rb").read(), f"--head {head}: not in the comments")
        check(("head_crc" in found) == (head not in ("analytic", "moment", "none")), f"--head {head}: CRC")
    check(len(set(hashes.values())) == len(hashes), f"heads give the same scene: {hashes}")
    crc = expect_json(*base, "--head", "mine.t3w")["head_crc"]
    check(crc == expect_json("head-info", "mine.t3w")["crc"] == whole[15:11:-1].hex(), "the CRC")
    # the closed forms never see weights, networks the same bits however many bytes and threads there are
    check(len({expect_json(*base, "--head", "wide.t3w", "--arena", arena, "--threads", threads)["hash"]
               for arena, threads in (("min", 1), ("full", 3))}) == 1, "arena or threads change a learned scene")
    # weights that are refused say why
    for name, content, why in [("cut.t3w", whole[:-4], "not as long as it says"), ("foreign.t3w", b"RIFF" + whole[4:], "not a weight file"),
                               ("empty.t3w", b"", "not a weight file"), ("bit.t3w", whole[:-1] + bytes([whole[-1] ^ 1]), "CRC"),
                               ("epoch.t3w", whole[:6] + b"\xff\xff" + whole[8:], "epoch")]:
        write(name, content)
        for command in (base, ["replay", room], ["plan", "--size", "64x64", "--gaussians", 5], ["bench", "--runs", 1]):
            expect(1, *command, "--head", name, err=name)
        expect(1, *base, "--head", name, err=why)
    expect(1, *base, "--head", "absent.t3w", err="absent.t3w")


def test_recordings(room):
    whole = open(room, "rb").read()
    bad = {
        "empty.mcap": b"",
        "magic.mcap": b"RIFF" + whole[4:],
        "text.mcap": b"hello, world\n" * 99,
        "short.mcap": whole[:7],
    }
    for name, content in bad.items():
        write(name, content)
        for command in (["build", name, "--keep", 10, "-o", "s.ply"], ["replay", name], ["info", name],
                        ["render", "scene.ply", name, "--view", 0, "-o", "v.png"]):
            expect(1, *command, err=name)
    for command in (["build", "absent.mcap", "--keep", 10, "-o", "s.ply"], ["replay", "absent.mcap"],
                    ["info", "absent.mcap"], ["eval", "absent.mcap", "--keep", 10]):
        expect(1, *command, err="absent.mcap")
    expect(1, "replay", ".", err=".")
    if os.geteuid() != 0:
        write("locked.mcap", whole)
        os.chmod("locked.mcap", 0)
        expect(1, "replay", "locked.mcap", err="locked.mcap")
    # a cut recording holds fewer frames, and says so when asked for more
    write("cut.mcap", whole[:len(whole) // 2])
    expect(1, "build", "cut.mcap", "--keep", 10, "--context", "0,5", "-o", "s.ply", err="cut.mcap")
    # pictures without depth
    os.mkdir("flat")
    write("flat/a.png", png(64, 48))
    write("flat/transforms.json", json.dumps({"frames": [dict(POSE, file_path="a.png")]}))
    expect(1, "import", "absent", "-o", "flat.mcap", err="absent")
    expect(0, "import", "flat", "-o", "flat.mcap")
    expect(1, "build", "flat.mcap", "--keep", 10, "-o", "s.ply", err="no depth")


def test_arena(room):
    base = ["build", room, "--context", "0,2", "--gaussians", 5000, "--working", "64x64"]
    plan = expect_json("plan", "--size", "64x64", "--views", 2, "--gaussians", 5000)
    least, full = plan["min_bytes"], plan["arena_bytes"]
    expect(3, *base, "--arena", least - 1, "-o", "s.ply", err="too small")
    expect(3, *base, "--arena", 0, "-o", "s.ply", err=str(least))
    hashes, files = set(), set()
    for i, more in enumerate((["--arena", "min"], ["--arena", least], ["--arena", "full"], ["--arena", full * 10],
                              ["--threads", 2], ["--threads", 7, "--arena", "min"], ["--cpu-mask", 0])):
        name = f"arena{i}.ply"
        hashes.add(expect_json(*base, *more, "-o", name).get("hash"))
        files.add(open(name, "rb").read())
    check(len(hashes) == 1 and len(files) == 1, "arena or threads change the scene")

    views = set()
    for more in (["--arena", "min"], ["--arena", "full"], ["--threads", 3]):
        views.add(expect_json("render", "scene.ply", room, "--view", 1, "-o", "v.png", *more).get("hash"))
    check(len(views) == 1, "arena or threads change the view")
    expect(3, "render", "scene.ply", room, "--view", 1, "--arena", 1000, "-o", "v.png", err="too small")


def test_render(room):
    write("pose.json", json.dumps(POSE))
    write("path.txt", "# stamp tx ty tz qx qy qz qw\n0 0 0 0 0 0 0 1\n1 0 0 0.1 0 0 0 1\n")
    expect(2, "render", err="SCENE")
    expect(2, "render", "scene.ply", room, "--view", 1, err="-o")
    expect(2, "render", "scene.ply", "-o", "v.png", err="viewpoint")
    expect(2, "render", "scene.ply", room, "-o", "v.png", err="--view")
    expect(2, "render", "scene.ply", "--view", 1, "-o", "v.png", err="REC.mcap")
    expect(2, "render", "scene.ply", room, "--view", 1, "--pose", "pose.json", "-o", "v.png", err="more than one")
    expect(2, "render", "scene.ply", "--fov", 60, "-o", "v.png", err="--fov")
    expect(2, "render", "scene.ply", room, "extra", "--view", 1, "-o", "v.png", err="too many")
    for option, values in {"--view": ["x", "-1"], "--size": ["9", "0x9", "5000x5"], "--fov": ["0", "180", "x"],
                           "--threads": ["0"], "--depth-unit": ["0", "x"], "--arena": ["big"]}.items():
        for value in values:
            expect(2, "render", "scene.ply", "-o", "v.png", f"{option}={value}", err=option)
    expect(1, "render", "scene.ply", room, "--view", 99, "-o", "v.png", err="no frame 99")
    expect(1, "render", "absent.ply", room, "--view", 1, "-o", "v.png", err="absent.ply")
    expect(1, "render", room, room, "--view", 1, "-o", "v.png", err="not a .ply")
    scene = open("scene.ply", "rb").read()
    write("cut.ply", scene[:-1])
    expect(1, "render", "cut.ply", room, "--view", 1, "-o", "v.png", err="cut off")
    expect(1, "render", "scene.ply", "--pose", "absent.json", "-o", "v.png", err="absent.json")
    expect(1, "render", "scene.ply", "--pose", "path.txt", "-o", "v.png", err="JSON")
    expect(1, "render", "scene.ply", "--pose", "pose.json", "--trajectory", "pose.json", "-o", "v.png", err="line 1")
    expect(2, "render", "scene.ply", "--fov", 179.9, "--size", "64x64", "--trajectory", "path.txt", "-o", "v.png",
           err="focal")
    expect(1, "render", "scene.ply", room, "--view", 1, "-o", "missing/v.png", err="missing/v.png")
    expect(1, "render", "scene.ply", room, "--view", 1, "-o", "flat", err="flat: not a regular file")
    expect_full("full.png", "render", "scene.ply", room, "--view", 1, "-o", "full.png")

    found = expect_json("render", "scene.ply", room, "--view", 1, "--depth", "d.png", "--alpha", "a.png",
                        "-o", "view.png")
    check(found["gaussians"] > 0 and found["width"] == 256, "render --json lacks its keys")
    for name in ("view.png", "d.png", "a.png"):
        check(open(name, "rb").read(8) == b"\x89PNG\r\n\x1a\n", f"{name} is no PNG")
    small = expect_json("render", "scene.ply", room, "--view", 1, "--size", "100x50", "-o", "small.png")
    check((small["width"], small["height"]) == (100, 50), "--size does not set the size")
    found = expect_json("render", "scene.ply", "--pose", "pose.json", "-o", "p.png")
    check(found["height"] == 48, "--pose sets no size")
    expect(0, "render", "scene.ply", "--trajectory", "path.txt", "--pose", "pose.json", "-o", "t.png", out="2 views")
    expect(0, "render", "scene.ply", "--trajectory", "path.txt", "--fov", 60, "--size", "32x32", "-o", "f.png")
    check(all(os.path.exists(n) for n in ("t_0000.png", "t_0001.png", "f_0001.png")), "numbered pictures are missing")


def test_replay(room):
    base = ["replay", room, "--working", "64x64"]
    found = expect_json(*base)
    check(len(found.get("stages", {})) == 9 and len(found["tiles"]) == 16, "replay --json lacks stages or tiles")
    write("golden.json", json.dumps(found))
    for more in ([], ["--threads", 2], ["--arena", "min"], ["--arena", 30000000], ["--cpu-mask", 0],
                 ["--cpu-mask", 255]):
        expect(0, *base, "--expect", "golden.json", *more, out="as expected")
        expect(0, *base, "--expect", found["hash"], *more, out="as expected")
    check(expect_json(*base, "--expect", "golden.json")["match"] is True, "match is not told")

    expect(1, *base, "--expect", "0" * 16, err=found["hash"])
    expect(1, *base, "--expect", "golden.json", "--seed", 9, err="stage superclusters")
    expect(1, *base, "--expect", "golden.json", "--redundancy", "off", err="stage pointmap")
    expect(1, *base, "--expect", "golden.json", "--wavelet", "haar", err="stage wavelet")
    expect(1, *base, "--expect", "golden.json", "--context", "0,2", err="stage image")
    expect(1, *base, "--expect", "golden.json", "--head", "moment", err="stage head")
    expect(1, *base, "--expect", "golden.json", "--head", "nano", err="stage head")
    check(found["head"] == "small" and len(found["head_crc"]) == 8, "replay --json does not name the head")
    broken = dict(found, hash="1" * 16, stages=dict(found["stages"], raster="2" * 16), tiles=list(found["tiles"]))
    broken["tiles"][6] = "3" * 16
    write("broken.json", json.dumps(broken))
    expect(1, *base, "--expect", "broken.json", err="tile 6 (pixels from 32, 16)")
    expect(1, *base, "--expect", "absent.json", err="absent.json")
    for content in ("{", "[]", '{"hash": 5}', '{"hash": "xyz"}', json.dumps(dict(found, stages={"image": 1})),
                    json.dumps(dict(found, tiles=["x"]))):
        expect(1, *base, "--expect", write("malformed.json", content), err="malformed.json")
    expect(2, "replay", err="REC.mcap")
    expect(2, "replay", room, room, err="too many")


def test_stream(room):
    base = ["replay", room, "--working", "64x64", "--stream", "--every", 2, "--at-hand", 2]
    found = expect_json(*base, "--gaussians", 500, "--images", "held")
    frames = expect_json("info", room)["frames"]
    keyframes, held = found["keyframes"], found["held_back"]
    check([k["frame"] for k in keyframes] == list(range(0, frames, 2)), "every second frame is to be a keyframe")
    check([h["frame"] for h in held] == list(range(1, frames, 2)), "the others are to be held back")
    check(all(k["gaussians"] == 500 for k in keyframes) and found["gaussians"] == found["cap"] == 500, "no 500 Gaussians")
    check(keyframes[0]["shown"] == 0 < keyframes[1]["shown"] <= keyframes[1]["points"], "what the map shows is not told")
    check(all(k["added"] == k["removed"] + k["crowded"] for k in keyframes[1:]), "a full map is to stay full")
    check(found["live_psnr"] > 18 and found["final_psnr"] > 18, f"held-back views are poor: {found['live_psnr']}")
    check(all(os.path.exists(f"held/{what}_00001.png") for what in ("frame", "mask", "live", "final")), "no pictures")
    write("stream.json", json.dumps(found))
    base += ["--gaussians", 500]
    for more in ([], ["--threads", 2], ["--arena", "min"]):
        expect(0, *base, "--expect", "stream.json", *more, out="as expected")
        expect(0, *base, "--expect", found["hash"], *more, out="as expected")
    expect(1, *base, "--expect", "stream.json", "--wavelet", "haar", err="keyframe 0")
    expect(1, *base, "--expect", "stream.json", "--half-life", 1, err="keyframe 2")
    expect(1, *base, "--expect", "0" * 16, err=found["hash"])
    expect(0, "replay", room, "--stream", "--keep", 2, "--working", "32x32", "--refine", 0, out="2 keyframes, one in 3")
    turned = expect_json("replay", room, "--working", "64x64", "--stream", "--every", 100, "--overlap", "90%",
                         "--gaussians", 500)
    check(0 == turned["keyframes"][0]["frame"] and 1 < len(turned["keyframes"]) < frames, "overlap chooses no keyframes")
    expect(2, "replay", room, "--overlap", "80%", err="belong to --stream")
    expect(2, "replay", room, "--every", 2, err="belong to --stream")
    expect(2, "replay", room, "--stream", "--context", "0,1", err="--context")
    expect(2, "replay", room, "--stream", "--auto", err="--auto")
    expect(2, *base, "--at-hand", 17, err="--at-hand")
    expect(1, *base, "--images", room + "/absent", err="absent")


def test_diff():
    expect(2, "diff", err="two files")
    expect(2, "diff", "scene.ply", err="two files")
    expect(2, "diff", "scene.ply", "exact.ply", "all.ply", err="too many")
    expect(2, "diff", "scene.ply", "view.png", err="cannot be compared")
    expect(1, "diff", "scene.ply", "absent.ply", err="absent.ply")
    expect(1, "diff", "view.png", "absent.png", err="absent.png")
    expect(1, "diff", "view.png", "small.png", err="256x256")
    expect(0, "diff", "scene.ply", "scene.ply", out="equal")
    expect(0, "diff", "view.png", "view.png", out="equal")
    check(expect_json("diff", "scene.ply", "scene.ply")["equal"] is True, "diff --json does not say equal")
    code, out, _ = run("diff", "scene.ply", "exact.ply", "--json")
    found = json.loads(out)
    check(code == 1 and found["gaussians"][1] == 777 and found["position"] > 0, "diff of scenes is wrong")
    # one opacity changed: one Gaussian differs, and it is named
    scene = bytearray(open("scene.ply", "rb").read())
    row = scene.index(b"end_header\n") + 11 + 5 * 17 * 4
    scene[row + 9 * 4:row + 10 * 4] = struct.pack("<f", -3.0)
    write("touched.ply", bytes(scene))
    code, out, _ = run("diff", "scene.ply", "touched.ply", "--json")
    found = json.loads(out)
    check(code == 1 and found["different"] == 1 and found["first"] == 5 and found["position"] == 0, f"diff names {out}")
    code, out, _ = run("diff", "t_0000.png", "t_0001.png", "--json")
    found = json.loads(out)
    check(code == 1 and found["psnr"] > 0 and found["first_tile"][0] % 16 == 0, "diff of views is wrong")


def test_plan():
    expect(2, "plan", err="--size")
    expect(2, "plan", "--size", "256x256", err="--gaussians")
    expect(2, "plan", "--size", "4x4", "--gaussians", 5, err="--size")
    expect(2, "plan", "--size", "256", "--gaussians", 5, err="--size")
    expect(2, "plan", "--size", "256x256", "--gaussians", 0, err="--gaussians")
    expect(2, "plan", "--size", "256x256", "--gaussians", 5, "--views", 17, err="--views")
    expect(2, "plan", "--size", "256x256", "--gaussians", 5, "--clusters", 513, err="--clusters")
    expect(2, "plan", "--size", "256x256", "--gaussians", 5, "--json", "--markdown", err="exclude")
    expect(2, "plan", "more", err="too many")
    expect(1, "plan", "--size", "256x256", "--gaussians", 5, "--svg", "missing/a.svg", err="missing/a.svg")
    expect_full("full.svg", "plan", "--size", "256x256", "--gaussians", 5, "--svg", "full.svg")
    expect(2, "plan", "--size", "256x256", "--gaussians", 5, "--render", "0x9", err="--render")
    base = ["plan", "--size", "256x256", "--views", 2, "--gaussians", 13107]
    found = expect_json(*base, "--svg", "arena.svg")
    check(found["min_bytes"] <= found["arena_bytes"], "plan --json lacks its keys")
    for buffer in found["buffers"]:
        check(buffer["offset"] + buffer["bytes"] <= found["arena_bytes"], f"{buffer['name']} leaves the arena")
    xml.dom.minidom.parse("arena.svg")
    table = expect(0, *base, "--markdown", out="|---|")
    check(all((f"| {b['name']} | {b['bytes']} |" in table) == (b['bytes'] > 0) for b in found["buffers"]),
          "the Markdown table is to have all buffers that have bytes")
    check(str(found["min_bytes"]) in expect(0, *base), "the table lacks the least bytes")
    # a head needs what plan says: one with wider activations more, and a closed form nothing
    small, wide, analytic = (expect_json(*base, "--head", head) for head in ("small", "wide.t3w", "analytic"))
    check(small["arena_bytes"] == analytic["arena_bytes"] == found["arena_bytes"], "the default arena holds small")
    check(wide["head_column_bytes"] > small["head_column_bytes"], "16-bit activations need no more")
    expect(2, *base, "--head", "big", err="--head")


def test_bench():
    for option, values in {"--runs": ["0", "102", "x"], "--threads": ["0", "x"]}.items():
        for value in values:
            expect(2, "bench", f"{option}={value}", err=option)
    expect(2, "bench", "more", err="too many")
    expect(2, "bench", "--stages", "kmeans_ms,kmeans", err="'kmeans'")
    expect(2, "bench", "--stages", "", err="--stages")
    expect(1, "bench", "--runs", 1, "--points", "absent.f32", err="absent.f32")
    expect(1, "bench", "--runs", 1, "--points", write("odd.f32", b"\0" * 25), err="25 bytes")
    expect(1, "bench", "--runs", 1, "--points", write("nan.f32", struct.pack("<6f", *[float("nan")] * 6)), err="byte 0")
    corners = [[1000.0 + 3 * (i & 1), 2.0 * (i >> 1 & 1), -4.0 * (i >> 2 & 1), 0, 0.5, 1] for i in range(8)] * 50
    clustering = ["bench", "--runs", 1, "--stages", "kmeans_ms,texture_ns_per_pixel", "--points"]
    found = expect_json(*clustering, write("corners.f32", b"".join(struct.pack("<6f", *row) for row in corners)))
    check("kmeans_ms" in found and "texture_ns_per_pixel" in found and "stereo_ms" not in found, "bench --stages")
    check(found["kmeans_points"] == 400 and found["kmeans_msd"] < 1e-4,
          f"eight places need eight clusters: {found['kmeans_msd']}")
    # any scale: a power of two less changes the distances by just that
    cloud = [[((i * (7919 + 2 * d)) % 4093) / 4093 for d in range(6)] for i in range(2000)]
    distance = {}
    for scale in (1.0, 2.0 ** -20, 2.0 ** 60):
        rows = b"".join(struct.pack("<6f", *[scale * v for v in row]) for row in cloud)
        found = expect_json(*clustering, write("cloud.f32", rows))
        distance[scale] = found["kmeans_msd"] / scale ** 2
    check(0 < distance[1.0] < 0.5 and max(distance.values()) <= 1.0001 * min(distance.values()), f"scales: {distance}")
    found = expect_json("bench", "--runs", 1)
    for key in ("raster_131k_ms", "raster_13k_ms", "refine_ms", "kmeans_ms", "texture_ns_per_pixel", "build_analytic_ms",
                "build_small_ms", "stereo_ms", "stereo_8_paths_ms", "head_gmac_per_s"):
        check(found[key] > 0 and found[key + "_min"] <= found[key] <= found[key + "_max"], f"bench lacks {key}")
    matched = expect_json("bench", "--runs", 1, "--depth", "stereo", "--stages", "stereo_ms,build_analytic_ms,refine_ms")
    check(found["depth"] == "sensor" and matched["depth"] == "stereo", "bench tells the depth")
    check("kmeans_msd" in found and "kmeans_msd" not in matched, "nothing is told of clusters that were not made")
    check(matched["build_analytic_ms"] > matched["stereo_ms"] > 0 and matched["refine_ms"] > 0, "builds by stereo")
    expect(2, "bench", "--depth", "laser", err="--depth")
    check(found["head"] == "small" and found["head_bits"] == "8", "bench does not name the head")
    expect(2, "bench", "--head", "moment", err="--head moment")
    expect(2, "bench", "--head", "large", err="--head")
    check(isinstance(found["cpu_flags"], str), "bench lacks cpu_flags")


def main():
    folder = tempfile.mkdtemp(prefix="trim3r-cli-")
    os.chdir(folder)
    try:
        expect(0, "room", "-o", "room.mcap")
        test_dispatch()
        test_build("room.mcap")
        test_heads("room.mcap")
        test_rivals("room.mcap")
        test_recordings("room.mcap")
        test_arena("room.mcap")
        test_render("room.mcap")
        test_replay("room.mcap")
        test_stream("room.mcap")
        test_diff()
        test_plan()
        test_bench()
    finally:
        os.chdir("/")
        shutil.rmtree(folder)
    print(f"{checks} checks, {len(failures)} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
