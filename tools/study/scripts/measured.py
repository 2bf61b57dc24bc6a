# SPDX-License-Identifier: Apache-2.0
"""What the measuring scripts share: their command line, measurements that are kept in build/results until the program changes
and run side by side, and the blocks of a page that a script writes."""
import argparse
import collections
import concurrent.futures
import contextlib
import csv
import glob
import hashlib
import json
import os
import re
import statistics
import subprocess
import sys
import threading
import time

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
PAGES = os.path.join(ROOT, "docs", "study")  # the measured tables and their pictures
DATA = os.path.join(ROOT, "..", "shared", "data")
PROGRAM = os.path.join(ROOT, "build", "release", "trim3r")
CACHE = os.path.join(ROOT, "build", "results")
CORES = len(os.sched_getaffinity(0))
SCENES = ("hololens_b", "icl_livingroom_synth", "icl_livingroom_noisy_synth", "apc_shelf")  # test scenes with depth
TRAINING = ("hololens_a", "7scenes_redkitchen", "sun3d_studyroom_a", "sun3d_studyroom_b", "replica_office0_synth",
            "tartanair_hospital_synth")  # training scenes with depth
RIVALS = ("random", "eagles", "lightgaussian", "pup", "efficientgs")
TRIPLETS = 4  # of a scene, evenly spaced: more hardly move what methods differ by


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


def run(*command):
    """Returns what a command prints."""
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def bits_epoch(program=PROGRAM):
    """Returns the number at the end of `trim3r --version`."""
    return run(program, "--version").split()[-1]


class Measurements:
    """Keeps what commands make. As many run at a time as there are cores; one that is timed runs alone."""

    def __init__(self, script, program=PROGRAM, cache=CACHE):
        self.script, self.program = script, program
        if not os.path.exists(program):
            sys.exit(f"{script}: {os.path.relpath(program)} is not there")
        stamp = hashlib.sha256()
        for path in (program, *sorted(glob.glob(os.path.join(os.path.dirname(program), "libtrim3r_*.so")))):  # its modules
            with open(path, "rb") as file:
                stamp.update(file.read())
        self.folder = os.path.join(cache, stamp.hexdigest()[:12])
        os.makedirs(self.folder, exist_ok=True)
        self.begun, self.count = time.monotonic(), 0
        self.free, self.turn = threading.Semaphore(CORES), threading.Lock()
        self.locks, self.locking = collections.defaultdict(threading.Lock), threading.Lock()

    def lock(self, path):
        """Returns the lock of a file, so that two threads that need it make it once."""
        with self.locking:
            return self.locks[path]

    @contextlib.contextmanager
    def place(self, name, alone=False):
        """Waits for a core, or for all of them, and reports what begins."""
        wanted = CORES if alone else 1
        with self.turn:
            for _ in range(wanted):
                self.free.acquire()
            self.count += 1
        begin, end = ("\r\033[K", "") if sys.stderr.isatty() else ("", "\n")
        print(f"{begin}{self.script}: {self.count} measured, {(time.monotonic() - self.begun) / 60:.1f} min: {name}", end=end,
              file=sys.stderr, flush=True)
        try:
            yield
        finally:
            self.free.release(wanted)

    def each(self, function, items):
        """Returns the function's results in the order of the items, whose measurements run side by side."""
        items = list(items)
        with concurrent.futures.ThreadPoolExecutor(max(1, len(items))) as pool:
            return list(pool.map(function, items))

    def path(self, name, settings):
        """Returns where the file `name` made by these settings is kept."""
        stem, ending = os.path.splitext(name)
        digest = hashlib.sha256(repr(settings).encode()).hexdigest()[:8]
        return os.path.join(self.folder, f"{re.sub('[^a-zA-Z0-9_.+-]+', '-', stem)}.{digest}{ending}")

    def made(self, name, command, alone=False):
        """Returns the file `name`, made by `command` with OUT in it, and what the command printed."""
        path = self.path(name, command)
        log, fresh = path + ".log", os.path.join(self.folder, "new." + os.path.basename(path))
        with self.lock(path):
            if not os.path.exists(path):
                with self.place(name, alone), open(log, "w", encoding="utf-8") as file:
                    subprocess.run([fresh if c == "OUT" else c for c in command], stdout=file, check=True)
                os.replace(fresh, path)
        return path, log

    def kept(self, name, settings, make, alone=False):
        """Returns what make() returns for these settings. It measures nothing that is kept, else it waits for itself."""
        path = self.path(name + ".json", settings)
        with self.lock(path):
            if not os.path.exists(path):
                with self.place(name, alone):
                    value = make()
                with open(path + ".new", "w", encoding="utf-8") as file:
                    json.dump(value, file)
                os.replace(path + ".new", path)
        with open(path, encoding="utf-8") as file:
            return json.load(file)

    def scene(self, name):
        """Returns the folder of a recorded scene."""
        folder = os.path.join(DATA, name)
        if not os.path.exists(folder):
            sys.exit(f"{self.script}: {os.path.relpath(folder)} is not there")
        return folder

    def recording(self, scene, size="256x256"):
        """Returns the recording of a scene, with frames of that size or, for None, of their own."""
        resized = ("--size", size) if size else ()
        name = f"{scene}.mcap" if size else f"{scene}.own.mcap"
        return self.made(name, [self.program, "import", self.scene(scene), *resized, "-o", "OUT"])[0]

    def room(self, *options):
        """Returns a recording of the built-in room."""
        return self.made("room.mcap", [self.program, "room", *options, "-o", "OUT"])[0]

    def told(self, recording):
        """Returns what `trim3r info` reports of the recording."""
        return json.loads(run(self.program, "info", recording, "--json"))

    def cases(self, scene, most=TRIPLETS):
        """Returns [(context, target)] of a scene, at most so many, evenly spaced."""
        return evenly(triplets(self.told(self.recording(scene))), most)

    def evaluated(self, name, *options, alone=False):
        """Returns the rows of a table of `trim3r eval`."""
        path, _ = self.made(f"{name}.csv", [self.program, "eval", *map(str, options), "--csv", "OUT"], alone)
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def novel(self, scene, name, *options, most=TRIPLETS, alone=False):
        """Returns the rows of a scene's triplets, each of which is measured by itself."""
        recording = self.recording(scene)

        def one(case):
            context, target = case
            return self.evaluated(f"{scene}.{target}.{name}", recording, "--context", context, "--target", target, *options,
                                  alone=alone)

        return [row for rows in self.each(one, self.cases(scene, most)) for row in rows]


