#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""streams.py LIBRARY TRIM3R: a stream's map and reports equal those of `trim3r replay --stream`; it is stopped, refused,
drawn and read in between."""
import dataclasses
import json
import pathlib
import sys
import tempfile

from common import SIDE, check, np, refused, small, trim3r

from checks import done, near, run

FRAMES = trim3r.room(8, SIDE, SIDE)
MOST = 600
# the program's names, with the sizes of its steps
SHARES = ("depth", "dark", "bright", "detail", "contradicted", "likeness", "in_view", "hidden", "hidden_likeness", "exposure")
COUNTS = ("gaussians", "added", "removed", "crowded", "points", "shown", "moved", "realigned", "compared", "recent")


def stream(most=MOST, **options):
    return trim3r.Stream(SIDE, SIDE, most, **{"head": "tiny", **options})


def followed(frames, **options):
    made = stream(**options)
    return made, [made.keyframe(frame) for frame in frames]


def check_program(folder):
    """Compares every report and every byte of the map."""
    recording, lines, ours = folder / "room.mcap", folder / "lines.jsonl", folder / "ours.ply"
    run(sys.argv[2], "room", "--size", f"{SIDE}x{SIDE}", "--frames", len(FRAMES), "-o", recording)
    run(sys.argv[2], "replay", recording, "--stream", "--every", "1", "--gaussians", MOST, "--head", "tiny", "--lines", lines,
        "-o", folder / "theirs.ply")
    made, reports = followed(trim3r.Recording(recording))
    rows = [json.loads(line) for line in lines.read_text().splitlines()]
    check(len(rows) == len(reports) == len(FRAMES), f"{len(rows)} rows")
    for row, report in zip(rows, reports):
        check(report.taken and row["decision"] == "taken" and row["keyframe"] == report.keyframes, f"{report}")
        check(all(row[name] == getattr(report, name) for name in COUNTS), f"{report}, not {row}")
        check(all(row[f"{name}_q8"] == getattr(report, name) * 256 for name in SHARES), f"{report}, not {row}")
    made.snapshot().save(ours)
    check(ours.read_bytes() == (folder / "theirs.ply").read_bytes(), "the map")


def check_between():
    """Draws and reads the map between keyframes, which changes nothing."""
    plain, reports = followed(FRAMES, workers=2)
    with stream(render_size=(2 * SIDE, 2 * SIDE)) as made:
        with refused(trim3r.StateError):
            made.overlap(FRAMES[0].camera)
        with refused(trim3r.StateError):
            made.snapshot()
        for count, (frame, report) in enumerate(zip(FRAMES, reports), 1):
            check(made.keyframe(frame) == report and made.keyframes == count, f"the same as without pictures: {report}")
            near(made.overlap(frame.camera), 1, 0.05, "the newest keyframe covers itself")
            image = made.render(frame.camera)
            check(trim3r.psnr(frame.colour, image) > 18, f"{trim3r.psnr(frame.colour, image)} dB")
            wide = made.picture(frame.camera.resized(2 * SIDE, 2 * SIDE), (2 * SIDE, 2 * SIDE))
            check(wide.alpha.mean() > 0.8, f"{wide}")
        scene, kept = made.scene, made.snapshot()
        check(np.shares_memory(scene.gaussians, made._arena) and len(scene) == reports[-1].gaussians <= MOST, f"{scene}")
        check(made.overlap(FRAMES[0].camera) < made.overlap(FRAMES[-1].camera), "less of what is left behind")
        made.keyframe(FRAMES[0])
        with refused(trim3r.StateError, "copy()"):
            scene.positions.sum()
        check(kept.gaussians.tobytes() == plain.scene.gaussians.tobytes(), "a snapshot stays")
        made.reset()
        check(made.keyframes == 0 and made.report is None and made.keyframe(FRAMES[0]) == reports[0], "begun anew")
        with small(0, gaussians=MOST) as drawn:
            drawn.load(kept)
            check(np.array_equal(drawn.render(FRAMES[3].camera), plain.render(FRAMES[3].camera)), "a snapshot drawn elsewhere")
    with refused(trim3r.StateError, "the stream is closed"):
        made.keyframe(FRAMES[0])


def check_refusals():
    """The gate refuses a dark frame and one without depth; the map is as before. Without the gate they are errors or taken."""
    dark = dataclasses.replace(FRAMES[2], colour=np.zeros_like(FRAMES[2].colour))
    blind = dataclasses.replace(FRAMES[2], depth=np.zeros_like(FRAMES[2].depth))
    made, (_, before) = followed(FRAMES[:2])
    wanted = made.snapshot().gaussians.tobytes()
    for frame, reason in ((dark, "dark"), (blind, "no depth")):
        report = made.keyframe(frame)
        check((report.refusal, report.taken, report.added) == (reason, False, 0) and made.report == report, f"{report}")
        check(report.keyframes == made.keyframes == 2 and report.gaussians == before.gaussians, f"{report}")
    check(made.snapshot().gaussians.tobytes() == wanted, "the map is unchanged")
    open_made, _ = followed(FRAMES[:2], settings={"gate": 0})
    check(open_made.keyframe(dark).taken, "taken without the gate")
    with refused(trim3r.DepthError):
        open_made.keyframe(blind)
    for frame, word in ((dataclasses.replace(FRAMES[0], camera=None), "no camera"),
                        (dataclasses.replace(FRAMES[0], colour=FRAMES[0].colour[:, ::2]), "row")):
        with refused(ValueError, word):
            made.keyframe(frame)
    with refused(ValueError, "stereo"):
        stream(settings={"depth": "stereo"})


def check_stopping():
    """An exception in progress stops a keyframe at any place: the map stays valid, and later keyframes are taken."""
    stages, stop = set(), []

    def progress(stage, finished, total):
        stages.add(stage)
        if stage in stop:
            raise trim3r.Cancelled(f"enough of {stage}")

    with stream(progress=progress, workers=2) as made:
        made.keyframe(FRAMES[0])
        made.keyframe(FRAMES[1])
        check("refine" in stages and len(stages) > 2, f"{stages}")
        for stage in sorted(stages):
            stop[:] = [stage]
            before = made.keyframes
            with refused(trim3r.Cancelled, f"enough of {stage}"):
                made.keyframe(FRAMES[2])
            check(made.keyframes == before + (stage == "refine"), f"stopped in {stage}: {made.keyframes} keyframes")
            check(made.report.keyframes == made.keyframes and made.report.taken, f"stopped in {stage}: {made.report}")
            stop.clear()
            check(0 < len(made.scene) <= MOST and made.render(FRAMES[1].camera).any(), f"drawn after a stop in {stage}")
        check(made.keyframe(FRAMES[3]).taken, "goes on")


def main():
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        check_program(pathlib.Path(folder))
    check_between()
    check_refusals()
    check_stopping()
    done()


if __name__ == "__main__":
    main()
