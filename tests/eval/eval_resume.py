#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_resume.py TRIM3R: `trim3r eval` on several processes gives the rows of one; --resume completes a table that
was cut off anywhere, without making its rows again; tables that are older or have other columns are refused."""
import csv
import os
import sys
import tempfile
import time

from checks import check, done, run

trim3r = sys.argv[1]
TIMES = ("build_ms", "render_ms")


def rows(path, times=False):
    with open(path, newline="") as file:
        return [{k: v for k, v in r.items() if times or k not in TIMES} for r in csv.DictReader(file)]


def key(row):
    return tuple(row[k] for k in ("scene", "context", "target", "method", "keep", "refine"))


def refuse(status, words, *command):
    result = run(*command, expect=status)
    check(words in result.stderr, f"'{words}' is not in: {result.stderr}")


with tempfile.TemporaryDirectory() as folder:
    room, again = f"{folder}/room.mcap", f"{folder}/again.csv"
    run(trim3r, "room", "--size", "32x32", "-o", room)
    call = (trim3r, "eval", room, "--keep", "40,10", "--methods", "trim3r,random,eagles", "--csv")
    whole = f"{folder}/whole.csv"
    text = run(*call, whole).stdout

    for jobs in ("2", "5", "all"):
        shown = run(*call, f"{folder}/jobs.csv", "--jobs", jobs).stdout
        check(rows(f"{folder}/jobs.csv") == rows(whole), f"--jobs {jobs}: the same rows in the same order")
        check(len(shown.splitlines()) == len(text.splitlines()), f"--jobs {jobs}: the same lines")
    one, two = f"{folder}/one", f"{folder}/two"
    run(*call, os.devnull, "--images", one, "--html", f"{folder}/one.html")
    run(*call, os.devnull, "--images", two, "--html", f"{folder}/two.html", "--jobs", "3")
    for place, _, names in os.walk(one):
        for name in names:
            path = os.path.join(place, name)
            with open(path, "rb") as a, open(path.replace(one, two), "rb") as b:
                check(a.read() == b.read(), f"{name} is the same from several processes")
    check(sum(len(n) for _, _, n in os.walk(one)) == sum(len(n) for _, _, n in os.walk(two)), "as many pictures")

    with open(whole, "rb") as file:
        data = file.read()
    lines = data.split(b"\n")
    heading, second = len(lines[0]) + 1, len(lines[0]) + len(lines[1]) + 2
    for cut in (0, heading, second, second + 7, len(data) * 2 // 3, len(data) - 1, len(data)):
        with open(again, "wb") as file:
            file.write(data[:cut])
        stood = {key(r): r for r in csv.DictReader(data[:data.rfind(b"\n", 0, cut) + 1].decode().splitlines())}
        run(*call, again, "--resume", "--jobs", "2" if cut % 2 else "1")
        check(sorted(map(key, rows(again))) == sorted(map(key, rows(whole))), f"cut at {cut}: every row once")
        check(sorted(map(str, rows(again))) == sorted(map(str, rows(whole))), f"cut at {cut}: the same figures")
        check(all(r == stood[key(r)] for r in rows(again, True) if key(r) in stood), f"cut at {cut}: rows are kept")

    run(*call, again, "--resume", "--refine", "0")
    check(len(rows(again)) == 2 * len(rows(whole)), "other settings are other rows")
    check(rows(again)[-1]["refine"] == "0", "which are told apart")
    run(*call, again, "--resume", "--exposure", "off")
    check(len(rows(again)) == 3 * len(rows(whole)) and rows(again)[-1]["settings"] == "exposure-off",
          "so are those without a column of their own")

    os.utime(room, (time.time() + 60,) * 2)
    refuse(1, "older than", *call, again, "--resume")
    os.utime(room, (1, 1))
    with open(again, "w") as file:
        file.write("scene,psnr\nroom,30\n")
    refuse(1, "not the columns", *call, again, "--resume")
    with open(again, "wb") as file:
        file.write(lines[0] + b"\n" + lines[1].replace(b"trim3r,", b"") + b"\n")
    refuse(1, "again.csv:2", *call, again, "--resume")
    epoch = lines[1].rsplit(b",", 1)[1]
    with open(again, "wb") as file:
        file.write(data.replace(b"," + epoch + b"\n", b",1\n"))
    refuse(1, f"bits epoch 1, not {epoch.decode()}", *call, again, "--resume")
    with open(again, "wb") as file:
        file.write(data)
    refuse(1, "no picture", *call, again, "--resume", "--images", one)
    with open(again, "rb") as file:
        check(file.read() == data, "a refused table is left as it is")
    refuse(2, "--resume needs --csv", trim3r, "eval", room, "--keep", "10", "--resume")
    refuse(2, "--jobs", *call, again, "--jobs", "0")

done()
