#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""arrays.py LIBRARY TRIM3R: scenes from arrays of floats and back, with harmonics; what is wrong in an array is named. NumPy
sees scenes and pictures without copies, pickling keeps them, and a notebook shows them."""
import copy
import dataclasses
import io
import json
import pathlib
import pickle
import sys
import tempfile
import warnings
import zlib

from common import FRAMES, SIDE, check, np, refused, small, trim3r, with_views

from checks import done, near, run

COUNT = 300
RANDOM = np.random.default_rng(4)
# of each format: the steps of positions, of opacities, and of harmonics at most 1; None: it has none
FORMATS = {".ply": (1e-4, 1e-4, 1e-3), ".glb": (1e-4, 1e-4, 1e-3), ".spz": (1e-3, 5e-3, 0.14), ".splat": (1e-4, 5e-3, None)}


def arrays(degree=0):
    """Returns the arguments of from_arrays() for Gaussians in a cube."""
    rest = (degree + 1)**2 - 1
    quaternions = RANDOM.normal(size=(COUNT, 4))
    return {"positions": RANDOM.uniform(-1, 1, (COUNT, 3)) + [5, 0, 9], "scales": np.exp(RANDOM.uniform(-5, -2, (COUNT, 3))),
            "rotations": quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True),
            "colours": RANDOM.uniform(0, 1, (COUNT, 3)), "opacities": RANDOM.uniform(0.05, 0.95, COUNT),
            "harmonics": RANDOM.uniform(-0.9, 0.9, (COUNT, rest, 3)) if rest else None}


def covariances(given):
    w, x, y, z = given["rotations"].T
    turns = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                      [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                      [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]).transpose(2, 0, 1)
    factors = turns * given["scales"][:, None, :]
    return factors @ factors.transpose(0, 2, 1)


def matched(scene, given):
    """Returns for each given position the scene's Gaussian that is nearest: some formats change the order."""
    away = np.linalg.norm(scene.positions[None] - given["positions"][:, None], axis=2)
    return away.argmin(axis=1)


def check_there_and_back():
    for degree in range(4):
        given = arrays(degree)
        scene = trim3r.Scene.from_arrays(**given)
        check(np.abs(scene.positions - given["positions"]).max() < 1e-5, "positions")
        check(np.abs(scene.covariances - covariances(given)).max() < 1e-5, "scales and rotations")
        check(np.abs(scene.colours - given["colours"]).max() < 1e-4, "colours")
        check(np.abs(scene.opacities - given["opacities"]).max() < 1e-4, "opacities")
        back = scene.arrays()
        check(np.abs(covariances(back._asdict()) - covariances(given)).max() < 1e-5, "the shapes that come back")
        check(np.array_equal(back.scales, scene.scales) and np.array_equal(back.rotations, scene.rotations), "as properties")
        if degree:
            check(np.abs(scene.harmonics - given["harmonics"]).max() < 2e-4, "harmonics")
            check(np.array_equal(back.harmonics, scene.harmonics), "the harmonics that come back")
        else:
            check(scene.harmonics is back.harmonics is None, "no harmonics")
        again = trim3r.Scene.from_arrays(*back)
        check(np.abs(again.positions - scene.positions).max() < 2e-6 and (degree == 0 or np.array_equal(
            again.harmonics, scene.harmonics)), "once more")
    few = trim3r.Scene.from_arrays([[0, 0, 1], [1, 0, 1.5]], 0.1)
    check(len(few) == 2 and np.allclose(few.scales, 0.1, rtol=1e-3) and np.allclose(few.colours, 0.5, atol=1e-4), "one number")
    check((few.opacities > 0.999).all() and np.allclose(np.abs(few.rotations), [1, 0, 0, 0], atol=1e-3), "usual values")
    strided = np.zeros((2, 6), np.float32)[:, ::2]
    check(len(trim3r.Scene.from_arrays(strided + [[0, 0, 1], [1, 1, 1]], 0.1)) == 2, "any layout, any type of number")


