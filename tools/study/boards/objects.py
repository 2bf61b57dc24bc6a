# SPDX-License-Identifier: Apache-2.0
"""The runtime's objects by a compiler and its flags: compiled once for everything that links or examines them."""
import concurrent.futures
import fcntl
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
RUNTIME = ROOT / "runtime"
FOLDER = ROOT / "build" / "objects"
# Only the compiler's own headers, and a section for each function, as a firmware is built.
FLAGS = ("-std=c11", "-ffreestanding", "-ffunction-sections", "-fdata-sections", "-Wall", "-Wextra", "-Werror",
         "-I", RUNTIME / "include", "-I", RUNTIME)
# gcc alone: no loop becomes a call; NAME.ci has the frames and calls of each function
GRAPH_FLAGS = ("-fstack-usage", "-fcallgraph-info=su")
GCC_FLAGS = ("-fno-tree-loop-distribute-patterns", *GRAPH_FLAGS)


def sources():
    return sorted(RUNTIME.rglob("*.c"))


def absent(*tools):
    """Returns the first missing tool, or None."""
    return next((tool for tool in tools if tool is not None and shutil.which(tool) is None), None)


def output_of(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def command_of(compiler):
    """Returns the compiler's arguments that all its objects share."""
    own = output_of(compiler[0], "-print-file-name=include").strip()
    by_gcc = "gcc" in pathlib.Path(compiler[0]).name
    return [*compiler, *FLAGS, *(GCC_FLAGS if by_gcc else ()), "-nostdinc", "-isystem", own]


def is_fresh(made):
    """Whether none of the object's sources has changed since it was made."""
    rule = made.with_suffix(".d")
    if not made.exists() or not rule.exists():
        return False
    given = rule.read_text().replace("\\\n", " ").split(": ", 1)[1].split()
    return all(os.path.exists(path) and os.path.getmtime(path) < made.stat().st_mtime for path in given)


def compiled(compiler, chosen=None):
    """Compiles these sources (all of the runtime) with the compiler, a list of words that includes flags. Another
    process that wants the same objects waits."""
    command = command_of(compiler)
    words = " ".join(map(str, command)) + output_of(compiler[0], "--version")
    name = pathlib.Path(compiler[0]).name + "".join(word for word in compiler[1:] if word.startswith(("-O", "-m")))
    folder = FOLDER / f"{name}-{hashlib.sha256(words.encode()).hexdigest()[:8]}"
    folder.mkdir(parents=True, exist_ok=True)

    def made_of(source):
        made = folder / ("-".join(source.relative_to(RUNTIME).with_suffix("").parts) + ".o")
        if not is_fresh(made):
            output_of(*command, "-MMD", "-c", source, "-o", made)
        return made

    with open(folder / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            return list(pool.map(made_of, sources() if chosen is None else chosen))


def call_graphs(made):
    return [path.with_suffix(".ci") for path in made]
