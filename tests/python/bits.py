#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bits.py LIBRARY TRIM3R: the package's frames, hashes, scenes, files and figures equal the program's."""
import json
import pathlib
import sys
import tempfile

from common import FRAMES, SIDE, check, np, small, trim3r, with_views

from checks import done, near, run
from png import png

# the program's rounding
FIGURES = {"psnr": ("psnr", 4), "ssim": ("ssim", 5), "sharp": ("sharp", 5), "holes": ("holes", 5),
           "psnr_all": ("psnr_all", 4), "ssim_all": ("ssim_all", 5), "flip_all": ("perceptual_all", 5),
           "context_psnr": ("context_psnr", 4), "flip": ("perceptual", 5)}


def program(*arguments):
    return run(sys.argv[2], *arguments).stdout


def check_frames(recording):
    check(len(recording) == 3, f"{len(recording)} frames")
    for made, read in zip(FRAMES, recording):
        check(np.array_equal(made.colour, read.colour) and np.array_equal(made.depth, read.depth), "pixels")
        check(made.camera == read.camera and abs(made.depth_unit - read.depth_unit) < 1e-12, f"{made} and {read}")
    check(recording.triplets == [((0, 2), 1)] and recording.note == "", f"{recording.triplets} {recording.note}")


def check_build(recording, folder, path):
    """Compares hashes of each stage, of the whole, and every byte of the file."""
    settings = ("--context", "0,2", "--gaussians", "400", "--json")
    replayed = json.loads(program("replay", path, *settings))
    built = json.loads(program("build", path, *settings, "-o", folder / "theirs.ply"))
    with small(head="small") as made:
        made.add_view(recording[0])
        made.add_view(recording[2])
        check(made.cpu == json.loads(program("doctor", "--json"))["cpu_used"], f"the processor: {made.cpu}")
        check(made.valid_points == built["valid_points"], f"{made.valid_points} points")
        scene = made.build(400)
        check(trim3r.run_hash(made.stage_hashes) == built["hash"], "the hash of the build")
        made.render(recording[1].camera)
        check(made.stage_hashes == replayed["stages"], f"{made.stage_hashes} and {replayed['stages']}")
        check((len(scene), scene.valid_points) == (400, built["valid_points"]), f"{len(scene)} Gaussians")
        scene.save(folder / "ours.ply")
    check((folder / "ours.ply").read_bytes() == (folder / "theirs.ply").read_bytes(), "the file")


def check_presets(recording, folder, path):
    """Compares the head and the settings of `--preset`."""
    for name in ("fast", "balanced", "best"):
        built = json.loads(program("build", path, "--context", "0,2", "--gaussians", "90", "--preset", name, "--json", "-o",
                                   folder / "preset.ply"))
        with small(**trim3r.preset(name)) as made:
            made.add_view(recording[0])
            made.add_view(recording[2])
            made.build(90)
            check(trim3r.run_hash(made.stage_hashes) == built["hash"], f"the preset {name}")
    try:
        trim3r.preset("quick")
        check(False, "an unknown preset is taken")
    except ValueError as error:
        check("fast, balanced, best" in str(error), f"{error}")


def check_same_bits():
    """Changes everything without influence on bits: a kept analysis, workers, the arena's size, a percentage for a
    count."""
    with with_views() as one, with_views(workers=3) as two, with_views(arena_bytes=1 << 20, gaussians=900) as three:
        scene = one.build(900)
        wanted, hashes = scene.gaussians.tobytes(), one.stage_hashes
        check(two.build(900).gaussians.tobytes() == wanted and two.stage_hashes == hashes, "with three workers")
        check(three.build().gaussians.tobytes() == wanted and three.stage_hashes == hashes, "in a small arena")
        one.build(100)
        check(one.rebuild(900).gaussians.tobytes() == wanted and one.stage_hashes == hashes, "rebuilt")
        check(one.rebuild(keep=900 / one.valid_points * 100).gaussians.tobytes() == wanted, "in percent")
        picture = one.picture(FRAMES[1].camera)
        check(np.array_equal(picture.colour, one.render(FRAMES[1].camera)), "a picture with its depth")
        check(0.5 < picture.alpha.mean() < 1, f"alpha {picture.alpha.mean()}")


def check_heads():
    """Uses other heads for single builds on one analysis, and afterwards the constructor's again."""
    with with_views(head="small") as made:
        wanted = made.build(300).gaussians.tobytes()
        for head in ("analytic", "tiny", None):
            ours = made.rebuild(300, head=head).gaussians.tobytes()
            with with_views(head=head or "small") as alone:
                check(ours == alone.build(300).gaussians.tobytes(), f"the head {head}")
            check((ours == wanted) == (head is None), f"the head {head} makes a scene of its own")


