#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""planted.py FOLDER [KIND...] | --list: the tests that run by day notice a fault of each kind.

A copy of the tree in FOLDER gets one fault at a time; the test that shall notice it passes without the fault, and fails with
it. --list prints the table of docs/development.md, which must be that of FAULTS. Builds of an earlier run in FOLDER are
used again.
"""
import pathlib
import shutil
import subprocess
import sys
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from checks import check, done, run  # noqa: E402

PAGE = ROOT / "docs" / "development.md"


class Fault(NamedTuple):
    kind: str     # one word
    what: str     # for the table
    area: str     # folder in which the file is found by its name, wherever it lies
    file: str
    was: str      # "" = the file's end
    becomes: str
    preset: str
    targets: str  # what the test needs built
    test: str
    says: str = ""


FAULTS = (
    Fault("bits", "plain C rounds another way", "runtime", "blend.c", "(q_q17[i] + 8) >> 4", "(q_q17[i] + 7) >> 4",
          "release", "golden_driver", "golden_stages_ways"),
    Fault("vectors", "an AVX2 loop rounds another way", "runtime", "luma_at_avx2.c", "(sum + 32768) >> 16",
          "(sum + 32767) >> 16", "release", "test_kernels", "kernels"),
    Fault("endian", "bytes are not swapped where the machine is big-endian", "runtime", "little_endian.h",
          "__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__", "0", "release", "", "network_big_endian"),
    Fault("float", "the runtime multiplies real numbers", "runtime", "blend.c", "",
          "int t3r_planted(int x);\nint t3r_planted(int x)\n{\n    return (int)(0.7f * (float)x);\n}\n",
          "release", "", "proof_symbols_cortex_m3"),
    Fault("heap", "the runtime allocates", "runtime", "blend.c", "",
          "void *malloc(unsigned long);\nvoid *t3r_planted(void);\nvoid *t3r_planted(void)\n{\n    return malloc(8);\n}\n",
          "release", "trim3r_runtime", "proof_symbols"),
    Fault("global", "the runtime keeps state between calls", "runtime", "blend.c", "", "int t3r_planted = 1;\n",
          "release", "trim3r_runtime", "proof_symbols"),
    Fault("stack", "a function has a table of 16 KiB on the stack", "runtime", "build.c", "    t3r_view views[T3R_MAX_VIEWS];\n",
          "    t3r_view views[T3R_MAX_VIEWS];\n    volatile char planted[16384];\n    planted[0] = 0;\n",
          "release", "", "proof_stack_cortex_m3"),
    Fault("structure", "the foundation includes the interface's room", "runtime", "fixed.c", "#include \"fixed.h\"\n",
          "#include \"fixed.h\"\n\n#include \"api/checks.h\"\n", "release", "trim3r trim3r_quant tools_ros", "proof_structure"),
    Fault("value", "a measure of pictures is a little off", "tools", "metrics.c", "(uint64_t)(difference * difference);",
          "(uint64_t)(difference * difference) + 1;", "asan", "test_metrics", "metrics"),
    Fault("memory", "a message is read beyond its end", "platform", "cdr.c", "reader->count - reader->at < padding + size",
          "reader->count - reader->at < padding", "asan", "test_recording_foreign", "recording_foreign"),
    Fault("undefined", "a byte is shifted into the sign", "runtime", "little_endian.h", "(uint32_t)p[3] << 24",
          "(uint32_t)(p[3] << 24)", "asan", "test_recording", "recording"),
    Fault("file", "a file has one Gaussian more than its bytes", "tools/scene", "splat.c", "(uint32_t)(count / ROW_BYTES)",
          "(uint32_t)(count / ROW_BYTES + 1)", "asan", "fuzz_splat", "seeds_splat"),
    Fault("race", "a thread reads what another still writes", "platform", "threads.c",
          "return atomic_load_explicit(&threads->busy, memory_order_acquire) == 0;",
          "return atomic_load_explicit(&threads->busy, memory_order_relaxed) == 0;", "tsan", "test_threads", "threads"),
    Fault("variant", "plain C rounds another way", "runtime", "blend.c", "(q_q17[i] + 8) >> 4", "(q_q17[i] + 7) >> 4",
          "asan", "fuzz_settings", "seeds_settings", "it takes the processor's variants"),
    Fault("worker", "a third worker's sums are lost", "runtime", "superclusters.c", "+= from->sum[k][d];",
          "+= w > 1 ? 0 : from->sum[k][d];", "asan", "fuzz_settings", "seeds_settings", "it takes workers"),
    Fault("slice", "each slice of Gaussians but the first lacks its last", "runtime", "refine.c",
          "T3R_MIN(w.slice, rt->gaussians - first);", "T3R_MIN(w.slice, rt->gaussians - first) - (first > 0);",
          "asan", "fuzz_settings", "seeds_settings", "it takes the arena's size"),
    Fault("place", "an arena that moved forgets its analysis", "runtime", "open.c", "state->weights = NULL;",
          "state->weights = NULL;\n    state->reuse = (t3r_reuse){0};", "asan", "fuzz_settings", "seeds_settings",
          "it takes the arena's place"),
    Fault("strip", "a strip's last row is left out", "runtime", "image.c", "from_y - first < count",
          "from_y - first < count - (count > 1)", "asan", "fuzz_settings", "seeds_settings", "it takes strips"),
    Fault("cancelled", "a cancelled call leaves its comparison", "runtime", "pipeline.c", "t3r_reset_comparison(&views[v], 1);",
          "(void)v;", "asan", "fuzz_settings", "seeds_settings", "it takes a cancelled call"),
    Fault("room", "a build takes room that its request leaves", "runtime", "build.c",
          "? request->gaussians : order.build.gaussians", "? request->gaussians : rt->config.max_gaussians",
          "asan", "fuzz_settings", "seeds_settings", "it takes room that settings leave"),
    Fault("page", "a page names an option that is not there", "docs", "cli.md", "--gaussians", "--gausians",
          "release", "trim3r", "docs_words"),
)


def table():
    rows = [f"| {fault.kind} | {fault.what} | `{fault.test}` |" for fault in FAULTS]
    return "\n".join(["| kind | planted | found by |", "|---|---|---|", *rows])


def copy_of_tree(folder):
    """Copies only the tracked files, each only if it differs, so that builds stay up to date."""
    listed = run("git", "-C", ROOT, "ls-files", "--cached", "--others", "--exclude-standard").stdout.splitlines()
    names = [name for name in listed if (ROOT / name).is_file()]
    for path in folder.rglob("*"):
        name = path.relative_to(folder)
        if name.parts[0] != "build" and path.is_file() and name.as_posix() not in names:
            path.unlink()
    for name in names:
        copy = folder / name
        if not copy.exists() or copy.read_bytes() != (ROOT / name).read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, copy)


def file_of(folder, fault):
    found = sorted((folder / fault.area).rglob(fault.file))
    check(len(found) == 1, f"{fault.kind}: there is one {fault.file} in {fault.area}: {found}")
    return found[0]


def build(folder, preset, targets):
    if targets:
        run("cmake", "--build", folder / "build" / preset, "--target", *targets.split(), "--parallel", "2")


def run_test(folder, fault):
    """Whether the test passes in a fresh build, and its output; anything but a verdict of the test itself ends this one."""
    build(folder, fault.preset, fault.targets)
    ended = subprocess.run(["ctest", "--test-dir", folder / "build" / fault.preset, "-R", f"^{fault.test}$", "--no-tests=error",
                            "--output-on-failure"], capture_output=True, text=True)
    check("1 tests failed out of 1" in ended.stdout or "100% tests passed" in ended.stdout, f"{fault.test}: {ended.stdout}")
    check("Skipped" not in ended.stdout, f"{fault.test} is skipped: {ended.stdout}")
    return ended.returncode == 0, ended.stdout


def main():
    if sys.argv[1:] == ["--list"]:
        print(table())
        return
    folder, kinds = pathlib.Path(sys.argv[1]), sys.argv[2:]
    check(table() in PAGE.read_text(), "docs/development.md has another table: planted.py --list prints it")
    chosen = [fault for fault in FAULTS if not kinds or fault.kind in kinds]
    copy_of_tree(folder)
    for preset in sorted({fault.preset for fault in chosen}):
        build_folder = folder / "build" / preset
        words = ["-DT3R_TESTS=ON", "-Wno-dev"]
        if not build_folder.exists() and shutil.which("ninja"):
            words += ["-G", "Ninja"]
        if shutil.which("ccache"):
            words += ["-DCMAKE_C_COMPILER_LAUNCHER=ccache"]
        run("cmake", "-S", folder, "--preset", preset, "-B", build_folder, *words)
    missed, sound = [], set()
    for fault in chosen:
        path = file_of(folder, fault)
        text = path.read_text()
        check(fault.was in text, f"{fault.kind}: {path} no longer has '{fault.was}': plant another fault in {__file__}")
        check(fault.test in sound or run_test(folder, fault)[0], f"{fault.test} fails without the fault '{fault.kind}'")
        sound.add(fault.test)
        try:
            path.write_text(text.replace(fault.was, fault.becomes) if fault.was else text + fault.becomes)
            passed, output = run_test(folder, fault)
            found = not passed and fault.says in output
        finally:
            path.write_text(text)
        print(f"{fault.kind}: {fault.what}: {'found' if found else 'MISSED'} by {fault.test}", flush=True)
        missed += [] if found else [fault.kind]
    check(not missed, f"missed: {missed}")
    done()


if __name__ == "__main__":
    main()
