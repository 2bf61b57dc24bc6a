# SPDX-License-Identifier: Apache-2.0
"""Every command that reads, with hostile files: each is read or refused with one line that names it, in 3 seconds of
processor time and 512 MB, and none of its text reaches the terminal unescaped.

hostile.py TRIM3R [--table] [--write]

--table prints what each file took and how it was refused, --write puts the summary into docs/study/hostile.md.
"""
import collections
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

from cases import CASES
import formats

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "study", "scripts"))
from measured import table, write_block  # noqa: E402

SECONDS, MEGABYTES = 3.0, 512
TRIM3R = os.path.abspath(sys.argv[1])
TABLE, WRITE = ("--table" in sys.argv[2:]), ("--write" in sys.argv[2:])
RAW = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f]|[\u2028-\u202e\u2066-\u2069]")
PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "study" / "hostile.md"
failures = []


def commands(kind, path, out):
    """Returns the commands that read a file of that kind."""
    room, scene, pictures = "room.mcap", "room.ply", "pictures"
    context = ("--context", "0,1", "--gaussians", "20")
    return {
        "recording": [("info", path), ("info", "--json", path), ("build", path, *context, "-o", f"{out}.ply"),
                      ("replay", path, *context), ("eval", path, "--keep", "50"),
                      ("import", path, "--poses", "estimate", "-o", f"{out}.mcap"), ("import", path, "-o", f"{out}.mcap"),
                      ("render", scene, path, "--view", "0", "-o", f"{out}.png"),
                      ("capture", "--source", f"replay:{path}", "--quiet", "-o", f"{out}.mcap"),
                      ("capture", "--source", f"replay:{room}", "--poses", path, "--quiet", "-o", f"{out}.mcap")],
        "bag": [("import", path, "--strict", "-o", f"{out}.mcap"), ("import", path, "-o", f"{out}.mcap"), ("build", path, *context, "-o", f"{out}.ply"), ("info", path)],
        "path": [("info", path), ("build", path, *context, "-o", f"{out}.ply")],
        "scene": [("info", path), ("render", path, room, "--view", "1", "-o", f"{out}.png"), ("diff", path, scene),
                  ("convert", path, "-o", f"{out}.spz"),
                  ("eval", room, "--prune", path, "--context", "0,1", "--target", "2", "--keep", "50")],
        "large scene": [("info", path), ("render", path, room, "--view", "1", "-o", f"{out}.png"),
                        ("convert", path, "-o", f"{out}.spz")],
        "picture": [("import", pictures, "--intrinsics", "40,40,8,8", "--poses", "estimate", "-o", f"{out}.mcap"),
                    ("diff", path, "good.png")],
        "folder": [("import", path, "-o", f"{out}.mcap"),
                   ("import", path, "--poses", "estimate", "--intrinsics", "40,40,8,8", "-o", f"{out}.mcap")],
        "points": [("import", "maps", "--pointmaps", path, "-o", f"{out}.mcap")],
        "table": [("chart", path, "--svg", f"{out}.svg"),
                  ("eval", room, "--keep", "50", "--csv", path, "--resume")],
        "json": [("replay", room, *context, "--expect", path), ("render", scene, "--pose", path, "-o", f"{out}.png")],
        "trajectory": [("render", scene, "--trajectory", path, "--fov", "60", "--size", "64x64", "-o", f"{out}.png"),
                       ("capture", "--source", f"replay:{room}", "--poses", path, "--quiet", "-o", f"{out}.mcap")],
        "head": [("quantize", path, "-o", f"{out}.t3w"), ("head-info", path)],
        "weights": [("head-info", path), ("build", room, *context, "--head", path, "-o", f"{out}.ply")],
    }[kind]


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))  # protects the machine that runs this test
    resource.setrlimit(resource.RLIMIT_CPU, (20, 20))


