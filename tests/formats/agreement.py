#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""agreement.py TRIM3R [PACKAGES]: the numbers of scene files of all kinds are the same for trim3r and for others.

Each kind of scene is converted to each format, and read back by trim3r and by this script, which knows .ply, .splat and
.glb. Files of this script's own are read, too. With PACKAGES, a folder with the packages of tools/study/formats, the
others are also PlayCanvas's splat-transform, three.js and the reference code of .spz, as readers and as writers. It prints
the largest differences, in units of what the format's steps allow."""
import dataclasses
import json
import math
import os
import subprocess
import sys
import tempfile

from checks import check, done, run
from splat_rows import (ZERO, Steps, declare_axes, far_away, helix, largest_differences, moved, read_glb, read_ply, read_splat, write_ply,
                        write_spz)

TRIM3R = os.path.abspath(sys.argv[1])
PACKAGES = os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else None
SPZ_COLOUR = 0.5 / 0.15 * ZERO
STEPS = {  # half a step, and a tenth of it for the arithmetic of others
    ".ply": Steps(),
    ".compressed.ply": Steps(position=1.2e-3, shape=6e-3, opacity=2.2e-3, colour=4.4e-3, harmonics=0.0172, coefficients=4),
    ".splat": Steps(shape=0.04, opacity=2.2e-3, colour=2.2e-3, colours=(0, 1), degree=0),
    ".spz": Steps(position=1.35e-4, shape=0.08, opacity=2.2e-3, colour=4.1e-3, harmonics=0.0688,
                  colours=(0.5 - SPZ_COLOUR, 0.5 + SPZ_COLOUR), coefficients=127 / 128),
    ".glb": Steps(shape=7e-5, opacity=1e-5),
    ".sog": Steps(position=1.5e-4, shape=0.04, opacity=2.2e-3, colour=4e-3, harmonics=0.015),
}
HOLDS_ORIGIN = (".ply", ".glb")
HOLDS_MIP = (".ply", ".compressed.ply", ".spz", ".sog")
KEEPS_FAR = (".ply", ".splat", ".glb")
COLOURS = {".splat": (0, 1), ".spz": (0.5 - 0.5 * ZERO / 0.15, 0.5 + 0.5 * ZERO / 0.15)}
WIDTHS = {".spz": (-10, -10 + 255 / 16), ".compressed.ply": (-20, 20)}  # logarithms
CUT_OFF = {".compressed.ply": 4, ".spz": 1}  # the largest coefficients
MIP = "SplatRenderMode: mip"
failures = []
SURVEY = (500000.25, 4649776.5, 120.125)  # metres of a map's projection


@dataclasses.dataclass
class Kind:
    name: str
    path: str
    rows: list
    steps: Steps = dataclasses.field(default_factory=Steps)  # of the file itself
    coefficients: float = 1.0
    mip: bool = False
    far: int = 0  # rows at the end that some formats leave out
    survey: bool = False


def kinds():
    """Writes a file of each kind."""
    made = []

    def ply(name, rows, mip=False, far=0, survey=False, coefficients=1.0, **how):
        path = name.replace(" ", "_") + ".source.ply"
        write_ply(path, rows, **how)
        written = [dataclasses.replace(row, log_scale=[*row.log_scale[:2], -math.inf]) for row in rows] if "without" in how else rows
        made.append(Kind(name, path, written, coefficients=coefficients, mip=mip, far=far, survey=survey))

    for degree in range(4):
        ply(f"degree {degree}", helix(degree))
    ply("far", helix(1) + far_away(1), far=3)
    ply("mip", helix(1), mip=True, comments=[MIP])
    ply("postshot", helix(1), mip=True, comments=["antialiased 1"])
    ply("beyond", helix(2, coefficients=12, colours=(-0.3, 1.4)), coefficients=12)
    ply("text", helix(1), encoding="ascii")
    ply("big-endian", helix(1), encoding="binary_big_endian")
    ply("doubles", helix(1), kind="double")
    ply("flat", helix(1), without=("scale_2",))
    ply("survey", moved(helix(1), SURVEY), survey=True, kind="double")
    loose = {1: Steps(position=1e-3, shape=0.16, opacity=2.2e-3, colour=4.1e-3)}
    loose[2] = dataclasses.replace(loose[1], position=1.35e-4)
    loose[3] = dataclasses.replace(loose[2], shape=0.08)
    for version, steps in loose.items():
        for packed in (True, False):
            path = f"version_{version}{'' if packed else '_bare'}.source.spz"
            write_spz(path, helix(0), version, packed, mip=version == 2)
            made.append(Kind(f"spz {version}{'' if packed else ' bare'}", path, helix(0), steps, mip=version == 2))
    return made