def check_files(folder):
    """Every format is written through the program's writers, with harmonics, and `trim3r convert` reads them."""
    for degree in (0, 3):
        given = arrays(degree)
        scene = trim3r.Scene.from_arrays(**given)
        for suffix, (step, opacity_step, harmonic_step) in FORMATS.items():
            path = folder / f"scene{suffix}"
            scene.save(path)
            read = trim3r.Scene.read(path)
            order = matched(read, given)
            check(np.abs(read.positions[order] - given["positions"]).max() < step, f"{suffix}: positions")
            check(np.abs(read.opacities[order] - given["opacities"]).max() < opacity_step, f"{suffix}: opacities")
            if degree and harmonic_step:
                away = np.abs(read.harmonics[order] - given["harmonics"]).max()
                check(away < harmonic_step, f"{suffix}: harmonics {away} away")
            else:
                check(read.harmonics is None, f"{suffix}: no harmonics")
            info = json.loads(run(sys.argv[2], "convert", path, "-o", folder / "again.ply", "--json").stdout)
            check((info["gaussians"], info["degree"]) == (COUNT, degree if harmonic_step else 0), f"{suffix}: {info}")
    loud = trim3r.Scene.from_arrays(**{**arrays(1), "harmonics": np.full((COUNT, 3, 3), 3.0)})
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        loud.save(folder / "loud.spz")
    check([w.category for w in caught] == [UserWarning] and "cut off" in str(caught[0].message), f"{caught}")
    check(caught[0].filename == __file__, "the warning names the caller's line")


def check_dropped(folder):
    """A file with numbers that are not finite is refused with a remedy in Python's words."""
    trim3r.Scene.from_arrays(**arrays()).save(folder / "bad.ply")
    content = (folder / "bad.ply").read_bytes()
    start = content.index(b"end_header\n") + len(b"end_header\n")
    (folder / "bad.ply").write_bytes(content[:start] + np.float32("nan").tobytes() + content[start + 4:])
    with refused(trim3r.InputError, "bad.ply: vertex 0: x is not a finite number", "drop_invalid=True"):
        trim3r.Scene.read(folder / "bad.ply")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        check(len(trim3r.Scene.read(folder / "bad.ply", drop_invalid=True)) == COUNT - 1, "without the one")
    check(len(caught) == 1 and "1 invalid" in str(caught[0].message), f"{caught}")


