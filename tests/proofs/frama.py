#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""frama.py: Eva of Frama-C finds no alarm in the drivers of tests/proofs/frama, one for each subject.

frama.py                 the subjects listed in docs/study/proofs.md; and removing a check makes Eva raise an alarm
frama.py fixed plan      these subjects only
frama.py --write         all, and writes that page
"""
import argparse
import pathlib
import re
import shutil
import sys
import time

import proof

DRIVERS = proof.HERE / "frama"
PAGE = proof.ROOT / "docs" / "study" / "proofs.md"
UNSIGNED = "-warn-unsigned-overflow"

# Keeps a function's returns apart, so that conditions it checked hold in its caller.
APART = ["-eva-interprocedural-history", "-eva-partition-history"]

# Subjects: sources besides the driver, Eva's options, and the page's texts on functions, ranges and omissions.
SUBJECTS = {
    "fixed": (
        ["runtime/core/fixed.c"], ["-eva-precision", "4", "-eva-slevel", "400"],
        "all of `fixed.h`: rounding, scaling, products, quotients, clamps, highest bits, square root, log2, exp2",
        "all numbers that a function's `T3R_BOUND` allows",
        "`t3r_round_div64()`: between two powers of two the "
        "numerator stays within the bound of the larger divisor. `t3r_scale32()`: the shift -2^31. Clamps: the lower "
        "limit is at most 0, the upper at least 0."),
    "divisor": (
        ["runtime/core/fixed.c"], ["-eva-precision", "4", "-eva-slevel", "200"],
        "`t3r_divisor_of()`, `t3r_divide_q24()`, `t3r_log2_inline_q16()`, `t3r_exp2_of_q10()`",
        "divisors 1 to 2^30, numerators below 2^32, limits 0 to 16; the functions' whole domains",
        "that the quotient is right: tests compare it with division"),
    "plan": (
        ["runtime/layout/arena.c", "runtime/core/config.c"],
        ["-eva-precision", "1", "-eva-auto-loop-unroll", "64", "-eva-min-loop-unroll", "30", UNSIGNED],
        "`t3r_lay_out()` for an arena of 0 bytes, `t3r_most_arena_bytes()`",
        "each field that a size depends on, over its range in `config.c`; unsigned overflow is an alarm, too",
        "`t3r_config_check()`, and offsets in an arena of a given size"),
    "weights": (
        ["runtime/head/weights.c"], ["-eva-precision", "4", "-eva-slevel", "50"],
        "`t3r_weights_check()`", "any bytes of any length up to 95",
        "the table of layers and blocks: `blocks` has it for two networks"),
    "blocks": (
        ["runtime/head/weights.c"],
        ["-eva-precision", "1", "-eva-auto-loop-unroll", "128", "-eva-slevel", "20", "-eva-split-return-function", "in_file:1"],
        "`t3r_weights_check()`",
        "two networks of three layers, every kind among them, of 8 and 16 bits, in a file of 1,600 bytes: offsets of blocks, "
        "multipliers, weights and all other bytes are any",
        "tables of other shapes, see below"),
    "double": (
        ["platform/messages/fixed_double.c"], ["-eva-precision", "2", "-eva-slevel", "4000"],
        "`t3r_fixed_from_double()`, `t3r_fixed_from_float()`",
        "all doubles to the fractions of a camera and of depth, all floats to that of depth",
        "other fractions; that the numbers are right: tests compare them"),
    "messages": (
        [f"platform/{name}.c" for name in ("messages/ros_messages", "messages/cdr", "host/text", "messages/message_frame",
                                           "messages/fixed_camera", "recording/pixel_layout")],
        ["-eva-precision", "4", "-eva-slevel", "20000", "-eva-auto-loop-unroll", "64", *APART, "2",
         "-eva-use-spec", "t3r_fixed_from_double"],
        "what `t3r_frame_reader` reads of a message: head of an image, CameraInfo, poses, and what `message_frame.c` makes of "
        "their numbers",
        "any bytes in either byte order, cut at many places; texts of 0 to 7 bytes, or longer than the message; 0, 5 or too "
        "many coefficients",
        "texts of other lengths, as Eva has to know where a field stands"),
    "reader": (
        [f"platform/{name}.c" for name in ("mcap/mcap_records", "messages/ros_messages", "messages/ros_schemas", "messages/cdr",
                                           "messages/message_frame", "messages/fixed_camera", "host/text", "host/fixed_text",
                                           "recording/pixel_layout")],
        ["-eva-precision", "3", "-eva-slevel", "5000", "-eva-auto-loop-unroll", "64", "-eva-min-loop-unroll", "20", *APART, "2",
         "-eva-use-spec", "t3r_fixed_from_float"],
        "of `t3r_frame_reader`: opening, a record's head, entering a chunk, schemas, stamps, `t3r_frame_reader_rows()`, "
        "`t3r_message_to_z16()`",
        "any bytes at any place; up to 6 rows of images of any height and a few steps and widths, into buffers of 64 bytes",
        "sequences of calls, channels and metadata, and that it asks the source only for bytes that this has: see below"),
    "pose": (
        ["runtime/core/scene_frame.c", "runtime/core/fixed.c"],
        ["-eva-precision", "2", "-eva-slevel", "100", "-eva-auto-loop-unroll", "64", "-eva-domains",
         "equality,symbolic-locations", "-eva-equality-through-calls", "all", *APART, "2"],
        "`t3r_pose_in_scene()`", "each position, origin and exponent that `t3r_attach()` lets through",
        "`t3r_camera_rotation()`: its sums hold by the norm of a rotation, which Eva does not follow"),
    "attach": (
        [f"runtime/{name}.c" for name in (
            "api/open", "api/restored", "api/checks", "layout/arena", "core/config", "core/camera", "core/fixed", "state/views",
            "state/reuse", "budget/cluster_texture")],
        ["-eva-precision", "2", "-eva-slevel", "200", "-eva-auto-loop-unroll", "30", "-eva-min-loop-unroll", "0", *APART, "8",
         "-eva-use-spec", "t3r_pose_in_scene"],
        "`t3r_attach()`",
        "any bytes of a state and its planes, behind a sound configuration: two views of 8x8, with sensor depth, `warm`, stereo "
        "or as a stream",
        "other configurations; what later calls make of an arena that was taken: `fuzz_arena` tries them"),
}
# A check removed from a subject's source: its text, the replacement, and the words of Eva's alarm.
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
# Planted errors, and the words of Eva's alarm.
PLANTED = {
    "overflow": "signed overflow",
    "shift": "invalid RHS operand for shift",
    "zero": "division by zero",
    "index": "out of bounds index",
    "bound": "t3r_bound_broken",
    "unsigned": "unsigned overflow",
    "endless": "never returns",
}
TEXT = """# Proofs by Frama-C

