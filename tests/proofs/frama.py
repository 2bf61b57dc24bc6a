#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""frama.py: Eva, of Frama-C, finds no alarm in a driver of tests/proofs/frama, a subject each.

    frama.py                 the subjects that docs/study/proofs.md lists, and that each finds a check that is left out
    frama.py fixed plan      these subjects alone
    frama.py --write         all, and writes their seconds into that page
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import sys
import time

import proof

DRIVERS = proof.HERE / "frama"
PAGE = proof.ROOT / "docs" / "study" / "proofs.md"
UNSIGNED = "-warn-unsigned-overflow"

MOST_SECONDS = 600  # subjects take half a minute
# Keeps a function's returns apart, so that what it checked holds in its caller.
APART = ["-eva-interprocedural-history", "-eva-partition-history"]

# A subject: sources beside the driver, and options of Eva. docs/study/proofs.md says of each what functions and ranges it has.
SUBJECTS = {
    "fixed": (["runtime/core/fixed.c"], ["-eva-precision", "4", "-eva-slevel", "400"]),
    "divisor": (["runtime/core/fixed.c"], ["-eva-precision", "4", "-eva-slevel", "200"]),
    "plan": (
        ["runtime/layout/arena.c", "runtime/core/config.c"],
        ["-eva-precision", "1", "-eva-auto-loop-unroll", "64", "-eva-min-loop-unroll", "30", UNSIGNED]),
    "weights": (["runtime/head/weights.c"], ["-eva-precision", "4", "-eva-slevel", "50"]),
    "blocks": (
        ["runtime/head/weights.c"],
        ["-eva-precision", "1", "-eva-auto-loop-unroll", "128", "-eva-slevel", "20", "-eva-split-return-function", "in_file:1"]),
    "double": (["platform/messages/fixed_double.c"], ["-eva-precision", "2", "-eva-slevel", "40000"]),
    "messages": (
        [f"platform/{name}.c" for name in ("messages/ros_messages", "messages/cdr", "host/text", "messages/message_frame",
                                           "messages/fixed_camera", "messages/pixel_layout")],
        ["-eva-precision", "4", "-eva-slevel", "20000", "-eva-auto-loop-unroll", "64", *APART, "2",
         "-eva-use-spec", "t3r_fixed_from_double"]),
    "reader": (
        [f"platform/{name}.c" for name in ("mcap/mcap_records", "messages/ros_messages", "messages/ros_schemas", "messages/cdr",
                                           "messages/message_frame", "messages/fixed_camera", "host/text", "host/fixed_text",
                                           "messages/pixel_layout")],
        ["-eva-precision", "3", "-eva-slevel", "5000", "-eva-auto-loop-unroll", "64", "-eva-min-loop-unroll", "20", *APART, "2",
         "-eva-use-spec", "t3r_fixed_from_float"]),
    "pose": (
        ["runtime/core/scene_frame.c", "runtime/core/fixed.c"],
        ["-eva-precision", "2", "-eva-slevel", "100", "-eva-auto-loop-unroll", "64", "-eva-domains",
         "equality,symbolic-locations", "-eva-equality-through-calls", "all", *APART, "2"]),
    "attach": (
        [f"runtime/{name}.c" for name in (
            "api/open", "api/restored", "api/checks", "layout/arena", "core/config", "core/camera", "core/fixed", "state/views",
            "state/reuse", "budget/cluster_texture")],
        ["-eva-precision", "2", "-eva-slevel", "200", "-eva-auto-loop-unroll", "64", "-eva-min-loop-unroll", "0", *APART, "8",
         "-eva-use-spec", "t3r_pose_in_scene"]),
}
# A check left out of a subject's source: what it says, what stands there instead, and by which words Eva finds it.
LEFT_OUT = {
    "weights": ("runtime/head/weights.c", "bytes < T3R_WEIGHTS_HEADER_BYTES || ", "", "out of bounds read"),
    "blocks": ("runtime/head/weights.c", "block <= header->bytes - offset", "true", "out of bounds read"),
    "reader": ("platform/recording/frame_reader.c", "(rows + chroma) * step > reader->colour_room", "rows * step > reader->colour_room",
               "precondition 'room'"),
    "double": ("platform/messages/fixed_double.c", "exponent > 62 || mantissa > (uint64_t)INT64_MAX >> exponent", "exponent > 62",
               "signed overflow"),
    "messages": ("platform/messages/cdr.c", "reader->failed || reader->count - reader->at < padding + size", "reader->failed",
                 "out of bounds read"),
    "pose": ("runtime/core/scene_frame.c", "if (shift > 0 && t3r_abs64(offset) > T3R_POSITION_MOST_Q20)", "if (shift > 20)",
             "t3r_bound_broken"),
    "attach": ("runtime/api/restored.c", " && rt->gaussians <= rt->config.max_gaussians", "", "out of bounds read"),
}
# What must be found, and Eva's words for it.
PLANTED = {
    "overflow": "signed overflow",
    "shift": "invalid RHS operand for shift",
    "zero": "division by zero",
    "index": "out of bounds index",
    "bound": "t3r_bound_broken",
    "unsigned": "unsigned overflow",
    "endless": "never returns",
}