def steps_of(kind, ending):
    """Returns the steps of a file that was made of the kind's file. A .sog shares its steps out over the coefficients."""
    a, b = kind.steps, STEPS[ending]
    both = {name: getattr(a, name) + getattr(b, name) for name in ("position", "shape", "opacity", "colour", "harmonics")}
    both["harmonics"] *= kind.coefficients if ending == ".sog" else 1
    return dataclasses.replace(b, **both)


def relative(rows):
    first = min(rows, key=lambda row: row.position[0]).position
    return moved(rows, [-each for each in first])


def compare(kind, ending, reader, found, keeps_origin=True, allowed=1):
    """Checks and prints how far a reader's rows are from those of the kind."""
    wanted = kind.rows if ending in KEEPS_FAR else kind.rows[:len(kind.rows) - kind.far]
    if kind.survey and not keeps_origin:
        wanted, found = relative(wanted), relative(found)
    try:
        most = largest_differences(wanted, found, steps_of(kind, ending))
    except AssertionError as error:
        failures.append(f"{kind.name}, {ending}, {reader}: {error}")
        return
    print(f"{kind.name:12} {ending:16} {reader:24}", *(f"{what} {share:.2f}" for what, share in most.items()))
    if max(most.values()) > allowed:
        failures.append(f"{kind.name}, {ending}, {reader}: more than the format's steps: {most}")


def check_mark(kind, ending, reader, comments):
    if (MIP in comments) != (kind.mip and ending in HOLDS_MIP):
        failures.append(f"{kind.name}, {ending}, {reader}: the mark of mip: {comments}")


def read_by_trim3r(path):
    run(TRIM3R, "convert", path, "-o", "back.ply")
    return read_ply("back.ply")


def converted(kind, ending):
    """Converts the kind's file, with a warning where the format ends below its coefficients."""
    path = f"converted{ending}"
    told = run(TRIM3R, "convert", kind.path, "-o", path).stderr
    if kind.rows[0].rest:
        largest = max(abs(each) for row in kind.rows for rgb in row.rest for each in rgb)
        check(("cut off at" in told) == (largest > CUT_OFF.get(ending, math.inf)),
              f"{kind.name}, {ending}: harmonics of up to {largest}: {told}")
    check_cuts(f"{kind.name}, {ending}", kind.rows if ending in KEEPS_FAR else kind.rows[:len(kind.rows) - kind.far], ending, told)
    return path


def check_cuts(name, rows, ending, told):
    """Checks the warnings of colours and widths that the format has no numbers for."""
    low, high = COLOURS.get(ending, (-math.inf, math.inf))
    colours = sum(min(row.colour()) < low - 1 / 510 or max(row.colour()) > high + 1 / 510 for row in rows)
    thin, wide = (math.exp(bound) for bound in WIDTHS.get(ending, (-math.inf, 700)))
    widths = [[math.exp(each) for each in row.log_scale] for row in rows]
    shapes = sum(any(each < thin - max(row) / 16 or each > wide + max(row) / 16 for each in row) for row in widths)
    for count, what in ((colours, "colours"), (shapes, "widths")):
        due = f"{count} Gaussians have {what} outside" if count > 0 else f"have {what} outside"
        check((due in told) == (count > 0), f"{name}: {count} {what} beyond: {told}")


def check_extremes():
    """Colours and widths that some formats cut off; the thickness of a disc is none of them."""
    rows = helix(0)
    for i, log_scale in enumerate(([-12] * 3, [7, -3, -3], [-3, -3, -14], [-13, -13, -7], [21, 21, 21])):
        rows[i] = dataclasses.replace(rows[i], log_scale=log_scale)
    for i, colour in enumerate(((1.2, 0, 0), (0.5, -0.3, 1), (0.2, 0.1, 1.6), (1, 0, 1), (0.4, 0.4, 0.4))):
        rows[i] = dataclasses.replace(rows[i], zero=[(each - 0.5) / ZERO for each in colour])
    write_ply("extremes.ply", rows)
    for ending in STEPS:
        check_cuts(f"extremes, {ending}", rows, ending, run(TRIM3R, "convert", "extremes.ply", "-o", f"cut{ending}").stderr)