def check_scene(folder):
    """Compares means in the world, a file that is read again, and views of the read scene."""
    with with_views() as made, small(0, gaussians=4096) as drawn:
        scene = made.build(keep=50)
        away = np.linalg.norm(scene.positions - FRAMES[0].camera.pose[:3, 3], axis=1)
        near(np.median(away), 3, 1.5, "metres to the means")
        check((np.linalg.eigvalsh(scene.covariances) > -1e-9).all(), "covariances")
        check(0 <= scene.colours.min() <= scene.colours.max() <= 1 and scene.opacities.max() < 1, "colours, opacities")
        scene.save(folder / "scene.ply", comments=True)
        read = trim3r.Scene.read(folder / "scene.ply")
        check(read.exponent == scene.exponent and read.origin_q32 == scene.origin_q32, "the frame")
        check(np.array_equal(read.gaussians["position_q20"], scene.gaussians["position_q20"]), "means of the file")
        view = FRAMES[1].camera
        drawn.load(scene.copy())
        check(np.array_equal(drawn.render(view), made.render(view)), "a scene that was loaded is drawn as it was")
        drawn.load(read)
        check(trim3r.psnr(made.render(view), drawn.render(view)) > 45, "the file is drawn as the scene")
        picture, measured = made.picture(view), FRAMES[1].depth * FRAMES[1].depth_unit
        there = picture.depth > 0
        near(np.median(picture.depth[there] / measured[there]), 1, 0.02, "depth that was drawn against that measured")
        seen = scene.select(scene.opacities > 0.5)
        drawn.load(seen)
        check(0 < len(seen) < len(scene) and drawn.render(view).any(), "a part of it")
        for suffix in (".splat", ".spz", ".glb"):
            scene.save(folder / f"scene{suffix}")
            check(len(trim3r.Scene.read(folder / f"scene{suffix}")) == len(scene), f"as {suffix}")


def check_figures(path, frames):
    rows = json.loads(program("eval", path, "--context", "0,2", "--target", "1", "--keep", "40,5", "--json"))["rows"]
    ours = trim3r.evaluate([frames[0], frames[2]], frames[1], [40, 5])
    for theirs, row in zip(rows, ours):
        check((row.gaussians, row.keep) == (theirs["gaussians"], theirs["keep"]), f"{row}")
        for name, (column, digits) in FIGURES.items():
            near(getattr(row, name), theirs[column], 0.51 * 10 ** -digits, f"{name} at {row.keep} %")
        check(row.image.shape == (SIDE, SIDE, 3), "the image")
    check(len(rows) == len(ours) == 2 and ours[0].psnr > ours[1].psnr + 0.3, "two rows, and the larger budget is better")
    return ours[0]


def bent(folder, name, depths):
    """Records the room through a lens that does not reach every pixel; frames beyond so many have no depth."""
    made, frames = folder / name, []
    made.mkdir()
    for i, frame in enumerate(FRAMES):
        (made / f"{i}.png").write_bytes(png([row.tobytes() for row in frame.colour]))
        (made / f"{i}.depth.png").write_bytes(png([row.astype(">u2").tobytes() for row in frame.depth], 16, 1))
        pose = frame.camera.pose @ np.diag([1, -1, -1, 1])
        frames.append({"file_path": f"{i}.png", "transform_matrix": pose.tolist()})
        frames[-1].update({"depth_path": f"{i}.depth.png"} if i in depths else {})
    camera = FRAMES[0].camera
    (made / "transforms.json").write_text(json.dumps(
        {"camera_model": "OPENCV", "k1": 0.2, "k2": 0, "p1": 0, "p2": 0, "fl_x": camera.fx, "fl_y": camera.fy,
         "cx": camera.cx + 0.5, "cy": camera.cy + 0.5, "w": SIDE, "h": SIDE, "integer_depth_scale": FRAMES[0].depth_unit,
         "frames": frames}))
    program("import", made, "-o", made.with_suffix(".mcap"))
    return made.with_suffix(".mcap")


def check_masks(folder):
    """Compares the figures of frames with a lens, all with depth, and with none of the target."""
    for name, depths in (("lens", (0, 1, 2)), ("lens-no-depth", (0, 2))):
        path = bent(folder, name, depths)
        row = check_figures(path, trim3r.Recording(path))
        check((row.psnr == row.psnr_all) == (1 not in depths), f"{name}: psnr {row.psnr}, psnr_all {row.psnr_all}")
        target = trim3r.develop(trim3r.Recording(path)[1], SIDE, SIDE).colour
        check(row.psnr_all > trim3r.psnr(target, row.image) + 0.1, f"{name}: pixels beyond the lens do not count")


def check_stereo(path):
    built = json.loads(program("build", path, "--context", "0,2", "--keep", "20%", "--depth", "stereo", "-o",
                               path.with_name("stereo.ply"), "--json"))
    with with_views(depth="stereo", head="small") as made:
        scene = made.build(keep=20)
        check((len(scene), scene.valid_points) == (built["gaussians"], built["valid_points"]), "points by stereo")
        check(trim3r.run_hash(made.stage_hashes) == built["hash"], "the hash by stereo")


def main():
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        folder = pathlib.Path(folder)
        path = folder / "room.mcap"
        program("room", "--size", f"{SIDE}x{SIDE}", "--frames", "3", "-o", path)
        recording = trim3r.Recording(path)
        check_frames(recording)
        check_build(recording, folder, path)
        check_presets(recording, folder, path)
        check_same_bits()
        check_heads()
        check_scene(folder)
        check_figures(path, FRAMES)
        check_masks(folder)
        check_stereo(path)
    done()


if __name__ == "__main__":
    main()
