#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_fleet.py TRIM3R SNAKEFILE: the workflow over a folder of recordings: its tables equal those of the program
called by hand; failed jobs are tried again while the rest goes on, and a second call does the remaining work; a
changed bit is an error; jobs submitted by a command, as on a cluster, make the same tables; the program is found."""
import csv
import json
import os
import shutil
import stat
import subprocess
import sys
import tempfile

from checks import check, done, run, skip

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


# a stand-in for a cluster's command: notes the request, starts the job script and returns
SUBMIT = """#!/bin/sh
for script; do :; done
echo "$*" >>"{folder}/submitted"
sh "$script" >>"{folder}/jobs.log" 2>&1 </dev/null &
echo $!
"""


def write_program(path, text):
    with open(path, "w") as file:
        file.write(text)
    os.chmod(path, stat.S_IRWXU)


def rows(path):
    with open(path, newline="") as file:
        return [{k: v for k, v in r.items() if k not in ("build_ms", "render_ms")} for r in csv.DictReader(file)]


def snakemake(folder, fails, *arguments, **others):
    result = subprocess.run(["snakemake", *arguments], cwd=folder, capture_output=True, text=True, **others)
    check((result.returncode != 0) == fails, f"exit status {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout + result.stderr


def work(folder, fails, *settings, results="results", how=("-c", "2")):
    return snakemake(folder, fails, "-s", snakefile, "-d", results, *how, "--keep-going", "--config",
                     "recordings=../recordings", f"program={folder}/flaky", "eval=--keep 20,5", *settings)


def on_a_cluster(folder):
    """Makes the same tables through a submit command; jobs that die are tried again."""
    met = [f"{folder}/recordings/{name}.mcap.met" for name in ("a", "b", "late/b")]
    for path in met:
        os.remove(path)
    write_program(f"{folder}/submit", SUBMIT.format(folder=folder))
    submit = f"{folder}/submit -c {{threads}} --mem {{resources.mem_mb}}"
    major = int(subprocess.run(["snakemake", "--version"], capture_output=True, text=True).stdout.split(".")[0])
    how = ("--cluster", submit) if major < 8 else ("--executor", "cluster-generic", "--cluster-generic-submit-cmd", submit)
    work(folder, False, results="clustered", how=("--jobs", "2", *how))
    check(rows(f"{folder}/clustered/scores.csv") == rows(f"{folder}/results/scores.csv"), "a cluster's rows are the same")
    with open(f"{folder}/clustered/hashes.csv") as ours, open(f"{folder}/results/hashes.csv") as theirs:
        check(ours.read() == theirs.read(), "and its hashes")
    with open(f"{folder}/submitted") as file:
        submitted = file.read().splitlines()
    check(all(line.startswith("-c 1 --mem 1000 ") for line in submitted), f"what jobs ask for: {submitted}")
    count = {rule: sum(f".{rule}." in line for line in submitted) for rule in ("eval", "replay", "report", "scores")}
    # Snakemake's process within the job retries a dead job, or submits it again
    check(3 <= count.pop("eval") <= 6 and all(map(os.path.exists, met)), f"each eval dies once: {submitted}")
    check(count == {"replay": 3, "report": 1, "scores": 0}, f"tables are merged here: {submitted}")


def finds_its_program(folder):
    """Checks that the program is the checkout's, else the PATH's, else an error that says what to do."""
    os.makedirs(f"{folder}/checkout/tools/study/fleet")
    shutil.copy(snakefile, f"{folder}/checkout/tools/study/fleet")
    dry = ("-s", "checkout/tools/study/fleet/Snakefile", "-d", "fresh", "-c", "1", "-n", "-p", "--config",
           "recordings=../recordings")
    tools = os.path.dirname(shutil.which("snakemake"))
    path = ":".join(p for p in ("/usr/bin", "/bin", tools) if shutil.which("trim3r", path=p) is None)
    missing = snakemake(folder, True, *dry, env={**os.environ, "PATH": path})
    check("trim3r: no such program" in missing and "program=FILE" in missing, missing)
    check("nowhere/trim3r: no such" in snakemake(folder, True, *dry, "program=nowhere/trim3r"), "a program that is not")
    os.makedirs(f"{folder}/bin")
    os.symlink(trim3r, f"{folder}/bin/trim3r")
    on_path = {**os.environ, "PATH": f"{folder}/bin:{path}"}
    check("\n        trim3r eval" in snakemake(folder, False, *dry, env=on_path), "the PATH's")
    os.makedirs(f"{folder}/checkout/build/release")
    os.symlink(trim3r, f"{folder}/checkout/build/release/trim3r")
    check("/build/release/trim3r eval" in snakemake(folder, False, *dry, env=on_path), "the checkout's")


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
    write_program(f"{folder}/flaky", FLAKY.format(trim3r=trim3r, row="."))

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
    on_a_cluster(folder)
    finds_its_program(folder)
    check("no recordings" in work(folder, True, "recordings=../nowhere"), "an empty folder is told")

done()
