# SPDX-License-Identifier: Apache-2.0
"""Measurements on recorded scenes, made when first asked for and kept in build/results until the program changes: what the
measuring tools share."""
import csv
import glob
import hashlib
import json
import os
import statistics
import subprocess
import sys

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
PAGES = os.path.join(ROOT, "docs", "study")  # the measured tables and their pictures
DATA = os.path.join(ROOT, "..", "shared", "data")
PROGRAM = os.path.join(ROOT, "build", "release", "trim3r")
SCENES = ("hololens_b", "icl_livingroom_synth", "icl_livingroom_noisy_synth", "apc_shelf")  # test scenes with depth
# The scenes for measurements of colour alone; the last two are training scenes.
COLOUR_SCENES = ("clip_nyu_2", "clip_scannet_0", "clip_kitti_0", "strecha_fountain", "hololens_b", "icl_livingroom_synth",
                 "icl_livingroom_noisy_synth", "ngp_fox", "tum_fr3_office")
COLOUR_CASES = 4  # triplets of a scene


def processor():
    """Returns the processor's name, as the system reports it."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return names[0] if names else "an unnamed processor"


def compiler():
    """Returns the compiler that built PROGRAM."""
    with open(os.path.join(os.path.dirname(PROGRAM), "CMakeCache.txt"), encoding="utf-8") as file:
        path = next(line.split("=", 1)[1].strip() for line in file if line.startswith("CMAKE_C_COMPILER:"))
    return subprocess.run([path, "--version"], check=True, capture_output=True, text=True).stdout.splitlines()[0]


class Measurements:
    """Keeps files that commands make. A `trim3r eval` that was interrupted resumes where it stopped."""

    def __init__(self, script, program=PROGRAM, cache=os.path.join(ROOT, "build", "results")):
        self.script, self.program = script, program
        for need in (program, DATA):
            if not os.path.exists(need):
                sys.exit(f"{script}: {os.path.relpath(need)} is not there")
        stamp = hashlib.sha256()
        for path in (program, *sorted(glob.glob(os.path.join(os.path.dirname(program), "libtrim3r_*.so")))):  # its modules
            with open(path, "rb") as file:
                stamp.update(file.read())
        self.folder = os.path.join(cache, stamp.hexdigest()[:12])
        os.makedirs(self.folder, exist_ok=True)
        with open(os.path.join(DATA, "splits.json"), encoding="utf-8") as file:
            self.test_scenes = json.load(file)["test"]

    def path(self, name, command):
        """Returns where the file `name` made by `command` is kept."""
        stem, ending = os.path.splitext(name)
        digest = hashlib.sha256(repr(command).encode()).hexdigest()[:8]
        return os.path.join(self.folder, f"{stem}.{digest}{ending}")

    def made(self, name, command, resumed=()):
        """Returns the file `name`, made by `command` with OUT in it, and what the command printed. resumed: options
        with which the command resumes an unfinished OUT."""
        path = self.path(name, command)
        log = path + ".log"
        if not os.path.exists(path):
            print(f"{self.script}: {name}", file=sys.stderr, flush=True)
            fresh = os.path.join(self.folder, "new." + os.path.basename(path))
            if resumed and os.path.exists(fresh):
                os.utime(fresh)  # made by this program and command, whatever the file's date
            with open(log, "w", encoding="utf-8") as file:
                subprocess.run([*(fresh if c == "OUT" else c for c in command), *resumed], stdout=file, check=True)
            os.replace(fresh, path)
        return path, log

    def recording(self, scene):
        source = os.path.join(DATA, scene)
        command = [self.program, "import", source, "--size", "256x256", "-o", "OUT"]
        return self.made(f"{scene}.mcap", command)[0]

    def told(self, recording):
        """Returns what `trim3r info` reports for the recording."""
        command = [self.program, "info", recording, "--json"]
        return json.loads(subprocess.run(command, capture_output=True, check=True).stdout)

    def bits_epoch(self):
        """Returns the bits epoch at the end of `trim3r --version`."""
        told = subprocess.run([self.program, "--version"], capture_output=True, check=True, text=True).stdout
        return told.split()[-1]

    def evaluation(self, options, jobs):
        return [self.program, "eval", *options, "--jobs", jobs, "--csv", "OUT"]

    def evaluated(self, name, *options, jobs="all"):
        path, _ = self.made(f"{name}.csv", self.evaluation(options, jobs), ["--resume"])
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))


def even_triplets(root):
    """Returns [(context, target)] of a scene's transforms.json, evenly spaced: COLOUR_CASES, or fewer if there are
    fewer."""
    every = [t for t in root["trim3r_triplets"] if t["context"][0] != t["context"][1]]
    count = min(COLOUR_CASES, len(every))
    return [(every[i * len(every) // count]["context"], every[i * len(every) // count]["target"]) for i in range(count)]


def triplets(info):
    """Returns [(context, target)] from the result of told(), as eval's options take them."""
    return [(listed(t["context"]), str(t["target"])) for t in info["triplets"]]


def listed(values):
    return ",".join(str(v) for v in values)


def means(rows, column, key):
    """Mean of a column over the rows of each value of `key`."""
    groups = {}
    for row in rows:
        groups.setdefault(row[key], []).append(float(row[column]))
    return {k: statistics.fmean(v) for k, v in groups.items()}


def table(titles, rows):
    yield "| " + " | ".join(titles) + " |"
    yield "|" + "---|" * len(titles)
    for row in rows:
        yield "| " + " | ".join(row) + " |"


def write_block(path, name, lines):
    """Replaces what stands between the file's marks of that name."""
    with open(path, encoding="utf-8") as file:
        head, rest = file.read().split(f"<!-- {name}:begin -->\n")
    tail = rest.split(f"<!-- {name}:end -->")[1]
    with open(path, "w", encoding="utf-8") as file:
        file.write(head + f"<!-- {name}:begin -->\n" + "\n".join(lines) + f"\n<!-- {name}:end -->" + tail)
