# SPDX-License-Identifier: Apache-2.0
"""The common part of the firmware's ports: its sources, its build, and its output."""
import json
import pathlib
import re
import subprocess
import sys

import objects

ROOT = pathlib.Path(__file__).resolve().parents[3]
BAREMETAL = ROOT / "platform" / "baremetal"
RUNTIME = ROOT / "runtime"
FEATURES = tuple(name.lower() for name in re.findall(
    r"#ifndef T3R_FEATURE_(\w+)", (RUNTIME / "include" / "trim3r_features.h").read_text()))
BOARDS = {path.parent.name: json.loads(path.read_text()) for path in sorted(BAREMETAL.glob("boards/*/board.json"))}
STAGES = ("image", "depth", "pointmap", "wavelet", "superclusters", "budget", "head", "refine", "raster")
# The parts of platform/ in the firmware: the reader of recordings without a heap.
READER = ("host/fixed_text", "host/text", "mcap/mcap_records", "messages/cdr", "messages/fixed_camera", "messages/fixed_double",
          "messages/message_frame", "messages/ros_messages", "messages/ros_schemas", "recording/frame_reader",
          "messages/pixel_layout")
INCLUDES = (RUNTIME / "include", RUNTIME, ROOT / "platform", BAREMETAL, ROOT / "quant" / "heads")
INCLUDE = tuple(word for folder in INCLUDES for word in ("-I", folder))
FLAGS = ("-std=c11", "-ffunction-sections", "-fdata-sections", "-Wall", "-Wextra", "-Werror",
         "-Wl,--gc-sections")
SECONDS_MOST = 600


def run(*command, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    if done.returncode != 0:
        sys.exit(f"tools/boards: {' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def left_out(options):
    return [feature for feature in FEATURES if feature not in options.features]


CLOSED_FORM = "analytic" # the head without weights


def is_small(options):
    """Whether the firmware is small: without some features, with planes instead of a recording, and in plain C."""
    return bool(left_out(options))


def sources_of(board, options):
    """The firmware's own, and the runtime's."""
    rows = [line.split() for line in (RUNTIME / "features.txt").read_text().splitlines() if not line.startswith("#")]
    absent = {path for feature, pattern in rows if feature in left_out(options)
              for path in RUNTIME.glob(pattern) if not path.stem.endswith("_absent")}
    runtime = [path for path in objects.sources() if path not in absent]
    weights = [] if options.head == CLOSED_FORM else [ROOT / "quant" / "heads" / f"{options.head}.c"]
    reader = () if is_small(options) else READER
    other_frames = "frames_recording" if is_small(options) else "frames_planes"
    port = [*sorted(BAREMETAL.glob("*.c")), *sorted((BAREMETAL / BOARDS[board]["port"]).glob("*.c"))]
    own = [*(path for path in port if path.stem != other_frames), *weights,
           *(ROOT / "platform" / f"{name}.c" for name in reader)]
    return own, runtime


def features_of(options):
    """Returns the compiler's arguments for the runtime."""
    return [*(f"-DT3R_FEATURE_{name.upper()}=0" for name in left_out(options)), *(["-flto=auto"] if options.lto else [])]


def choices_of(options):
    """Returns the compiler's arguments for features, weights and the firmware's kernels."""
    weights = f"t3r_head_{options.head}"
    head = [] if options.head == CLOSED_FORM else [f"-DHEAD={weights}", f"-DHEAD_BYTES={weights}_bytes"]
    return [*head, *features_of(options), *(["-DPLAIN_C"] if is_small(options) else [])]


def build(board, suffix, compiler, link, options, runtime_compiler=None):
    """Builds the board's firmware with this compiler and these linker arguments; the runtime may have another
    compiler."""
    parts = [f"{board}-{options.head}{options.optimize}", *(["lto"] if options.lto else []),
             *(["clang"] if options.clang else []),
             *(f"no_{name}" for name in left_out(options)), *([str(options.ram)] if options.ram else [])]
    made = options.out / f"{'-'.join(parts)}{suffix}"
    own, runtime = sources_of(board, options)
    flags = [options.optimize, *BOARDS[board]["flags"]]
    compiled = objects.compiled([*(runtime_compiler or compiler), *flags, *features_of(options)], runtime)
    run(*compiler, *FLAGS, *flags, *INCLUDE, *choices_of(options), *own, *compiled, *link, "-o", made)
    return made


def planes(path, options):
    """Writes the recording's frames for a firmware without a reader of recordings."""
    made = options.out / f"{path.stem}-{'x'.join(map(str, options.size))}.planes"
    program = made.with_suffix(".program")
    run("cc", "-std=c11", "-O1", *INCLUDE, pathlib.Path(__file__).with_name("planes.c"),
        *(ROOT / "platform" / f"{name}.c" for name in READER), "-o", program)
    run(program, *options.size, path, made)
    return made


def words(path, options):
    """Returns the firmware's command line, without hashes and view."""
    width, height = options.size
    return [f"frames={planes(path, options) if is_small(options) else path}", f"width={width}", f"height={height}", f"views={options.views}",
            f"gaussians={options.gaussians}", f"clusters={options.clusters}", f"refine={options.refine}",
            f"learned={int(options.head != CLOSED_FORM)}"]


def said_by(board, *command):
    """Returns the firmware's output as {name: text}."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=SECONDS_MOST)
    if done.returncode != 0:
        sys.exit(f"tools/boards: {board}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return dict(line.rsplit(" ", 1) for line in done.stdout.splitlines())


def row(board, said, flash_bytes, view):
    """Returns each port's results of a run with hashes."""
    hashes = {name[5:]: text for name, text in said.items() if name.startswith("hash ")}
    return {
        "board": board,
        "name": BOARDS[board]["name"],
        "hash": hashes.pop("final"),
        "hashes": hashes,
        "flash_bytes": flash_bytes,
        "ram_bytes": sum(int(said[f"{part}_bytes"]) for part in ("data", "memory", "stack")),
        **{name: int(said[name]) for name in ("gaussians", "arena_bytes", "arena_min_bytes", "stack_bytes")},
        "view": str(view),
    }
