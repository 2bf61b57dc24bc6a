# SPDX-License-Identifier: Apache-2.0
"""The firmware as a WebAssembly module under Node.js: measures times, because nothing counts its instructions."""
import json

from firmware import BAREMETAL, STAGES, build, row, run, said_by, words

COMPILER = ["clang", "--target=wasm32-wasi", "-mbulk-memory"]
HOST = BAREMETAL / "wasm" / "host.mjs"
TOOLS = ("clang", "wasm-ld", "node")
PAGE_BYTES, RAM_BYTES, STACK_BYTES = 65536, 64 << 20, 16 << 10
ROUNDS = 5


def lacks():
    """Returns a missing tool, or None."""
    found = run(*COMPILER, "-print-file-name=libc.a").strip()
    return "wasi-libc" if found == "libc.a" else None


def prepare(options):
    """Prepares the part that all boards share."""


def module(board, options):
    ram = (options.ram or RAM_BYTES) // PAGE_BYTES * PAGE_BYTES
    link = ["-nostartfiles", "-Wl,--no-entry,--strip-all", f"-Wl,-z,stack-size={STACK_BYTES}", f"-Wl,--initial-memory={ram}",
            f"-Wl,--max-memory={ram}"]
    return build(board, ".wasm", COMPILER, link, options)


def start(board, made, runs, line):
    # The optimizing compiler from the first call on, so that no function is replaced by a faster one while it is timed.
    return said_by(board, "node", "--no-liftoff", HOST, made, runs, *line)


def measure(board, path, options):
    made = module(board, options)
    view = made.with_suffix(".ppm")
    said = start(board, made, 1, [*words(path, options), "hashes=1", f"view={view}"])
    return [row(board, said, made.stat().st_size, view)]


def native_milliseconds(path, cpu_mask, options):
    """Times this machine's program with one thread, building the same scene."""
    context = ",".join(map(str, range(options.views)))
    said = json.loads(run(options.program, "build", path, "--context", context, "--head", options.head, "--gaussians",
                          options.gaussians, "--clusters", options.clusters, "--refine", options.refine, "--threads", 1,
                          "--cpu-mask", cpu_mask, "--json", "-o", options.out / "native.ply"))
    return said["build_ms"]


def times(boards, path, options):
    """Returns {name: {stage: ms}} for each board, and for this machine in plain C and with vectors, all stages but
    the last: the minimum over alternating rounds."""
    line = [*words(path, options), "hashes=0"]
    found = {}

    def keep(name, stage, time):
        row_of = found.setdefault(name, {})
        row_of[stage] = min(time, row_of.get(stage, time))

    for _ in range(ROUNDS):
        for board in boards:
            said = start(board, module(board, options), 1, line)
            for number, stage in enumerate(STAGES):
                keep(board, stage, float(said[f"ms_{number}"]))
        for name, mask in (("native, plain C", "none"), ("native", "all")):
            keep(name, "build", native_milliseconds(path, mask, options))
    return found