Made by `tests/proofs/frama.py --write` with Frama-C {version}. Its plugin Eva follows every value that an
argument may have. It reports what it cannot exclude: overflow, a shift by too much, division by zero, an index out of
bounds, memory that holds no value. Overflow of unsigned numbers is an alarm in `plan` alone, as other code wraps on
purpose. Each subject has a driver in [tests/proofs/frama](../../tests/proofs/frama). The proof is of the C code on x86-64;
compilers are not in it.

`T3R_BOUND` is proven wherever it stands: an argument that it forbids is an alarm. The drivers call functions with
arguments that meet it, so for them it is a precondition. A loop stands for `__builtin_clz()`.

| subject | functions | ranges | seconds | alarms | what is left out |
|---|---|---|---:|---:|---|
{rows}

## Results

At night `tests/proofs/wp.py` has WP prove what results are, with Z3 by way of Why3, by the contracts of
[contracts.h](../../tests/proofs/frama/contracts.h): both rounding shifts, `t3r_round_div32()`, clamps and sizes. They are for
all arguments that `T3R_BOUND` allows.

The contract of `t3r_round_div64()` is left out. Z3 does not end within 20 s: with the two lemmas by which it proves the
division of 32 bits, without casts in the model, or with its two inequalities apart. Tests compare it with doubles and at its
ends.

## Checks left out

`double`, `messages`, `weights`, `blocks`, `reader`, `pose` and `attach` are run a second time at night, each with one check
left out of the source. Eva has to find it. A real fault showed when `attach` was made: an arena whose configuration had no
number of SuperClusters was taken, and the next analysis read past its buffers. It is mended.

## What stays open

- **Tables of weights with any shape.** Eva runs for more than ten minutes on any 16 MiB and gives false alarms. It looks at
  a layer's sources and level in a copy of the layer, and they are read anew from the file when the layers are counted. Where
  a weight lies is a product of two numbers from the file, and Eva bounds each alone. WP with contracts of `block_fault()` and
  `sum_fits()` proves 156 of 167 goals. Most of the others hold such a product, and Z3 does not prove them in 10 s.
  Three ways do not help: an invariant of the index, a lemma of products, each side of a kernel as a case of its own.
- **`t3r_frame_reader` as a whole.** The place of the next record is at most the end of its chunk, and that is at most the
  end of the source. Eva keeps a range for each, but not which is the larger. So after the second record it cannot tell
  whether the source has the bytes. `fuzz_frame_reader` ends where it asks for others. In messages it has to know the length
  of each text: with a range, the end of one field and the start of the next are no longer the same number.
