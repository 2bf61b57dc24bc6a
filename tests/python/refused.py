#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""refused.py LIBRARY: invalid input is refused with a reason, and leaves everything unchanged."""
import dataclasses
import pathlib
import re
import tempfile

from common import FRAMES, ROOT, SIDE, check, np, refused, small, trim3r, with_views
from trim3r import _native

from checks import done

NAN = float("nan")


def changed(**fields):
    return dataclasses.replace(FRAMES[0], **fields)


def check_frames():
    colour, depth = FRAMES[0].colour, FRAMES[0].depth
    with small() as made:
        for frame, *words in (
                (changed(colour=colour[..., :2]), "(64, 64, 2)", "(H, W, 3)"),
                (changed(colour=colour[0]), "shape"),
                (changed(colour=colour.astype(np.float32)), "float32", "uint8", "255 * x"),
                (changed(colour=np.zeros((SIDE, SIDE, 4), np.uint8)), "(64, 64, 4)", "drops alpha"),
                (changed(colour=colour.astype(np.int8)), "int8"),
                (changed(colour=colour.tolist()), "a list"),
                (changed(colour=colour[:, ::-1]), "row"), (changed(colour=colour[::-1]), "upwards"),
                (changed(colour=colour[:, ::2]), "row"), (changed(colour=colour[..., ::-1]), "row"),
                (changed(colour=np.asfortranarray(colour)), "ascontiguousarray"),
                (changed(colour=np.broadcast_to(colour[0], colour.shape)), "overlap"),
                (changed(colour=np.zeros((0, SIDE, 3), np.uint8)), "sides"),
                (changed(colour=np.zeros((5000, 8, 3), np.uint8)), "4096"),
                (changed(colour=np.zeros((1, 1, 3), np.uint8)), ""),
                (changed(colour=(colour, colour)), "nv12"), (changed(format="nv12"), "pair"),
                (changed(format="rgb"), "rgb24, bgr24, grey"),
                (changed(colour=np.zeros((SIDE, SIDE - 1, 2), np.uint8), format="yuyv"), ""),
                (changed(colour=(colour[..., 0].copy(), np.zeros((3, 3, 2), np.uint8)), format="nv12"), "half"),
                (changed(depth=depth.astype(np.int16)), "int16"), (changed(depth=depth.astype(">u2")), ">u2"),
                (changed(depth=depth[..., None]), "shape"), (changed(depth=depth.astype(object)), "object"),
                (changed(depth_unit=0), "depth_unit"), (changed(depth_unit=-1), "depth_unit"),
                (changed(depth_unit=NAN), "finite"), (changed(depth_unit=1e9), "range"),
                (changed(depth=depth.astype(np.float32)), "world units", "half of it is", "65.535", "Millimetres?", "1000"),
                (changed(depth=np.where(depth > np.median(depth), depth / 20, np.nan)), "Millimetres?"),
                (changed(camera=None), "no camera")):
            with refused(ValueError, *words):
                made.add_view(frame)
        with refused(trim3r.DepthError, "depth"):
            made.add_view(changed(depth=None))
        with refused(trim3r.DepthError):
            made.add_view(changed(depth=np.zeros_like(depth)))
        with refused(trim3r.DepthError):
            made.add_view(changed(depth=np.full(depth.shape, NAN)))
        check(made.valid_points == 0, "nothing was added")
        made.add_view(FRAMES[0])
        made.add_view(FRAMES[2])
        with refused(trim3r.StateError):
            made.add_view(FRAMES[1])
        check(len(made.build(100)) == 100 and made.valid_points == 2 * SIDE * SIDE, "all is as it was")
        with refused(trim3r.StateError):
            made.add_view(FRAMES[1])


