#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""outputs.py TRIM3R: no command overwrites its inputs, writes twice to one file, or overwrites a file of another kind.

Every output option of every command against every input and every other output, from the commands' own tables
(--file-options): refused before the rest of the line is checked, so no command needs a valid one.
"""
import json
import os
import re
import subprocess

from program import TRIM3R, check, expect, in_scratch, room, run, write

# The first bytes of each kind of file.
CONTENT = {
    "a recording": b"\x89MCAP0\r\n" + bytes(99), "a scene": b"ply\nformat ascii 1.0\n",
    "a PNG picture": b"\x89PNG\r\n\x1a\n" + bytes(99), "an SVG picture": b"<svg xmlns='http://www.w3.org/2000/svg'/>",
    "a page": b"<!DOCTYPE html>\n<html></html>", "a table": b"scene,context,psnr\nroom,0,1\n",
    "a weight file": b"T3RW" + bytes(99), "the C source of a head": b"/* The head `x` as a weight file */\n",
    "a video": b"\0\0\0\x20ftypisom",
    "lines of a stream": b'{"frame":0}\n', "the state of a stream": b"T3RSTATE" + bytes(99),
    "the C header of a plan": b"/* The settings and the static memory of one runtime */\n",
    "a file of another kind": b'{"a": 1, "b": 2}\n'}


# The suffixes of each kind.
SUFFIXES = {
    "a recording": (".mcap",), "a scene": (".ply", ".splat", ".spz", ".glb", ".sog"), "a PNG picture": (".png",),
    "an SVG picture": (".svg",), "a video": (".mp4", ".mov", ".mkv", ".webm"), "a page": (".html",), "a table": (".csv",),
    "a weight file": (".t3w",), "the C source of a head": (".c",), "the C header of a plan": (".h",),
    "a file of another kind": (".jpg", ".pdf", ".json")}


def commands():
    return [line.split("\t")[0] for line in expect(0, "--commands").splitlines()]


def table(command):
    return json.loads(expect(0, command, "--file-options"))


def given(row, path):
    return [path] if row["option"] == "" else [row["option"], path]


def named(row):
    return row["option"] or "the argument"


def content_of(row):
    return CONTENT[row["kinds"][0]] if row["kinds"] else CONTENT["a file of another kind"]


def make(row, path):
    os.mkdir(path) if row["writes"] and row["folder"] else write(path, content_of(row))


def remove(*paths):
    for path in paths:
        os.rmdir(path) if os.path.isdir(path) and not os.path.islink(path) else os.unlink(path)


def other_names(path):
    """Yields other names of the same file, what has to be removed afterwards, and whether the name exists."""
    folder = os.path.basename(os.getcwd())
    yield path, (), True
    yield f"../{folder}/{path}", (), True
    if not os.path.isdir(path):
        os.link(path, "hard.t3w")
        yield "hard.t3w", ("hard.t3w",), True
    os.symlink(path, "soft.t3w")
    yield "soft.t3w", ("soft.t3w",), True
    yield f"./{path}", (), False


def refused(command, output, other):
    """Both options given one file, by any name."""
    for path, made, there in other_names("one.t3w"):
        if not there:
            remove("one.t3w")
        elif not os.path.lexists("one.t3w"):
            make(output, "one.t3w")
        before = open("one.t3w", "rb").read() if os.path.isfile("one.t3w") else None
        line = [command, *given(output, "one.t3w"), *given(other, path)]
        code, printed, message = run(*line)
        check(code == 2 and named(output) in message and named(other) in message and "one file" in message,
              f"{line}: {code} {message}")
        check(printed == "", f"{line} prints {printed}")
        check(before == (open("one.t3w", "rb").read() if os.path.isfile("one.t3w") else None), f"{line} wrote")
        remove(*made)


def all_are_named():
    """Checks that the tables' listing has every option that takes a file."""
    seen = 0
    for command in commands():
        listed = {row["option"] for row in table(command)}
        for short, name, value in re.findall(r"^ +(?:(-\w), )?(?:    )?(--[\w-]+)=(\S+)", expect(0, command, "--help"), flags=re.M):
            if re.search(r"FILE|DIR|HEAD|PNG|DEVICE|OUT|\.[a-z]{3}", value):
                seen += 1
                check({short, name} & listed, f"{command} {name}={value} is in no table of files")
    check(seen > 30, f"only {seen} options take files")


