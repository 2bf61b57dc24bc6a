#!/usr/bin/env python3
"""eval_fleet.py TRIM3R SNAKEFILE: the workflow over a folder of recordings: its tables are those of the program called
by hand; what fails is tried again, the rest goes on, and a second call does what is left; a changed bit is an error."""
import csv
import json
import os
import shutil
import stat
import subprocess
import sys
import tempfile

from common import check, done, run, skip

trim3r, snakefile = map(os.path.abspath, sys.argv[1:3])
if shutil.which("snakemake") is None:
    skip("there is no snakemake")

# dies at its first eval of every recording, after the first row
FLAKY = """#!/bin/sh
if [ "$1" = eval ] && [ ! -e "$2.met" ]; then
    touch "$2.met"
    "{trim3r}" "$@" | grep -q '^{row}' && kill -9 $$
fi
exec "{trim3r}" "$@"
"""


def rows(path):
    with open(path, newline="") as file:
        return [{k: v for k, v in r.items() if k not in ("build_ms", "render_ms")} for r in csv.DictReader(file)]


def work(folder, status, *settings):
    result = subprocess.run(["snakemake", "-s", snakefile, "-d", "results", "-c", "2", "--keep-going", "--config",
                             "recordings=../recordings", f"program={folder}/flaky", "eval=--keep 20,5", *settings],
                            cwd=folder, capture_output=True, text=True)
    check((result.returncode != 0) == status, f"exit status {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout + result.stderr


with tempfile.TemporaryDirectory() as folder:
    recordings, results = f"{folder}/recordings", f"{folder}/results"
    os.makedirs(f"{recordings}/late")
    rooms = [f"{recordings}/a.mcap", f"{recordings}/b.mcap", f"{recordings}/late/b.mcap"]
    for seed, room in enumerate(rooms, 1):
        run(trim3r, "room", "--size", "64x64", "--seed", seed, "-o", room)
    with open(rooms[1], "rb") as file:
        whole = file.read()
    with open(rooms[1], "wb") as file:
        file.write(whole[:100])
    with open(f"{folder}/flaky", "w") as file:
        file.write(FLAKY.format(trim3r=trim3r, row="."))
    os.chmod(f"{folder}/flaky", stat.S_IRWXU)

    told = work(folder, True)
    check("eval/b.csv" in told, "the recording that failed is named")
    check(os.path.exists(f"{results}/eval/a.csv") and os.path.exists(f"{results}/eval/late/b.csv"), "others went on")
    with open(f"{results}/log/eval/b.txt") as file:
        check("b.mcap" in file.read(), "the log says why")

    with open(rooms[1], "wb") as file:
        file.write(whole)
    before = os.stat(f"{results}/eval/a.csv").st_mtime_ns
    work(folder, False)
    check(os.stat(f"{results}/eval/a.csv").st_mtime_ns == before, "what was done is not done again")
    run(trim3r, "eval", *rooms, "--keep", "20,5", "--csv", f"{folder}/all.csv")
    ours, by_hand = rows(f"{results}/scores.csv"), rows(f"{folder}/all.csv")
    check({r["scene"] for r in ours} == {"a", "b", "late-b"}, "scenes are named by their folders too")
    names = {"recordings-a": "a", "recordings-b": "b", "late-b": "late-b"}
    check(sorted(map(str, ours)) == sorted(str({**r, "scene": names[r["scene"]]}) for r in by_hand), "the rows of eval")
    with open(f"{results}/hashes.csv", newline="") as file:
        hashes = {r["recording"]: r["hash"] for r in csv.DictReader(file)}
    for name, room in zip(("a", "b", "late/b"), rooms):
        check(hashes[name] == json.loads(run(trim3r, "replay", room, "--json").stdout)["hash"], f"{name}'s hash")
    check(os.path.getsize(f"{results}/report.html") > 10000, "there is a report")

    shutil.copytree(f"{results}/replay", f"{folder}/expected")
    shutil.rmtree(f"{results}/replay")
    work(folder, False, "expected=../expected")
    with open(f"{folder}/expected/a.json") as file:
        changed = json.load(file)
    changed["hash"] = "0" * 16
    with open(f"{folder}/expected/a.json", "w") as file:
        json.dump(changed, file)
    check("replay/a.json" in work(folder, True, "expected=../expected"), "a changed hash is an error")
    check("no recordings" in work(folder, True, "recordings=../nowhere"), "an empty folder is told")

done()