def check_cameras():
    pose, scaled, mirrored, nan = np.eye(4), np.eye(4) * 2, np.diag([1.0, 1, -1, 1]), np.eye(4)
    scaled[3, 3], nan[0, 3] = 1, NAN
    make = trim3r.Camera.calibrated
    for what, *words in (((NAN, 60, 32, 32, pose), "fx"), ((60, float("inf"), 32, 32, pose), "fy"),
                         ((60, 60, 1e9, 32, pose), "cx"), ((60, 60, 32, 32, nan), "finite"),
                         ((60, 60, 32, 32, scaled), "rotation"), ((60, 60, 32, 32, mirrored), "rotation"),
                         ((60, 60, 32, 32, np.zeros((4, 4))), "last row"),
                         ((60, 60, 32, 32, np.zeros((3, 4))), "rotation"),
                         ((60, 60, 32, 32, np.eye(3)), "(3, 3)"), ((60, 60, 32, 32, np.full((4, 4), 1e300)), ""),
                         ((60, 60, 32, 32, pose, "wide"), "radtan"), ((60, 60, 32, 32, pose, "radtan", [0] * 6), "5"),
                         ((60, 60, 32, 32, pose, "radtan", [NAN]), "coefficient 0")):
        with refused(ValueError, *words):
            make(*what)
    far = np.eye(4)
    far[0, 3] = 1e10
    with refused(ValueError, "pose", "position"):
        make(60, 60, 32, 32, far)
    for axes in ("opencv", "opengl"): # a camera a metre to the left that looks along the world's z
        flip = np.diag([1.0, 1, 1, 1] if axes == "opencv" else [1.0, -1, -1, 1])
        there = np.eye(4)
        there[:3, 3] = -1, 0, 0.5
        check(np.allclose(make(60, 60, 32, 32, there @ flip, axes=axes).pose, there, atol=1e-8), axes)
        back = np.linalg.inv(there @ flip)
        check(np.allclose(make(60, 60, 32, 32, back, axes=axes, world_to_camera=True).pose, there, atol=1e-8), f"{axes}, inverse")
        check(np.allclose(FRAMES[0].camera.at(back[:3], axes=axes, world_to_camera=True).pose, there, atol=1e-8), "at()")
    with refused(ValueError, "opencv, opengl", "'blender'"):
        make(60, 60, 32, 32, pose, axes="blender")
    with refused(ValueError):
        trim3r.Camera(1 << 40, 60, 32, 32).native((SIDE, SIDE))
    with refused(ValueError):
        trim3r.Camera(1 << 20, 1 << 20, 0, 0, distortion="wide").native((SIDE, SIDE))
    with small() as made, refused(trim3r.InputError):
        made.add_view(changed(camera=make(1, 1, 0, 0, pose))) # focal lengths are at least 8 pixels
    view = FRAMES[0].camera
    again = make(view.fx, view.fy, view.cx, view.cy, view.pose)
    check(np.allclose(again.pose, view.pose, atol=1e-8) and again.fx_q16 == view.fx_q16, "a pose there and back")
    for axis in np.eye(3): # half turns, for which the trace is useless
        turned = np.eye(4)
        turned[:3, :3] = 2 * np.outer(axis, axis) - np.eye(3)
        check(np.allclose(make(60, 60, 32, 32, turned).pose, turned, atol=1e-8), f"half a turn about {axis}")
        check(np.allclose(view.at(turned).pose, turned, atol=1e-8), "another pose")


