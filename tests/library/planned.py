#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""planned.py TRIM3R LIBRARY: a header by `plan --header` has the bytes and the settings of a firmware's runtime, for each
kind of configuration; of another version it does not compile."""
import pathlib
import sys
import tempfile

from library import ROOT, WARNINGS, ended

from checks import check, done

TRIM3R, LIBRARY = sys.argv[1:3]
PROGRAM = r"""
#include "planned.h"
static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_PLANNED_BYTES];
int main(void)
{
    const t3r_config config = t3r_planned_config();
    t3r_plan_info plan;
    t3r_runtime *runtime;
    if (t3r_plan(&config, &plan) != T3R_OK || plan.bytes != sizeof arena || plan.min_bytes != T3R_PLANNED_MIN_BYTES) {
        return 1;
    }
    return t3r_init(&runtime, arena, sizeof arena, &config) != T3R_OK ? 2
           : t3r_init(&runtime, arena, T3R_PLANNED_MIN_BYTES, &config) != T3R_OK ? 3
           : t3r_init(&runtime, arena, T3R_PLANNED_MIN_BYTES - 1, &config) != T3R_ERR_ARENA;
}
"""
KINDS = (  # options, lines of the settings
    ("--gaussians 900", ()),
    ("--gaussians 900 --head analytic --refine 0", ("config.refine = 0;", "config.head_column_bytes = 0;")),
    ("--gaussians 900 --head tiny", ("config.head = T3R_HEAD_LEARNED;", "the weights of tiny")),
    ("--keep 10% --preset fast", ()),
    ("--keep 10% --preset best", ()),
    ("--gaussians 900 --keep-analysis --wavelet haar --gamma 0.5", ("config.keep_analysis = 1;", "config.gamma_q8 = 128;",
                                                                    "config.wavelet = T3R_WAVELET_HAAR;")),
    ("--gaussians 900 --depth stereo --views 3", ("config.depth = T3R_DEPTH_STEREO;",)),
    ("--gaussians 900 --stream --views 4 --remember 5 --half-life 0", ("config.stream = 1;", "config.remember = 5;",
                                                                       "config.half_life = 0;")),
    ("--gaussians 900 --allocate paper --clusters 64 --threads 3 --render 200x100",
     ("config.allocate = T3R_ALLOCATE_PAPER;", "config.render_width = 200;", "config.workers = 3;")),
    ("--gaussians 900 --views 0", ()),
)


def compiled(folder):
    return ended("gcc", "-std=c11", *WARNINGS, "-I", ROOT / "runtime" / "include", "-I", folder, folder / "user.c", LIBRARY,
                 "-o", folder / "user")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "user.c").write_text(PROGRAM)
        header = folder / "planned.h"
        for options, lines in KINDS:
            made = ended(TRIM3R, "plan", "--size", "96x96", *options.split(), "--header", header)
            check(made.returncode == 0, f"{options}: {made.stderr}")
            text = header.read_text()
            check(all(line in text for line in lines), f"{options}: {text}")
            built = compiled(folder)
            check(built.returncode == 0, f"{options}: {built.stderr}")
            ran = ended(folder / "user")
            check(ran.returncode == 0, f"{options}: {ran.returncode}\n{text}")
        header.write_text(text.replace("T3R_BITS_EPOCH != ", "T3R_BITS_EPOCH != 9"))
        check("make it again" in compiled(folder).stderr, "of another bits epoch")
        listed = ended(TRIM3R, "plan", "--arena", "2M", "--header", header)
        check(listed.returncode == 2 and "--header belongs to one arena" in listed.stderr, listed.stderr)
        builds = ended(TRIM3R, "plan", "--size", "96x96", "--gaussians", "900", "--remember", "5")
        check(builds.returncode == 2 and "--remember belongs to --stream" in builds.stderr, builds.stderr)
    done()


main()