def every_pair():
    pairs = 0
    for command in commands():
        rows = table(command)
        outputs = [row for row in rows if row["writes"]]
        for output in outputs:
            for other in rows:
                if other is output or (other["writes"] and other["folder"] != output["folder"]):
                    continue # files and folders are distinguished by what exists
                make(output, "one.t3w")
                refused(command, output, other)
                pairs += 1
            listed = [other for other in rows if other["list"] and not output["folder"]]
            for other in listed: # the last of several
                write("one.t3w", content_of(output))
                code, _, message = run(command, *given(output, "one.t3w"), *given(other, "a.t3w,one.t3w"))
                check(code == 2 and "one file" in message, f"{command} {other}: {code} {message}")
                remove("one.t3w")
    check(pairs > 40, f"only {pairs} pairs of options were tried")


def to_standard_output():
    for command in commands():
        for row in table(command):
            if row["writes"] and not row["folder"]:
                with open("printed", "w") as out:
                    done = subprocess.run([TRIM3R, command, *given(row, "printed")], stdout=out, text=True,
                                          stderr=subprocess.PIPE)
                check(done.returncode == 2 and "standard output are one file" in done.stderr, f"{command}: {done.stderr}")
    remove("printed")


# A line of each command with an output that may be standard output, and the name of the file in its place.
PIPES = {
    ("build", "-o"): (["room.mcap", "--keep", "10"], "x.ply"), ("convert", "-o"): (["scene.ply"], "x.ply"),
    ("render", "-o"): (["scene.ply", "room.mcap", "--view", "1"], "x.png"), ("info", "--svg"): (["scene.ply"], "x.svg"),
    ("plan", "--svg"): (["--size", "64x64", "--gaussians", "9"], "x.svg"), ("completion", "-o"): (["bash"], "x.bash"),
    ("eval", "--csv"): (["room.mcap", "--keep", "10"], "x.csv")}


def without_times(content, name):
    return re.sub(rb"[0-9.]+(?=,)", b"", content) if name.endswith(".csv") else content


def to_a_pipe():
    """The output - is standard output, with the bytes of a file; what is printed goes to stderr."""
    room()
    expect(0, "build", "room.mcap", "--keep", 10, "-o", "scene.ply")
    seen = set()
    for command in commands():
        for row in (row for row in table(command) if row["writes"]):
            if not row["pipe"]:
                if not row["word"]:
                    code, printed, message = run(command, *given(row, "-"))
                    check((code, printed) == (2, "") and f"{row['option']} -: this output needs a file" in message,
                          f"{command} {row['option']}: {code} {message}")
                continue
            seen.add((command, row["option"]))
            line, name = PIPES[command, row["option"]]
            expect(0, command, *line, row["option"], name)
            content = open(name, "rb").read()
            done = subprocess.run([TRIM3R, command, *line, row["option"], "-"], capture_output=True)
            check(done.returncode == 0 and without_times(done.stdout, name) == without_times(content, name) and
                  b"Gaussians" in (done.stderr if command in ("build", "convert", "render") else b"Gaussians"),
                  f"{command} {row['option']} -: {done.returncode} {done.stderr[-300:]}")
            with open("/dev/full", "w") as full:
                done = subprocess.run([TRIM3R, command, *line, row["option"], "-"], stdout=full, stderr=subprocess.PIPE, text=True)
            check(done.returncode == 1 and "standard output" in done.stderr, f"{command} to a full disk: {done.stderr}")
            remove(name)
            check(not os.path.exists("-"), f"{command}: a file of that name")
    check(seen == set(PIPES), f"{seen}")
    write("path.txt", "0 0 0 0 0 0 0 1\n1 0 0 0.1 0 0 0 1\n")
    expect(2, "render", "scene.ply", "--trajectory", "path.txt", "--fov", 60, "--size", "32x32", "-o", "-", err="-o -")
    expect(2, "render", "scene.ply", "room.mcap", "--view", 1, "--depth", "-", "-o", "-", err="--depth -: this output")
    remove("scene.ply", "room.mcap", "path.txt")