- **`t3r_attach()` with any configuration.** The layout follows from the configuration by sums, and Eva needs each offset.
- **`t3r_camera_rotation()`.** Products of four numbers whose squares have a bounded sum: Eva bounds each product alone.

Not proven at all: other results, `t3r_plan()` beyond its sizes, and the stages of the pipeline. Tests, fuzzers and a build
with `T3R_CHECK_FIXED` look for faults there.
"""


def eva(driver, sources, options, beside=()):
    """Returns a driver's findings: alarms, and functions that never return, because Eva does not look at the code
    after them. Headers are also searched for in the folders `beside`."""
    folders = " ".join(f"-I {folder}" for folder in (*beside, proof.RUNTIME / "include", proof.RUNTIME,
                                                     proof.ROOT / "platform"))
    includes = f"-std=c11 {folders} -include {DRIVERS / 'frama.h'}"
    result = proof.run(["frama-c", "-no-unicode", "-machdep", "gcc_x86_64", "-c11", f"-cpp-extra-args={includes}", "-eva",
                        "-warn-signed-overflow", *options, driver, *(proof.ROOT / source for source in sources)])
    if result.returncode != 0 or "ANALYSIS SUMMARY" not in result.stdout:
        proof.broken(f"Frama-C does not read {driver}", (result.stdout + result.stderr).splitlines())
    found = [re.sub(r"\s+", " ", text) for text in re.findall(r"^\[eva:alarm\] .*(?:\n  .*)*", result.stdout, flags=re.M)]
    return found + [f"{name} never returns" for name in
                    re.findall(r"Values at end of function (\w+):\n\s*NON TERMINATING FUNCTION", result.stdout)]


def seconds_of(subject):
    """Returns Eva's seconds for the subject, which must have no alarm."""
    sources, options = SUBJECTS[subject][:2]
    before = time.monotonic()
    found = eva(DRIVERS / f"{subject}.c", sources, options)
    proof.verdict(f"no alarm in tests/proofs/frama/{subject}.c", found)
    return time.monotonic() - before


def must_find_left_out(subject):
    """Checks that Eva raises an alarm when the check is removed from a copy of the subject's source."""
    changed, says, instead, words = LEFT_OUT[subject]
    sources, options = SUBJECTS[subject][:2]
    text = (proof.ROOT / changed).read_text()
    if text.count(says) != 1:
        proof.broken(f"{changed} does not say '{says}' once")
    with proof.scratch() as folder:
        copy = folder / pathlib.Path(changed).name
        copy.write_text(text.replace(says, instead))
        found = eva(DRIVERS / f"{subject}.c", [copy if source == changed else source for source in sources], options,
                    [folder, (proof.ROOT / changed).parent])
        proof.must_find(found, words, f"{changed} without '{says.strip()}'")


def row(subject, seconds):
    functions, ranges, left_out = SUBJECTS[subject][2:]
    return f"| {subject} | {functions} | {ranges} | {seconds} | 0 | {left_out} |"


def unlisted(subjects, page):
    """Returns the subjects whose row is missing on the page; seconds may differ."""
    return [subject for subject in subjects if not re.search(re.escape(row(subject, "@")).replace("@", r"[\d.]+"), page)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write docs/study/proofs.md")
    parser.add_argument("subjects", nargs="*", help=", ".join(SUBJECTS))
    options = parser.parse_args()
    if options.write and options.subjects:
        parser.error("the page has all subjects")
    if shutil.which("frama-c") is None:
        print("SKIPPED: no frama-c here (tools/setup --tests)")
        sys.exit(77)
    for name, words in PLANTED.items():
        flags = [UNSIGNED] if name == "unsigned" else []
        proof.must_find(eva(proof.PLANTED / "frama" / f"{name}.c", [], flags), words, f"{name}.c")
    for subject in () if options.subjects else LEFT_OUT:
        must_find_left_out(subject)
    seconds = {subject: seconds_of(subject) for subject in options.subjects or SUBJECTS}
    if unlisted(["plan"], "") != ["plan"]:
        proof.broken("blind: a subject that the page lacks is not noticed")
    if options.write:
        version = proof.run(["frama-c", "-version"]).stdout.strip()
        rows = "\n".join(row(subject, f"{taken:.1f}") for subject, taken in seconds.items())
        PAGE.write_text(TEXT.format(version=version, rows=rows))
    proof.verdict("docs/study/proofs.md says the same", unlisted(seconds, PAGE.read_text()))


if __name__ == "__main__":
    main()