def check_sizes():
    """A camera of a known size is for frames and pictures of that size alone."""
    other = FRAMES[1].camera.resized(SIDE // 2, SIDE)
    words = f"{SIDE // 2}x{SIDE} pixels, not for {SIDE}x{SIDE}", "resized()"
    with with_views() as made, small(1) as empty:
        made.build(100)
        wrong = dataclasses.replace(FRAMES[1], camera=other)
        out = np.zeros((SIDE, SIDE, 3), np.uint8)
        for call in (lambda: made.render(other), lambda: made.render(other, (SIDE, SIDE)), lambda: made.render(other, out=out),
                     lambda: made.picture(other), lambda: made.picture(other, (SIDE, SIDE)), lambda: empty.add_view(wrong),
                     lambda: empty.add_rows(wrong, 0, SIDE), lambda: trim3r.develop(wrong, SIDE, SIDE),
                     lambda: trim3r.evaluate([wrong], FRAMES[0], [10]), lambda: trim3r.evaluate([FRAMES[0]], wrong, [10])):
            with refused(trim3r.InputError, *words):
                call()
        check(not out.any(), "nothing is drawn")
        check(made.render(other, (SIDE // 2, SIDE)).shape == (SIDE, SIDE // 2, 3), "its own size")
        plain = dataclasses.replace(other, size=None)
        check(np.array_equal(made.render(plain, (SIDE // 2, SIDE)), made.render(other, (SIDE // 2, SIDE))), "no size, any size")
        with refused(trim3r.InputError, "not known"):
            plain.resized(SIDE, SIDE)
    for size in ((SIDE // 2, SIDE), (3 * SIDE, 33), (40, 400)):
        check(FRAMES[1].camera.resized(*size) == trim3r.develop(FRAMES[1], *size).camera, f"resized to {size} as a view is")


def check_settings():
    for words, options in (("width", {"width": 4}), ("", {"height": "64"}), ("views", {"views": 17}),
                           ("", {"views": -1}), ("gaussians", {"gaussians": 0}), ("", {"gaussians": 1 << 40}),
                           ("tiny, small", {"head": "huge"}), ("sensor, stereo", {"depth": "lidar"}),
                           ("workers", {"workers": 17}), ("too small", {"arena_bytes": 1000}),
                           ("render", {"render_size": (5000, 5)}), ("no setting", {"settings": {"refinement": 3}}),
                           ("refine", {"settings": {"refine": 33}}),
                           ("clusters", {"settings": {"clusters": -1}}),
                           ("db2", {"settings": {"wavelet": "db4"}}), ("number", {"settings": {"seed": "one"}})):
        with refused((ValueError, TypeError), words):
            trim3r.Reconstructor(**{"width": SIDE, "height": SIDE, **options})
    with refused(OSError):
        small(head="nowhere.t3w")
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        path = pathlib.Path(folder) / "head.t3w"
        for content in (b"", b"T3W" * 99):
            path.write_bytes(content)
            with refused(trim3r.InputError, "head.t3w"):
                small(head=path)
        path.write_bytes(b"no recording")
        for read in (trim3r.Recording, trim3r.Scene.read):
            with refused(trim3r.InputError, "byte 0"):
                read(path)
    for size in ((4, 4), (-1, 64), (1 << 40, 64)):
        with refused(ValueError):
            trim3r.develop(FRAMES[0], *size)
    for options in ({"frames": 0}, {"width": 4}, {"height": 5000}, {"seed": -1}):
        with refused(ValueError):
            trim3r.room(**options)


def check_builds():
    with small() as made:
        with refused(trim3r.StateError):
            made.build(100)
        with refused(trim3r.StateError):
            made.render(FRAMES[0].camera)
    with with_views() as made:
        with refused(trim3r.StateError):
            made.rebuild(100)
        for options, word in (({"gaussians": 0}, "gaussians"), ({"gaussians": 1 << 30}, "gaussians"),
                              ({"keep": 0}, "keep"), ({"keep": 101}, "keep"), ({"keep": NAN}, "keep"),
                              ({"gaussians": 1, "keep": 1}, "either"), ({"max_loss": -1}, "max_loss"),
                              ({"max_loss": 11}, "max_loss"), ({"max_loss": NAN}, "max_loss"),
                              ({"allocate": "best"}, "density"), ({"head": "huge"}, "tiny, small"),
                              ({"importance": [np.zeros((3, 3), np.uint16)] * 2}, "importance"),
                              ({"importance": [np.zeros((SIDE, SIDE))] * 2}, "importance"),
                              ({"importance": [np.zeros((SIDE, SIDE), np.uint16)]}, "importance")):
            with refused(ValueError, word):
                made.build(**options)
        scene = made.build(max_loss=1)
        check(0 < len(scene) < 2 * SIDE * SIDE, f"within a loss: {len(scene)}")
        wanted = np.zeros((SIDE, SIDE), np.uint16)
        wanted[:8] = 9
        scene = made.rebuild(8 * SIDE, importance=[wanted, np.zeros_like(wanted)])
        views = scene.gaussians["view"]
        check(((views == 0) | (views == 255)).all() and (views == 0).sum() > 7 * SIDE, "the points that are important, and a rim")
        view = FRAMES[1].camera
        for options in ({"size": (SIDE + 1, SIDE)}, {"size": (0, 0)}, {"out": np.zeros((SIDE, SIDE), np.uint8)},
                        {"out": np.zeros((SIDE, SIDE, 3), np.float32)},
                        {"out": np.zeros((SIDE, SIDE, 3), np.uint8)[:, ::-1]},
                        {"out": np.broadcast_to(np.uint8(0), (SIDE, SIDE, 3))},
                        {"size": (9, 9), "out": np.zeros((SIDE, SIDE, 3), np.uint8)}):
            with refused(ValueError):
                made.render(view, **options)
        with refused(ValueError, "read-only"):
            made.render(view, out=FRAMES_READ_ONLY)
        with refused(trim3r.InputError, "scenes are written as .ply"):
            scene.save("scene.obj")
        with small(0, gaussians=10) as little, refused(ValueError, "room"):
            little.load(scene)
        damaged = scene.copy()
        damaged.gaussians["factor_exponent"][3] = 99
        with refused(trim3r.InputError, "Gaussian 3"):
            made.load(damaged)


def check_measures():
    a, b = FRAMES[0].colour, FRAMES[1].colour
    equal = [measure(a, a) for measure in (trim3r.psnr, trim3r.ssim, trim3r.flip, trim3r.sharp)]
    check(equal == [99, 1, 0, 1], f"equal pictures: {equal}")
    half = np.zeros((SIDE, SIDE), bool)
    check(np.isnan(trim3r.psnr(a, b, half)), "no pixel counts")
    half[:, ::2] = True
    check(trim3r.psnr(a[:, ::2], b[:, ::2]) == trim3r.psnr(a, b, half), "a mask, and arrays with gaps")
    for what in ((a, b[:-1]), (a[..., 0], b[..., 0]), (a.astype(float), b), (a, b, half[1:]), (a[:0], b[:0]), (a, None)):
        with refused(ValueError):
            trim3r.psnr(*what)


# Calls that sentences name and the package makes itself; they are in no sentence that it raises.
OWN_CALLS = {"init", "attach", "plan", "default_config", "cpu_found", "head_column_bytes", "bind_head"}


def check_sentences():
    """Sentences of the library name methods and values of the package."""
    rows = re.findall(r"^\| [^|]+ \| `t3r_\w+\(\)` \| [^|]+ \| ([^|]+) \|$", (ROOT / "docs" / "errors.md").read_text(), re.M)
    check(len(rows) > 100, f"blind: {len(rows)} sentences")
    for row in rows:
        text = _native._in_python(row)
        for name in re.findall(r"\b(\w+)\(\)", text):
            there = any(hasattr(owner, name) for owner in (trim3r.Reconstructor, trim3r.Stream, trim3r))
            check(there or name in OWN_CALLS, f"there is no {name}(): {text}")
        left = set(re.findall(r"\bT3R_\w+", text)) - {"T3R_ARENA_ALIGN"}
        check(all(word.startswith("T3R_FEATURE_") for word in left), f"{left}: {text}")
    with trim3r.Stream(SIDE, SIDE, 100, head="tiny") as stream, refused(trim3r.StateError, "call keyframe() first"):
        stream.overlap(FRAMES[0].camera)
    with small() as made, refused(trim3r.DepthError, "unless depth is 'stereo'"):
        made.add_view(changed(depth=None))


FRAMES_READ_ONLY = FRAMES[0].colour.copy()
FRAMES_READ_ONLY.setflags(write=False)


def main():
    check_frames()
    check_cameras()
    check_sizes()
    check_settings()
    check_builds()
    check_measures()
    check_sentences()
    done()


if __name__ == "__main__":
    main()