def other_kinds():
    """Checks existing outputs of another kind: a pipe, a link to nothing."""
    write("shut.bin", CONTENT["a file of another kind"])
    for command in commands():
        for row in (row for row in table(command) if row["writes"]):
            line = [command, *given(row, "there"), "absent"] # no command continues with that
            for kind, content in CONTENT.items():
                write("there", content)
                code, _, message = run(*line)
                if row["folder"]:
                    check(code == 1 and "not a folder" in message, f"{line} over {kind}: {code} {message}")
                    continue
                allowed = kind in row["kinds"]
                check(("--force" in message) != allowed and (allowed or code == 2), f"{line} over {kind}: {message}")
                message = run(*line, "--force")[2]
                check("--force" not in message, f"{line} --force over {kind}: {message}")
                check(open("there", "rb").read() == content, f"{line} over {kind} wrote")
            write("there", "")
            message = run(*line)[2]
            check("--force" not in message, f"{line} over an empty file: {message}")
            os.unlink("there")
            os.mkfifo("there")
            code, _, message = run(*line)
            check(code == 1 and "there: not a" in message, f"{line} to a pipe: {code} {message}")
            os.unlink("there")
            os.symlink("nothing", "there")
            code, _, message = run(*line)
            check(code == 1 and "link to nothing" in message, f"{line} to a dangling link: {code} {message}")
            os.unlink("there")


def wrong_names():
    """No output has the suffix of another kind of file, in either case of letters, unless --force."""
    rows = 0
    for command in commands():
        for row in (row for row in table(command) if row["writes"] and not row["folder"] and row["kinds"]):
            for kind, suffixes in SUFFIXES.items():
                for suffix in (*suffixes, suffixes[0].upper()):
                    line = [command, *given(row, f"made{suffix}"), "absent"] # no command continues with that
                    code, printed, message = run(*line)
                    allowed = kind in row["kinds"]
                    check(("the name is that of" in message) != allowed and (allowed or (code, printed) == (2, "")),
                          f"{line}: {code} {message}")
                    check("the name is that of" not in run(*line, "--force")[2], f"{line} --force: refused")
                    check(not os.path.exists(f"made{suffix}"), f"{line}: a file")
            code, _, message = run(command, *given(row, "made.any"), "absent")
            check("the name is that of" not in message, f"{command}: a suffix of no kind: {message}")
            rows += 1
    check(rows > 20, f"only {rows} outputs were tried")


def strange_inputs():
    os.mkfifo("pipe.t3w")
    os.mkdir("folder.t3w")
    for command in commands():
        for row in (row for row in table(command) if row["reads"] and not row["device"]):
            for path in ("pipe.t3w", "/dev/zero") if row["word"] else ("pipe.t3w", "/dev/zero", "folder.t3w"):
                line = [command, *given(row, path)]
                if (row["folder"] and path == "folder.t3w") or (row["word"] and path == "/dev/zero"):
                    continue
                code, _, message = run(*line)
                check(code == 1 and ("not a regular file" in message or "Is a directory" in message),
                      f"{line}: {code} {message}")
    os.unlink("pipe.t3w")
    os.rmdir("folder.t3w")