def run(command):
    """Returns status, output, errors, seconds of processor time, megabytes."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        # pylint: disable=subprocess-popen-preexec-fn
        process = subprocess.Popen([TRIM3R, *command], stdin=subprocess.DEVNULL, stdout=out, stderr=err, preexec_fn=limit)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        return process.returncode, out.read(), err.read(), used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def check(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def check_run(name, command, why, ended):
    status, out, err, seconds, megabytes = ended
    what = f"{name}, {command[0]}"
    message = err.decode("utf-8", "replace")
    check(status in (0, 1, 2), f"{what}: exit status {status}")
    check(seconds <= SECONDS, f"{what}: {seconds:.1f} s")
    check(megabytes <= MEGABYTES, f"{what}: {megabytes:.0f} MB")
    for stream, data in (("output", out), ("errors", err)):
        text = data.decode("utf-8", "replace")
        check(RAW.search(text) is None, f"{what}: raw {RAW.search(text)} in its {stream}: {text[:200]!r}")
    if status != 0:
        lines = message.strip().split("\n")
        most = 2 if command[0] == "capture" else 1  # what a frame lacks, then the consequence
        check(len(lines) <= most and all(line.startswith(f"trim3r {command[0]}: ") for line in lines),
              f"{what}: not one line: {message[:300]!r}")
        check(out == b"", f"{what}: output beside an error: {out[:100]!r}")
        # what is written, or one of several
        named = any(part in message for part in (os.path.basename(name), "out/it.", "the tables"))
        check(named, f"{what}: no name in {message!r}")
        reason = message.strip().rsplit(": ", 1)[-1]
        check(len(reason) >= 6, f"{what}: no cause in {message!r}")


def check_case(kind, name, why, path):
    """Runs all commands; returns the maxima, and the first refusal."""
    worst, ended = [0.0, 0.0], []
    refusal = ""
    for command in commands(kind, path, "out/it"):
        result = run(command)
        check_run(name, command, why, result)
        worst = [max(worst[0], result[3]), max(worst[1], result[4])]
        ended.append(result[0])
        message = result[2].decode("utf-8", "replace").strip()
        refusal = refusal or (message if result[0] != 0 else "")
    if why is not None:
        check(0 not in ended[:1], f"{name}: read, but should be refused")
        check(why in refusal, f"{name}: {refusal!r} does not say {why!r}")
    return worst, ended, refusal


def size_text(path):
    if not os.path.isdir(path):
        total = os.lstat(path).st_size
    else:
        total = sum(os.lstat(os.path.join(folder, name)).st_size for folder, _, names in os.walk(path) for name in names)
    return f"{total} B" if total < 4096 else f"{total / 1024:.0f} KB" if total < 4 << 20 else f"{total / (1 << 20):.0f} MB"


def make_good():
    """Makes the valid files that are read together with hostile ones."""
    for command in (("room", "-o", "room.mcap", "--frames", "3", "--size", "64x64"),
                    ("build", "room.mcap", "--context", "0,2", "--gaussians", "40", "-o", "room.ply")):
        subprocess.run([TRIM3R, *command], check=True, capture_output=True)
    with open("good.png", "wb") as file:
        file.write(formats.png(16, 16))
    os.makedirs("out")
    os.makedirs("maps")
    for i in range(2):
        with open(f"maps/{i}.png", "wb") as file:
            file.write(formats.png(64, 64))
    with open("maps/transforms.json", "w", encoding="utf-8") as file:
        unit = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"
        frames = ",".join(f'{{"file_path":"{i}.png","transform_matrix":{unit}}}' for i in range(2))
        file.write(f'{{"fl_x":64,"frames":[{frames}]}}')


def place(kind, name, make):
    """Makes the file or folder in a separate process, because its memory would count for processes started later."""
    path = f"pictures/{name}" if kind == "picture" else name
    child = os.fork()
    if child == 0:
        os.makedirs("pictures", exist_ok=True)
        if make.__code__.co_argcount:
            make(path)
        else:
            with open(path, "wb") as file:
                file.write(make())
        os._exit(0)  # pylint: disable=protected-access
    os.waitpid(child, 0)
    return path


def check_arguments():
    """Checks names on the command line, which a shell takes from other people's folders."""
    for name in (f"{formats.ESCAPE}.mcap", "line\nbreak.ply", b"\xff.mcap"):
        ended = run(("info", name))
        check(ended[0] == 2 and ended[1] == b"", f"{name!r}: status {ended[0]}")
        check(RAW.search(ended[2].decode("utf-8", "replace")) is None, f"{name!r}: raw in {ended[2]!r}")


def report(rows):
    if TABLE:
        print("| input | size | s | MB | exit status | message |\n|---|---:|---:|---:|---|---|")
        for _, name, size, worst, ended, refusal in rows:
            refusal = refusal.split(": ", 1)[-1].replace("|", "\\|")
            statuses = " ".join(str(status) for status in ended)
            print(f"| `{name}` | {size} | {worst[0]:.2f} | {worst[1]:.0f} | {statuses} | {refusal[:200] or 'read'} |")
    if WRITE:
        write_block(PAGE, "hostile", summary(rows))
    print(f"{len(rows)} files")


def summary(rows):
    """Yields a row a kind of file: how many there are, how many every command refused, and the worst of them."""
    kinds = collections.defaultdict(list)
    for kind, name, _, worst, ended, _ in rows:
        kinds[kind].append((name, worst, 0 not in ended))
    lines = []
    for kind, found in kinds.items():
        slowest, largest = (max(found, key=lambda row, i=i: row[1][i]) for i in (0, 1))
        lines.append([kind, str(len(found)), str(sum(refused for *_, refused in found)), f"{slowest[1][0]:.2f}", f"`{slowest[0]}`",
                      f"{largest[1][1]:.0f}", f"`{largest[0]}`"])
    return table(("read as", "files", "refused by all", "most s", "by", "most MB", "by"), lines)


def main():
    rows = []
    make_good()
    check_arguments()
    for kind, name, why, make in CASES:
        path = place(kind, name, make)
        size = size_text(path)
        worst, ended, refusal = check_case(kind, name, why, path)
        rows.append((kind, name, size, worst, ended, refusal))
        subprocess.run(["rm", "-rf", path], check=True)
    report(rows)


with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    main()
sys.exit(1 if failures else 0)