def evenly(values, most):
    """Returns at most so many of the values, evenly spaced."""
    count = min(most, len(values))
    return [values[i * len(values) // count] for i in range(count)]


def triplets(told):
    """Returns [(context, target)] of told(), as eval's options take them, without those whose context is one frame twice."""
    return [(listed(t["context"]), str(t["target"])) for t in told["triplets"] if t["context"][0] != t["context"][1]]


def listed(values):
    return ",".join(str(v) for v in values)


def means(rows, column, key):
    """Returns the mean of a column over the rows of each value of `key`."""
    groups = {}
    for row in rows:
        groups.setdefault(row[key], []).append(float(row[column]))
    return {k: statistics.fmean(v) for k, v in groups.items()}


def titled(names, rows):
    """Yields each row with a name before it, which stands in the first of those with the same name alone."""
    last = None
    for name, row in zip(names, rows):
        yield ["" if name == last else name, *row]
        last = name


def table(titles, rows):
    yield "| " + " | ".join(titles) + " |"
    yield "|" + "---|" * len(titles)
    for row in rows:
        yield "| " + " | ".join(row) + " |"


# --- pages ------------------------------------------------------------------------------------------------------------


def write_block(path, name, lines):
    """Replaces what stands between the file's marks of that name."""
    with open(path, encoding="utf-8") as file:
        head, rest = file.read().split(f"<!-- {name}:begin -->\n")
    tail = rest.split(f"<!-- {name}:end -->")[1]
    with open(path, "w", encoding="utf-8") as file:
        file.write(head + f"<!-- {name}:begin -->\n" + "\n".join(lines) + f"\n<!-- {name}:end -->" + tail)


def write_head(path, command, program=PROGRAM):
    """Writes how, of which bits and where the page was made."""
    cores = "core" if CORES == 1 else "cores"
    write_block(path, "made",
                [f"Made by `{command}`: bits epoch {bits_epoch(program)}, {CORES} {cores} of {processor()}."])


def arguments(doc, parts, *options):
    """Returns the command line of a script: parts of a page, and options (names, settings) of its own."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"of {', '.join(parts)} (all)")
    parser.add_argument("--write", action="store_true", help="put them into the page")
    parser.add_argument("--pages", default=PAGES, metavar="FOLDER", help="where the page lies (docs/study)")
    parser.add_argument("--program", default=PROGRAM, help="the trim3r that is measured (build/release/trim3r)")
    parser.add_argument("--cache", default=CACHE, metavar="FOLDER", help="where measurements are kept (build/results)")
    for name, settings in options:
        parser.add_argument(name, **settings)
    asked = parser.parse_args()
    asked.error = parser.error
    unknown = [part for part in asked.parts if part not in parts]
    if unknown:
        parser.error(f"no part is called {unknown[0]}: {', '.join(parts)}")
    return asked


def show(asked, page, parts, m):
    """Prints the parts that were asked for, and with --write puts each between its marks of the page."""
    path = os.path.join(asked.pages, page)
    for part in asked.parts or parts:
        lines = list(parts[part](m))
        print("\n".join(lines), flush=True)
        if asked.write:
            write_block(path, part, lines)
    if asked.write and not asked.parts:
        write_head(path, f"tools/study/scripts/{m.script} --write", m.program)


def pyplot():
    """Returns matplotlib's, set so that a picture's bytes depend on what it shows alone."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "trim3r", "svg.fonttype": "none", "font.size": 9})
    from matplotlib import pyplot as made

    return made


def save(figure, path):
    """Writes a picture of matplotlib, an element a line."""
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    with open(path, encoding="utf-8") as file:
        text = re.sub(r" *\n(?=[LQCz\"])", " ", file.read())
    text = re.sub(r"(?<=<g>)\n *|(?<=defs>)\n *|(?<=\">)\n *(?=<)|\n *(?=</(?:g|defs)>)", "", text)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