def missing_folders():
    """Checks that a missing folder in a path is named, and missing inputs, too."""
    os.makedirs("is/here")
    write("is/file", "")
    rows = 0
    ways = {"is/here/not//such/x.t3w": "there is no folder 'is/here/not'", "none/x.t3w": "folder 'none'",
            "/none/x.t3w": "folder '/none'", "is/file/x.t3w": "is/file: Not a directory"}
    for command in commands():
        for row in (row for row in table(command) if not row["device"]):
            for path, words in list(ways.items())[:len(ways) if command == "build" else 1]:
                code, printed, message = run(command, *given(row, path))
                check((code, printed) == (1, "") and f"{named(row)} {path}: " in message and words in message,
                      f"{command} {path}: {code} {message}")
            rows += 1
    check(rows > 40, f"only {rows} options were tried")
    os.symlink("is/here", "way")
    check("no folder" not in run("build", "way/../x.mcap", "--keep", 10, "-o", "way/x.ply/")[2], "a link is a way")
    for line in (["build", "absent.mcap", "--keep", 10, "-o", "x.ply"], ["render", "absent.ply", "x.mcap", "--view", 1, "-o", "x.png"],
                 ["plan", "--size", "64x64", "--views", 2, "--gaussians", 9, "--machine", "absent.json"],
                 ["build", "x.mcap", "--keep", 10, "--allocate", "given", "--importance", "absent.png", "-o", "x.ply"]):
        write("x.mcap", "")
        expect(1, *line, err=": No such file or directory")
    for path in ("way", "x.mcap", "is/file"):
        os.unlink(path)
    os.removedirs("is/here")


def in_folders():
    """Checks names made from an option's value, and files in an input folder."""
    recording = room()
    expect(0, "build", recording, "--keep", 10, "-o", "scene.ply")
    write("path.txt", "0 0 0 0 0 0 0 1\n1 0 0 0.1 0 0 0 1\n")
    write("v_0001.png", "notes\n")
    line = ["render", "scene.ply", "--trajectory", "path.txt", "--fov", 60, "--size", "32x32", "-o", "v.png"]
    expect(1, *line, err="v_0001.png: what is there is a file of another kind")
    check(open("v_0001.png").read() == "notes\n", "render wrote over notes")
    expect(0, *line, "--force")
    # an image of --planar within --images
    os.makedirs("images/photo")
    os.rename("v_0001.png", "images/photo/target.png")
    os.symlink("images/photo/target.png", "photo.png")
    before = open("images/photo/target.png", "rb").read()
    expect(1, "eval", "--planar", "photo.png", "--keep", 50, "--size", "32x32", "--images", "images",
           err="the argument photo.png, too")
    check(open("images/photo/target.png", "rb").read() == before, "eval wrote over its image")
    # the contents of a folder of pictures, but not the report next to them
    expect(0, "eval", recording, "--keep", 10, "--images", "pictures", "--csv", "scores.csv")
    picture = os.path.join("pictures", "1", "target.png")
    before = open(picture, "rb").read()
    line = ["chart", "scores.csv", "--pictures", "pictures"]
    for force in ([], ["--force"]):
        expect(2, *line, "--png", picture, "-o", "r.html", *force, err="lies in --pictures pictures")
    check(open(picture, "rb").read() == before, "chart wrote over a picture that it reads")
    for _ in range(2):
        expect(0, *line, "-o", "pictures/report.html")
        expect(0, "eval", recording, "--keep", 10, "--images", "pictures", "--csv", "pictures/scores.csv")


def names_of_others():
    """Checks that a command reads the tables that another writes: a name that is too long is cut between two
    characters."""
    for spare in range(2):
        name = "x" * spare + "\u00e9" * 110 + ".mcap"
        os.makedirs("one", exist_ok=True)
        room(name=f"one/{name}")
        more = "long" * 20
        os.makedirs(more, exist_ok=True)
        room(name=f"{more}/{name}")
        small = ["--working", "16x16", "--keep", 10]
        for command in (["eval", *small], ["stress", *small, "--rows", "noise", "--strengths", 1, "--captures", 0]):
            inputs = [f"{more}/{name}", f"one/{name}"] if command[0] == "eval" else [f"one/{name}"]
            expect(0, *command, *inputs, "--csv", "names.csv")
            with open("names.csv", encoding="utf-8") as table:
                check(name[:90] in table.read(), f"{command}: no name")
        expect(0, "eval", *small, f"{more}/{name}", f"one/{name}", "--csv", "scores.csv")
        expect(0, "chart", "scores.csv", "-o", "names.html")


if __name__ == "__main__":
    in_scratch(all_are_named, every_pair, to_standard_output, to_a_pipe, other_kinds, wrong_names, strange_inputs, missing_folders, in_folders, names_of_others)