# --- others ------------------------------------------------------------------------------------------------------------


def transform(*words):
    cli = os.path.join(PACKAGES, "node_modules", "@playcanvas", "splat-transform", "bin", "cli.mjs")
    run("node", cli, "-q", "-w", "-g", "cpu", *words)


def spz_reference(*jobs):
    told = subprocess.run(["node", os.path.join(PACKAGES, "spz_reference.mjs")], input=json.dumps(jobs), text=True,
                          capture_output=True, check=False)
    check(told.returncode == 0, f"the reference code of .spz: {told.stderr}")


def read_by_others(ending, path):
    """Yields the name, the rows and the comments of each other reader."""
    if ending == ".glb":
        run("node", os.path.join(PACKAGES, "glb_to_ply.mjs"), path, "theirs.ply")
        transform("theirs.ply", "-r", "0,0,180", "turned.ply")
        yield "three.js", *read_ply("turned.ply")
        return
    # it takes .spz to have the axes of .ply
    transform(path, *(["-r", "180,0,0"] if ending == ".spz" else []), "theirs.ply")
    yield "splat-transform", *read_ply("theirs.ply")
    if ending == ".spz":
        spz_reference({"read": path, "to": "theirs.ply"})
        yield "the reference of .spz", *read_ply("theirs.ply")


def check_written_by_transform(kind):
    for ending in STEPS:
        if ending != ".splat":  # which it does not write
            theirs = f"theirs{ending}"
            transform(kind.path, *(["-r", "180,0,0"] if ending == ".spz" else []), theirs)
            rows, comments = read_by_trim3r(theirs)
            compare(kind, ending, "from splat-transform", rows, allowed=2)  # it cuts some numbers off
            check_mark(kind, ending, "from splat-transform", comments)


def check_written_by_reference():
    """The reference code of .spz writes all degrees."""
    made = [Kind(f"degree {degree}", f"degree_{degree}.ply", helix(degree, coefficients=0.9), mip=degree % 2 == 1)
            for degree in range(5)]
    for kind in made:
        write_ply(kind.path, kind.rows)
    spz_reference(*({"write": f"{kind.path}.spz", "from": kind.path, "mip": kind.mip} for kind in made))
    for kind in made:
        rows, comments = read_by_trim3r(f"{kind.path}.spz")
        compare(kind, ".spz", "from the reference", rows)
        check_mark(kind, ".spz", "from the reference", comments)


def check_declared_axes():
    """The reference code of .spz reads all axes that an extension declares as trim3r does."""
    write_ply("plain.ply", helix(3))
    run(TRIM3R, "convert", "plain.ply", "-o", "plain.spz")
    paths = [declare_axes("plain.spz", axes) for axes in range(17)]
    spz_reference(*({"read": path, "to": f"{path}.ply"} for path in paths))
    for axes, path in enumerate(paths):
        theirs, _ = read_ply(f"{path}.ply")
        compare(Kind(f"axes {axes}", path, theirs), ".ply", "as the reference", read_by_trim3r(path)[0])


def agreement():
    own_readers = {".ply": lambda path: read_ply(path)[0], ".splat": read_splat, ".glb": read_glb}
    check_extremes()
    for kind in kinds():
        for ending in STEPS:
            path = converted(kind, ending)
            rows, comments = read_by_trim3r(path)
            compare(kind, ending, "trim3r", rows, ending in HOLDS_ORIGIN)
            check_mark(kind, ending, "trim3r", comments)
            if ending in own_readers:
                compare(kind, ending, "this script", own_readers[ending](path), ending in HOLDS_ORIGIN)
            for reader, rows, comments in read_by_others(ending, path) if PACKAGES else ():
                compare(kind, ending, reader, rows, keeps_origin=False)
                check_mark(kind, ending, reader, comments)
        if PACKAGES and (kind.name.startswith("degree") or kind.name in ("mip", "beyond")):
            check_written_by_transform(kind)
    if PACKAGES:
        check_written_by_reference()
        check_declared_axes()


with tempfile.TemporaryDirectory(prefix="trim3r-agreement-") as folder:
    os.chdir(folder)
    agreement()
    os.chdir("/")
check(not failures, "\n".join(failures))
done()
