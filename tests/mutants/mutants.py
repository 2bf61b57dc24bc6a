#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutants of the fixed-point core, each compiled with the unit tests that should notice it.

    mutants.py             a sample, the same each time: every mutant is caught, or listed in equivalent.txt with a reason
    mutants.py --all       every mutant, and docs/study/proofs.md has the counts of today
    mutants.py --write     every mutant, and writes the counts into that page
    mutants.py --only FILE those of one file, for who writes tests: prints which survive

Either way the tests are taken away first: a mutant must survive then.
"""
import argparse
import collections
import concurrent.futures
import itertools
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

import mutate

HERE = pathlib.Path(__file__).resolve().parent
TESTS, ROOT = HERE.parent, HERE.parent.parent
RUNTIME = ROOT / "runtime"
PAGE = ROOT / "docs" / "study" / "proofs.md"
LISTED = HERE / "equivalent.txt"
sys.path[:0] = [str(TESTS), str(ROOT / "tools" / "study" / "scripts")]

from checks import check, done, skip  # noqa: E402
from measured import table, write_block  # noqa: E402

# A suite is a program: a test, and what of the runtime it calls.
SUITES = {
    "fixed": ("unit/core/test_fixed.c", "core/fixed.c"),
    "domains": ("unit/core/test_domains.c", "core/fixed.c", "kernels/plain/blend.c"),
    "cut": ("unit/core/test_cut.c",),
    "camera": ("unit/core/test_camera.c", "core/camera.c", "core/camera_fault.c", "core/fault.c"),
    "scene_frame": ("unit/core/test_scene_frame.c", "core/scene_frame.c", "core/camera.c"),
    "bytes": ("unit/core/test_bytes.c",),
    "tasks": ("workers/test_tasks.c", "core/workers.c"),
}
# Those that should notice a mistake in a file, the quickest first. Settings (config, features, names) have no
# fixed-point arithmetic, the other headers none at all.
NOTICED_BY = {
    "fixed.h": ("fixed", "domains"),
    "fixed.c": ("fixed", "domains"),
    "logarithm.h": ("fixed", "domains"),
    "divisor.h": ("fixed", "domains"),
    "camera.c": ("camera",),
    "camera_checks.h": ("camera",),
    "scene_frame.h": ("scene_frame",),
    "scene_frame.c": ("scene_frame",),
    "cut.h": ("cut",),
    "hash.h": ("bytes",),
    "little_endian.h": ("bytes",),
    "workers.h": ("tasks",),
    "workers.c": ("tasks",),
}
COMPILE = ["gcc", "-std=gnu11", "-O1", "-w", "-ffunction-sections", f"-I{HERE}"]
SANITIZED = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"] # as tests of all programs run, too
LINK = ["-Wl,--gc-sections", "-lm"]
SEED, SAMPLE = 1, 12
SHARE_LEAST = 0.9
TITLES = ("file", "mutants", "did not compile", "equivalent", "caught", "survived", "share")
CAUGHT, SURVIVED, BROKEN = "caught", "survived", "did not compile"


class Bench:
    """Compiles and runs mutants. Objects that a mutant does not affect are compiled once."""

    def __init__(self, folder, options=()):
        self.folder, self.options = folder, options
        self.limit_s, self.objects = {}, {}

    def words(self, core):
        return [*COMPILE, *self.options, *(f"-I{path}" for path in (core.parent, RUNTIME, RUNTIME / "include", TESTS))]

    @staticmethod
    def place(source, core):
        if source.startswith("core/"):
            return core.parent / source
        return RUNTIME / source if (RUNTIME / source).exists() else TESTS / source

    def prepare(self, suite):
        """Compiles the suite with the unchanged core: its objects, and its running time."""
        parts = []
        for number, source in enumerate(SUITES[suite]):
            self.objects[suite, source] = self.folder / f"{suite}-{number}.o"
            ended = subprocess.run([*self.words(RUNTIME / "core"), "-c", self.place(source, RUNTIME / "core"), "-o",
                                    self.objects[suite, source]], capture_output=True, text=True)
            check(ended.returncode == 0, f"{source} compiles\n{ended.stderr}")
            parts.append(self.objects[suite, source])
        program = self.folder / suite
        ended = subprocess.run([*COMPILE, *parts, "-o", program, *LINK], capture_output=True, text=True)
        check(ended.returncode == 0, f"the suite {suite} links\n{ended.stderr}")
        begun = time.monotonic()
        ended = subprocess.run([program], capture_output=True)
        check(ended.returncode == 0, f"the suite {suite} passes")
        self.limit_s[suite] = 2 + int(5 * (time.monotonic() - begun))

    def fails(self, suite, core, changed, program, sanitized):
        """Whether the suite fails with that core; None if it does not compile."""
        parts = [self.place(source, core) if sanitized or changed.endswith(".h") or source == f"core/{changed}"
                 else self.objects[suite, source] for source in SUITES[suite]]
        extra, limit_s = (SANITIZED, 10 * self.limit_s[suite]) if sanitized else ([], self.limit_s[suite])
        ended = subprocess.run([*self.words(core), *extra, *parts, "-o", program, *LINK], capture_output=True, text=True)
        if ended.returncode != 0:
            check(not sanitized, f"what compiles does so with sanitizers\n{ended.stderr}")
            return None
        return subprocess.run(stopped_after(limit_s, program), capture_output=True).returncode != 0

    def fate(self, mutant):
        with tempfile.TemporaryDirectory(dir=self.folder) as name:
            core = pathlib.Path(name) / "core"
            shutil.copytree(RUNTIME / "core", core)
            source = core / mutant.file
            source.write_text(mutant.of(source.read_text()))
            for sanitized, suite in itertools.product((False, True), NOTICED_BY[mutant.file]):
                failed = self.fails(suite, core, mutant.file, core.parent / "program", sanitized)
                if failed or failed is None:
                    return CAUGHT if failed else BROKEN
        return SURVIVED

    def fates(self, mutants):
        suites = sorted({suite for mutant in mutants for suite in NOTICED_BY[mutant.file]} - set(self.limit_s))
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(self.prepare, suites))
            return list(zip(mutants, pool.map(self.fate, mutants)))


def stopped_after(seconds, program):
    """Returns a command limited in processor time, so that a busy machine changes nothing."""
    return ["prlimit", f"--cpu={seconds}", "--core=0", program]


def all_mutants():
    return [mutant for file in NOTICED_BY for mutant in mutate.mutants_of(file, (RUNTIME / "core" / file).read_text())]


def listed_in(text):
    """{key: reason} of the list's blocks: a place, mutants of it (- the line, + the mutant's), and why they are the same."""
    listed = {}
    for block in text.split("\n\n"):
        place, *lines = [line for line in block.splitlines() if not line.startswith("#")] or [None]
        befores, afters = ([line[2:] for line in lines if line.startswith(sign)] for sign in "-+")
        reason = " ".join(line.strip() for line in lines if line.startswith("  "))
        check(place is None or befores and len(befores) == len(afters) and reason, f"mutants and a reason\n{block}")
        for before, after in zip(befores, afters):
            check((place, before, after) not in listed, f"listed once\n{block}")
            listed[place, before, after] = reason
    return listed


def text_of(key):
    return "{}\n- {}\n+ {}".format(*key)


def faults_of(fates, listed, every):
    """Finds errors: a survivor without a reason, a reason for a caught mutant, or for none."""
    faults = []
    for mutant, fate in fates:
        if fate == SURVIVED and mutant.key not in listed:
            faults.append(f"survives, and nothing says why:\n{text_of(mutant.key)}")
        elif fate != SURVIVED and mutant.key in listed:
            faults.append(f"listed as equivalent, and {fate}:\n{text_of(mutant.key)}")
    exist = {mutant.key for mutant in every}
    return faults + [f"listed, and no mutant any more:\n{text_of(key)}" for key in listed if key not in exist]


def share_of(count):
    seen = count[CAUGHT] + count[SURVIVED]
    return count[CAUGHT] / seen if seen else 0


def rows_of(fates, listed):
    """Returns (rows of the table, the counts of all)."""
    counts = collections.defaultdict(collections.Counter)
    for mutant, fate in fates:
        counts[f"`{mutant.file}`"]["equivalent" if fate == SURVIVED and mutant.key in listed else fate] += 1
    whole = counts["all"] = sum(counts.values(), collections.Counter())
    return "\n".join(
        f"| {name} | {count.total()} | {count[BROKEN]} | {count['equivalent']} | {count[CAUGHT]} | {count[SURVIVED]} | "
        f"{100 * share_of(count):.1f} % |" for name, count in counts.items()), whole


def makes_what_it_should():
    """Checks that the planted source gives exactly the listed mutants."""
    said = [f"{mutant.before} => {mutant.after}" for mutant in mutate.mutants_of("", (HERE / "planted.c").read_text())]
    want = (HERE / "planted.txt").read_text().splitlines()
    check(said == want, "planted.c has the mutants of planted.txt, not\n" + "\n".join(sorted(set(said) ^ set(want))))


def can_fail(every, folder):
    """Without its tests a mutant survives that they catch; a program that does not end is stopped; and the list can be
    wrong in every way."""
    one = next(mutant for mutant in every if mutant.file == "hash.h")
    without = folder / "without"
    without.mkdir()
    check(Bench(without, ["-DT3R_TESTS_TAKEN_AWAY"]).fates([one]) == [(one, SURVIVED)], "a mutant survives without tests")
    caught = Bench(folder).fates([one])
    check(caught == [(one, CAUGHT)], "and is caught with them")
    check(len(faults_of([(one, SURVIVED)], {}, every)) == 1, "a survivor without a reason is a fault")
    check(faults_of([(one, SURVIVED)], {one.key: "a reason"}, every) == [], "with one it is none")
    check(len(faults_of(caught, {one.key: "a reason"}, every)) == 1, "a reason for a mutant that is caught is a fault")
    none = {("hash.h: t3r_hash_u8", "", ""): "a reason"}
    check(len(faults_of(caught, none, every)) == 1, "so is one for a mutant that does not exist")
    ended = subprocess.run(stopped_after(1, sys.executable) + ["-c", "while True: pass"], capture_output=True)
    check(ended.returncode != 0, "what does not end is stopped")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true", help="every mutant")
    parser.add_argument("--write", action="store_true", help="every mutant, and write their counts into docs/study/proofs.md")
    parser.add_argument("--only", choices=NOTICED_BY, metavar="FILE", help="those of one file")
    options = parser.parse_args()
    if shutil.which("gcc") is None or shutil.which("prlimit") is None:
        skip("no gcc or no prlimit here (tools/setup --tests)")
    every, listed = all_mutants(), listed_in(LISTED.read_text())
    if options.only:
        chosen = [mutant for mutant in every if mutant.file == options.only]
    else:
        chosen = every if options.all or options.write else random.Random(SEED).sample(every, SAMPLE)
    with tempfile.TemporaryDirectory(prefix="trim3r-mutants-") as name:
        folder = pathlib.Path(name)
        makes_what_it_should()
        can_fail(every, folder)
        fates = Bench(folder).fates(chosen)
    rows, whole = rows_of(fates, listed)
    print(rows)
    faults = faults_of(fates, listed, every)
    check(not faults, "\n".join(faults))
    check(len(chosen) < len(every) or share_of(whole) >= SHARE_LEAST, f"{share_of(whole):.1%} are caught")
    if options.write:
        write_block(PAGE, "mutants", [*table(TITLES, []), rows])
    elif options.all:
        check(rows in PAGE.read_text(), f"docs/study/proofs.md has other counts: {HERE / 'mutants.py'} --write")
    done()


if __name__ == "__main__":
    main()