def check_drawn():
    """A scene with harmonics is drawn in the colours that each camera sees: those of the formula."""
    camera = trim3r.Camera.calibrated(SIDE, SIDE, (SIDE - 1) / 2, (SIDE - 1) / 2, np.eye(4), size=(SIDE, SIDE))
    harmonics = np.zeros((1, 3, 3))
    harmonics[0, 1, 0] = 0.5 # of degree 1 along z, in red
    scene = trim3r.Scene.from_arrays([[0, 0, 4]], 0.8, harmonics=harmonics)
    behind = np.diag([-1.0, 1, -1, 1])
    behind[2, 3] = 8
    with small(0, gaussians=1) as made:
        made.load(scene)
        for eye, sign in ((camera, 1), (camera.at(behind), -1)):
            picture = made.picture(eye)
            red, green, _ = picture.colour[SIDE // 2, SIDE // 2] / (255 * picture.alpha[SIDE // 2, SIDE // 2])
            near(red, 0.5 + sign * 0.5 * 0.4886025, 0.02, "red depends on the side")
            near(green, 0.5, 0.02, "green does not")
        plain = trim3r.Scene.from_arrays(*scene.arrays()[:5])
        made.load(plain)
        check(np.array_equal(made.render(camera), made.render(camera.at(behind))), "the same from both sides")


def check_near_and_far():
    """Near detail in far surroundings is drawn from within each, with its depth; copies and pickles are drawn alike."""
    far = 6000.0
    close = [[0.1 * np.cos(i), 0.1 * np.sin(i), 2 + 0.01 * i] for i in range(12)]
    scene = trim3r.Scene.from_arrays([*close, [0, 0, far], [0, 0, -far]], [[0.05] * 3] * 12 + [[far] * 3] * 2,
                                     colours=[[1, 0, 0]] * 12 + [[0, 1, 0]] * 2)
    check(scene.depends_on_camera and len(scene.far) == 2 and scene.far["index"].tolist() == [12, 13], f"{scene.far}")
    camera = trim3r.Camera.calibrated(SIDE, SIDE, (SIDE - 1) / 2, (SIDE - 1) / 2, np.eye(4), size=(SIDE, SIDE))
    there = np.eye(4)
    there[2, 3] = -far / 2
    with small(0, gaussians=14) as made:
        for kept in (scene, scene.copy(), pickle.loads(pickle.dumps(scene)), scene.select(np.arange(14) != 13)):
            made.load(kept)
            for eye, nearer, farther in ((camera, 2.0, far), (camera.at(there), far / 2, 1.5 * far)):
                picture = made.picture(eye)
                corner, middle = (picture.colour[at, at].astype(int) for at in (2, SIDE // 2))
                check(corner[1] > 100 and corner[0] < 20, f"the surroundings: {corner}")
                check(middle[0] > 150, f"what is near: {middle}")
                near(picture.depth[SIDE // 2, SIDE // 2] / nearer, 1, 0.06, "the depth in the middle")
                near(picture.depth[2, 2] / farther, 1, 0.001, "the depth in the corner")


def check_refused():
    nan = float("nan")
    for words, change in (
            (("positions[7][2] is nan", "finite"), {"positions": (7, 2, nan)}), (("positions[0][0] is inf",), {"positions": (0, 0, 1e999)}),
            (("positions[1][1] is 1e+12", "2^30"), {"positions": (1, 1, 1e12)}),
            (("scales[3][1] is -2.3", "exp()"), {"scales": (3, 1, -2.3)}), (("scales[3][1] is nan",), {"scales": (3, 1, nan)}),
            (("colours[5][0] is 200", "divide levels of 255"), {"colours": (5, 0, 200)}),
            (("opacities[9] is 4", "1 / (1 + exp(-x))"), {"opacities": (9, 4)}), (("opacities[9] is -1",), {"opacities": (9, -1)}),
            (("rotations[2][3] is nan",), {"rotations": (2, 3, nan)}),
            (("harmonics[4][2][1] is nan",), {"harmonics": (4, 2, 1, nan)})):
        given = arrays(1)
        for name, (*place, value) in change.items():
            given[name][tuple(place)] = value
        with refused(trim3r.InputError, *words):
            trim3r.Scene.from_arrays(**given)
    given = arrays(1)
    given["rotations"][8] = 0
    with refused(trim3r.InputError, "rotations[8]", "without length"):
        trim3r.Scene.from_arrays(**given)
    for kind, words, change in (
            (ValueError, ("positions", "(N, 3)"), {"positions": np.zeros((3, 4))}), (ValueError, ("positions",), {"positions": np.zeros((0, 3))}),
            (ValueError, ("scales", f"({COUNT}, 3)", "(300,)"), {"scales": np.ones(COUNT)}),
            (ValueError, ("rotations", f"({COUNT}, 4)"), {"rotations": np.ones((COUNT, 3))}),
            (ValueError, ("colours",), {"colours": np.ones((COUNT, 4))}), (ValueError, ("uint8", "divide"), {"colours": np.ones((COUNT, 3), np.uint8)}),
            (ValueError, ("opacities",), {"opacities": np.ones((COUNT, 1))}),
            (ValueError, ("harmonics", "without degree 0"), {"harmonics": np.ones((COUNT, 4, 3))}),
            *((TypeError, (name, "real numbers"), {name: value}) for name in arrays()
              for value in ("text", True, 1j, [None], [b"1"])),
            *((TypeError, (name,), {name: None}) for name in arrays() if name != "harmonics")):
        with refused(kind, *words):
            trim3r.Scene.from_arrays(**{**arrays(), **change})
    scene = trim3r.Scene.from_arrays(**arrays(1))
    scene.harmonics_q12 = scene.harmonics_q12[:9]
    for call in (scene.arrays, lambda: scene.save("nowhere.ply")):
        with refused(ValueError, "harmonics_q12"):
            call()


def check_views():
    """np.asarray() and memoryview() of a scene and a picture are their memory."""
    with with_views() as made:
        scene = made.build(200)
        seen = np.asarray(scene)
        check(seen.dtype == trim3r.scene.GAUSSIAN and np.shares_memory(seen, made._arena) and not seen.flags.writeable, "a scene")
        check(np.array_equal(np.asarray(scene)["position_q20"], scene.gaussians["position_q20"]), "its fields")
        picture = made.picture(FRAMES[1].camera)
        check(np.shares_memory(np.asarray(picture), picture.colour) and np.asarray(picture).shape == (SIDE, SIDE, 3), "a picture")
        made.rebuild(100)
        with refused(trim3r.StateError, "copy()"):
            np.asarray(scene)


def check_pickled():
    given = arrays(2)
    foreign = trim3r.Scene.from_arrays(**given, antialiased=True)
    with with_views() as made:
        scene, picture = made.build(200), made.picture(FRAMES[1].camera)
        for one, twin in ((each, duplicate(each)) for each in (scene, foreign)
                          for duplicate in (lambda x: pickle.loads(pickle.dumps(x)), copy.deepcopy, copy.copy)):
            check(twin.gaussians.tobytes() == one.gaussians.tobytes() and twin.origin_q32 == one.origin_q32, f"{twin}")
            check((twin.exponent, twin.valid_points, twin.antialiased) == (one.exponent, one.valid_points, one.antialiased), f"{twin}")
            check((twin.harmonics_q12 is None) == (one is scene), "harmonics")
        twin = pickle.loads(pickle.dumps(scene))
        again = pickle.loads(pickle.dumps(picture))
        made.rebuild(100)
        check(len(twin.positions) == 200, "a pickled scene stays")
        check(np.array_equal(again.colour, picture.colour) and np.array_equal(again.depth_q20, picture.depth_q20), "a picture")
        for thing in (made, trim3r.Stream(SIDE, SIDE, 100, head="tiny")):
            with refused(TypeError, "pickle", type(thing).__name__):
                pickle.dumps(thing)
    frame = pickle.loads(pickle.dumps(FRAMES[0]))
    check(np.array_equal(frame.colour, FRAMES[0].colour) and frame.camera == FRAMES[0].camera, "a frame")
    error = pickle.loads(pickle.dumps(trim3r.InputError("no", "T3R_ERR_CAMERA")))
    check((str(error), error.status) == ("no", "T3R_ERR_CAMERA"), "an error")


def decoded(png):
    """Returns the rows of a PNG without filters, as bytes."""
    check(png[:8] == b"\x89PNG\r\n\x1a\n", "a PNG")
    stream, data = io.BytesIO(png[8:]), b""
    while header := stream.read(8):
        body = stream.read(int.from_bytes(header[:4], "big"))
        check(int.from_bytes(stream.read(4), "big") == zlib.crc32(header[4:] + body), "the checksum of a chunk")
        data += body if header[4:] == b"IDAT" else b""
    return zlib.decompress(data)


def check_shown(folder):
    path = folder / "room.mcap"
    run(sys.argv[2], "room", "--size", f"{SIDE}x{SIDE}", "--frames", "2", "-o", path)
    recording = trim3r.Recording(path)
    check(repr(recording) == f"<Recording: {path}, 2 frames>" and len(pickle.loads(pickle.dumps(recording))) == 2, f"{recording}")
    with with_views() as made:
        scene = made.build(200)
        check(f"200 Gaussians of {2 * SIDE * SIDE} points" in repr(scene), f"{scene}")
        check("2 of 2 views" in repr(made) and "closed" not in repr(made), f"{made}")
        picture = made.picture(FRAMES[1].camera)
        check(f"{SIDE}x{SIDE}" in repr(picture) and "covered" in repr(picture), f"{picture}")
        rows = np.frombuffer(decoded(picture._repr_png_()), np.uint8).reshape(SIDE, 1 + 3 * SIDE)
        check(np.array_equal(rows[:, 1:].reshape(SIDE, SIDE, 3), picture.colour) and not rows[:, 0].any(), "the picture's pixels")
        made.rebuild(100)
        check("gone" in repr(scene), f"{scene}")
    check("closed" in repr(made), f"{made}")
    check("harmonics of degree 2" in repr(trim3r.Scene.from_arrays(**arrays(2))), "harmonics")
    check(f"{SIDE}x{SIDE} rgb24, depth {SIDE}x{SIDE} of uint16, a camera" in repr(FRAMES[0]), f"{FRAMES[0]}")
    luma = FRAMES[0].colour[..., 1].copy()
    pair = np.stack([luma, np.full_like(luma, 128)], axis=2)
    for change, wanted in (({}, FRAMES[0].colour), ({"colour": FRAMES[0].colour[..., ::-1], "format": "bgr24"}, FRAMES[0].colour),
                           ({"colour": luma, "format": "grey"}, luma), ({"colour": pair, "format": "yuyv"}, luma),
                           ({"colour": pair[..., ::-1], "format": "uyvy"}, luma), ({"colour": (luma, pair), "format": "nv12"}, luma)):
        rows = np.frombuffer(decoded(dataclasses.replace(FRAMES[0], **change)._repr_png_()), np.uint8).reshape(SIDE, -1)
        check(np.array_equal(rows[:, 1:], wanted.reshape(SIDE, -1)), f"a frame as {change.get('format', 'rgb24')}")


def main():
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        folder = pathlib.Path(folder)
        check_there_and_back()
        check_files(folder)
        check_dropped(folder)
        check_drawn()
        check_near_and_far()
        check_refused()
        check_views()
        check_pickled()
        check_shown(folder)
    done()


if __name__ == "__main__":
    main()