def eva(driver, sources, options, beside=()):
    """The findings in a driver: alarms, and functions that never return, as nothing behind them is looked at. Headers
    are also looked for in the folders `beside`."""
    folders = " ".join(f"-I {folder}" for folder in (*beside, proof.RUNTIME / "include", proof.RUNTIME,
                                                     proof.ROOT / "platform"))
    includes = f"-std=c11 {folders} -include {DRIVERS / 'frama.h'}"
    result = proof.run(["timeout", str(MOST_SECONDS), "frama-c", "-no-unicode", "-machdep", "gcc_x86_64", "-c11", f"-cpp-extra-args={includes}", "-eva",
                        "-warn-signed-overflow", *options, driver, *(proof.ROOT / source for source in sources)])
    if result.returncode == 124:
        proof.broken(f"Frama-C takes more than {MOST_SECONDS} s for {driver}: a loop may have become longer than it unrolls", [])
    if result.returncode != 0 or "ANALYSIS SUMMARY" not in result.stdout:
        proof.broken(f"Frama-C does not read {driver}", (result.stdout + result.stderr).splitlines())
    found = [re.sub(r"\s+", " ", text) for text in re.findall(r"^\[eva:alarm\] .*(?:\n  .*)*", result.stdout, flags=re.M)]
    return found + [f"{name} never returns" for name in
                    re.findall(r"Values at end of function (\w+):\n\s*NON TERMINATING FUNCTION", result.stdout)]


def seconds_of(subject):
    """Returns Eva's seconds for the subject, which must have no alarm."""
    sources, options = SUBJECTS[subject]
    before = time.monotonic()
    found = eva(DRIVERS / f"{subject}.c", sources, options)
    proof.verdict(f"no alarm in tests/proofs/frama/{subject}.c", found)
    return time.monotonic() - before


def must_find_left_out(subject):
    """Checks that Eva raises an alarm when the check is removed from a copy of the subject's source."""
    changed, says, instead, words = LEFT_OUT[subject]
    sources, options = SUBJECTS[subject]
    text = (proof.ROOT / changed).read_text()
    if text.count(says) != 1:
        proof.broken(f"{changed} does not say '{says}' once")
    with proof.scratch() as folder:
        copy = folder.joinpath(*pathlib.Path(changed).parts[1:])  # as it is included
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(text.replace(says, instead))
        found = eva(DRIVERS / f"{subject}.c", [copy if source == changed else source for source in sources], options,
                    [folder, (proof.ROOT / changed).parent])
        proof.must_find(found, words, f"{changed} without '{says.strip()}'")


def row_of(subject, page):
    """Returns the page's row of the subject, in three parts: what it says, the seconds, what is left out; or None."""
    return re.search(rf"^(\| {subject} (?:\|[^|\n]+){{2}}\| )([\d.]+)( \| 0 \|[^|\n]+\|)$", page, re.M)


def unlisted(subjects, page):
    """Returns the subjects whose row is missing in the page."""
    return [subject for subject in subjects if row_of(subject, page) is None]


def with_seconds(page, seconds):
    for subject, taken in seconds.items():
        page = page.replace(row_of(subject, page)[0], row_of(subject, page).expand(rf"\g<1>{taken:.1f}\g<3>"))
    return page


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write the seconds into docs/study/proofs.md")
    parser.add_argument("subjects", nargs="*", help=", ".join(SUBJECTS))
    options = parser.parse_args()
    if options.write and options.subjects:
        parser.error("the page has the seconds of all subjects")
    if shutil.which("frama-c") is None:
        print("SKIPPED: no frama-c here (tools/setup --tests)")
        sys.exit(77)
    for name, words in PLANTED.items():
        flags = [UNSIGNED] if name == "unsigned" else []
        proof.must_find(eva(proof.PLANTED / "frama" / f"{name}.c", [], flags), words, f"{name}.c")
    subjects = options.subjects or [*SUBJECTS]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(must_find_left_out, () if options.subjects else LEFT_OUT))
        seconds = dict(zip(subjects, pool.map(seconds_of, subjects)))
    if unlisted(["plan"], "| plan | all | any | 1.0 | 1 | nothing |") != ["plan"]:
        proof.broken("blind: a subject that the page lacks is not noticed")
    proof.verdict("docs/study/proofs.md has each subject, without alarms", unlisted(seconds, PAGE.read_text()))
    if options.write:
        PAGE.write_text(with_seconds(PAGE.read_text(), seconds))


if __name__ == "__main__":
    main()
