#!/usr/bin/env python3
"""frama.py: Eva, of Frama-C, finds no alarm in a driver of tests/proofs/frama, a subject each.

    frama.py                 the subjects that docs/study/proofs.md lists
    frama.py fixed plan      these
    frama.py --write         all, and writes that page
"""
import argparse
import re
import shutil
import sys
import time

import proof

DRIVERS = proof.HERE / "frama"
PAGE = proof.ROOT / "docs" / "study" / "proofs.md"
UNSIGNED = "-warn-unsigned-overflow"

# A subject: sources beside the driver, options of Eva, what the page says of functions, ranges, and what is left out.
SUBJECTS = {
    "fixed": (
        ["core/fixed.c"], ["-eva-precision", "4", "-eva-slevel", "400"],
        "all of `fixed.h`: rounding, scaling, products, quotients, clamps, highest bits, square root, log2, exp2",
        "all numbers that a function's `T3R_BOUND` allows",
        "`t3r_round_div64()`: between two powers of two the "
        "numerator stays within the bound of the larger divisor. `t3r_scale32()`: the shift -2^31. Clamps: the lower "
        "limit is at most 0, the upper at least 0."),
    "divisor": (
        ["core/fixed.c"], ["-eva-precision", "4", "-eva-slevel", "200"],
        "`t3r_divisor_of()`, `t3r_divide_q24()`, `t3r_log2_inline_q16()`, `t3r_exp2_of_q10()`",
        "divisors 1 to 2^30, numerators below 2^32, limits 0 to 16; the functions' whole domains",
        "that the quotient is right: tests compare it with division"),
    "plan": (
        ["layout/arena.c", "core/config.c"],
        ["-eva-precision", "1", "-eva-auto-loop-unroll", "64", "-eva-min-loop-unroll", "30", UNSIGNED],
        "`t3r_lay_out()` for an arena of 0 bytes, `t3r_most_arena_bytes()`",
        "each field that a size depends on, over its range in `config.c`; unsigned overflow is an alarm, too",
        "`t3r_config_check()`, and offsets in an arena of a given size"),
    "weights": (
        ["head/weights.c"], ["-eva-precision", "4", "-eva-slevel", "50"],
        "`t3r_weights_check()`", "any bytes of any length up to 95",
        "the table of layers and blocks: Eva loses the bound of an offset between two functions. Fuzzers try them."),
}
# What must be found, and by which words of Eva.
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

Not proven at all: other results, `t3r_plan()` beyond its sizes, `t3r_attach()`, `t3r_frame_reader` and the stages of
the pipeline. Tests, fuzzers and a build with `T3R_CHECK_FIXED` look for faults there.
"""


def eva(driver, sources, options):
    """The findings in a driver: alarms, and functions that never return, as nothing behind them is looked at."""
    includes = f"-std=c11 -I {proof.RUNTIME / 'include'} -I {proof.RUNTIME} -include {DRIVERS / 'frama.h'}"
    result = proof.run(["frama-c", "-no-unicode", "-machdep", "gcc_x86_64", "-c11", f"-cpp-extra-args={includes}", "-eva",
                        "-warn-signed-overflow", *options, driver, *(proof.RUNTIME / source for source in sources)])
    if result.returncode != 0 or "ANALYSIS SUMMARY" not in result.stdout:
        proof.broken(f"Frama-C does not read {driver}", (result.stdout + result.stderr).splitlines())
    found = [re.sub(r"\s+", " ", text) for text in re.findall(r"^\[eva:alarm\] .*(?:\n  .*)*", result.stdout, flags=re.M)]
    return found + [f"{name} never returns" for name in
                    re.findall(r"Values at end of function (\w+):\n\s*NON TERMINATING FUNCTION", result.stdout)]


def seconds_of(subject):
    """How long Eva took for the subject, which has no alarm."""
    sources, options = SUBJECTS[subject][:2]
    before = time.monotonic()
    found = eva(DRIVERS / f"{subject}.c", sources, options)
    proof.verdict(f"no alarm in tests/proofs/frama/{subject}.c", found)
    return time.monotonic() - before


def row(subject, seconds):
    functions, ranges, left_out = SUBJECTS[subject][2:]
    return f"| {subject} | {functions} | {ranges} | {seconds} | 0 | {left_out} |"


def unlisted(subjects, page):
    """Those whose row the page lacks; seconds may differ."""
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
