#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""streams.py LIBRARY TRIM3R: a stream's map and reports equal those of `trim3r replay --stream`; it is stopped, refused,
drawn and read in between, and goes on from its state in another process."""
import dataclasses
import json
import pathlib
import sys
import tempfile
import zlib

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


# Goes on from a state with the frames from the fourth on; prints hashes and report, and saves the map's bytes.
LATER = """
import sys
sys.path[:0] = [sys.argv[1]]
import trim3r
with trim3r.Stream({side}, {side}, {most}, head="tiny", workers=2) as stream:
    stream.load_state(sys.argv[2])
    for frame in trim3r.room({frames}, {side}, {side})[4:]:
        stream.keyframe(frame)
    open(sys.argv[3], "wb").write(stream.scene.gaussians.tobytes())
    print(stream.stage_hashes, stream.report)
"""


def rewritten(state, at, value):
    """Returns the bytes of a state with some of them changed, and a CRC that agrees."""
    body = state[:at] + value + state[at + len(value):-4]
    return body + zlib.crc32(body).to_bytes(4, sys.byteorder)


def check_continued(folder):
    """Goes on from a state: in a new process, and in a stream with a map of its own."""
    path, ended = folder / "map.state", folder / "map.bytes"
    made, reports = followed(FRAMES[:4], workers=2)
    image = made.render(FRAMES[3].camera)
    made.save_state(path)
    state = path.read_bytes()
    check(len(state) > made.arena_bytes and list(folder.glob("map.*")) == [path], "one whole file")
    for frame in FRAMES[4:]:
        made.keyframe(frame)
    script = LATER.format(side=SIDE, most=MOST, frames=len(FRAMES))
    said = run(sys.executable, "-B", "-c", script, pathlib.Path(sys.argv[1]).resolve().parent.parent, path, ended).stdout
    check(said.strip() == f"{made.stage_hashes} {made.report}", f"{said}, not {made.stage_hashes} {made.report}")
    check(ended.read_bytes() == made.scene.gaussians.tobytes(), "another map after going on")

    other, _ = followed(FRAMES[5:7], workers=2)
    scene = other.scene
    other.load_state(path)
    check(other.report == reports[-1] and other.keyframes == 4 and other.stage_hashes == {}, f"{other.report}")
    check(np.array_equal(other.render(FRAMES[3].camera), image), "drawn as before")
    with refused(trim3r.StateError, "copy()"):
        scene.positions.sum()
    with stream(workers=2) as unused: # nothing yet
        unused.save_state(path)
        other.load_state(path)
    check(other.keyframes == 0 and other.report is None and other.keyframe(FRAMES[0]) == reports[0], "begun anew")
    check_other_states(folder, state, reports)


def check_other_states(folder, state, reports):
    """Refuses states that do not fit, or are damaged; the stream is as before."""
    path = folder / "wrong.state"
    wrong = {"not the state of a stream": (b"", b"ply\n", b"T3RSTREA", state[8:]),
             "another version": (rewritten(state, 8, b"\0\1\2\3"),),
             "damaged or cut off": (state[:-1], state[:len(state) // 2], state[:40], state + b"\0",
                                    state[:-100] + b"\1" + state[-99:]),
             "arena holds no runtime": (rewritten(state, len(state) - 4 - stream(workers=2).arena_bytes, bytes(64)),)}
    made, (report,) = followed(FRAMES[:1], workers=2)
    kept = made.snapshot().gaussians.tobytes()
    for words, files in wrong.items():
        for file in files:
            path.write_bytes(file)
            with refused(trim3r.InputError, "wrong.state: ", words):
                made.load_state(path)
    path.write_bytes(state)
    room = made.arena_bytes # the same for both, so that only the number of workers differs
    for options, words in (({}, "workers is 2 in the state, not 1"), ({"arena_bytes": room}, "workers is 2"),
                           ({"workers": 2, "head": "small"}, "another head"), ({"workers": 2, "most": 500}, "gaussians is 600"),
                           ({"workers": 2, "views": 2}, "views is 4"), ({"workers": 2, "settings": {"gate": 0}}, "gate is 1")):
        with stream(**options) as other, refused(trim3r.InputError, words):
            other.load_state(path)
    with refused(FileNotFoundError, "nowhere"):
        made.load_state(folder / "nowhere")
    with refused(IsADirectoryError):
        made.load_state(folder)
    with refused(FileNotFoundError, "at.state"):
        made.save_state(folder / "nowhere" / "at.state")
    for call in (made.save_state, made.load_state):
        with refused(ValueError, "null byte"):
            call(f"{folder}/a\0b")
    check(made.report == report and made.snapshot().gaussians.tobytes() == kept, "the stream is as before")
    check([made.keyframe(frame) for frame in FRAMES[1:3]] == reports[1:3], "goes on")
    made.close()
    for call in (made.save_state, made.load_state):
        with refused(trim3r.StateError, "closed"):
            call(path)


def main():
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        check_program(pathlib.Path(folder))
        check_continued(pathlib.Path(folder))
    check_between()
    check_refusals()
    check_stopping()
    done()


if __name__ == "__main__":
    main()
