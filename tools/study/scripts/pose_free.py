"""Novel views of scenes without given poses: the part of tools/study/scripts/poses that chooses its pairs without
depth."""
import json
import os
import statistics
import subprocess
import tempfile

import cv2
import numpy as np

from measured import COLOUR_SCENES, DATA, even_triplets, table

AXES = np.diag([1.0, -1, -1, 1])  # OpenGL's camera axes and ours
KEEPS = ("100", "10")
GIVEN = "given"
WAYS = {  # for each kind of depth: the poses to try, and the estimator's source for them
    "stereo": {GIVEN: None, "from colour": "estimate-colour", "from colour, the target's too": "estimate-colour"},
    "sensor": {GIVEN: None, "with depth": "estimate"},
}
ABOUT = """## Novel views from colour alone

The paper's setting: two pictures, their intrinsics, no poses, no depth. Context views' poses estimated from colour (from
pictures as they are), depth by stereo, 256x256, the default head; the scenes and triplets of [stereo.md](stereo.md). Nothing given reaches the program but the target's pose. It must be converted to the estimated frame, where the first camera is
the origin and the second is 1 away. For that the midpoints of the given and the estimated context cameras are laid on each other.
They are turned by the mean of what turns either camera, and scaled by the ratio of the distances. With depth they are not
scaled: lengths are the sensor's. So errors of the given poses and of the estimated ones both count. `the target's too`: its pose is estimated
with the others, from its own picture, and nothing given is used.

PSNR of the target, 100 % and 10 % kept, means over what was posed and matched. The mask is the sensor's where both context views have a
sensor's depth. Otherwise it is what the depths by stereo of given or of estimated poses cover, uncovered pixels being black. The change is against given poses and the same depth, on the same triplets. What was refused is listed below.
"""


class Case:
    """One triplet of a scene, as pictures to render with one set of poses or another."""

    def __init__(self, measurements, scene, context, target):
        self.m, self.scene = measurements, scene
        self.indices = (*context, target)
        with open(os.path.join(DATA, scene, "transforms.json"), encoding="utf-8") as file:
            self.root = json.load(file)
        self.frames = [self.root["frames"][i] for i in self.indices]
        self.given = [np.array(f["transform_matrix"]) @ AXES for f in self.frames]
        self.sensed = all("depth_path" in f for f in self.frames[:2])

    def posed(self, depth, way, source):
        """Cameras to world of contexts and target in their own frame, and None; or None and the reason."""
        if source is None:
            return self.given, None
        whole = way.endswith("too")
        found, why = self.m.estimated(self.m.own_size(self.scene), source, *self.indices[:3 if whole else 2],
                                     depth=depth)
        if found is None:
            return None, why
        cameras = [np.eye(4), *map(np.array, found)]
        if not whole:
            cameras.append(laid_over(self.given[:2], cameras, metric=source == "estimate") @ self.given[2])
            cameras[2][:3, :3] = nearest_rotation(cameras[2][:3, :3])
        return cameras, None

    def pictures(self, cameras, depth):
        """{keep: render}, target, mask, and None; or None and the reason."""
        with tempfile.TemporaryDirectory() as folder:
            frames = []
            for frame, camera in zip(self.frames, cameras):
                frame = dict(frame, transform_matrix=(camera @ AXES).tolist())
                frame["file_path"] = os.path.abspath(os.path.join(DATA, self.scene, frame["file_path"]))
                own = frame.pop("depth_path", None)
                if depth == "sensor" and own is not None:
                    frame["depth_path"] = os.path.abspath(os.path.join(DATA, self.scene, own))
                frames.append(frame)
            with open(f"{folder}/transforms.json", "w", encoding="utf-8") as file:
                json.dump({**self.root, "frames": frames, "trim3r_triplets": []}, file)
            subprocess.run([self.m.program, "import", folder, "--size", "256x256", "-o", f"{folder}/r.mcap"], check=True,
                           stdout=subprocess.DEVNULL)
            done = subprocess.run([self.m.program, "eval", f"{folder}/r.mcap", "--context", "0,1", "--target", "2",
                                   "--keep", ",".join(KEEPS), "--depth", depth, "--images", f"{folder}/out"],
                                  capture_output=True, text=True, check=False)
            if done.returncode == 1 and "give no depth" in done.stderr:
                return None, done.stderr[done.stderr.index("frames "):].strip()
            done.check_returncode()
            stem = "trim3r_stereo" if depth == "stereo" else "trim3r"
            read = lambda name, how=cv2.IMREAD_COLOR: cv2.imread(f"{folder}/out/2/{name}", how)
            return {"keep": {k: read(f"{stem}_{k}.png") for k in KEEPS}, "target": read("target.png"),
                    "mask": read("mask.png", 0) > 0}, None

    def measured(self):
        """{depth: {poses: [PSNR of each keep], or the reason why not}}"""
        made = {}
        for depth, ways in WAYS.items():
            for way, source in ways.items():
                if depth == "stereo" or self.sensed:
                    cameras, why = self.posed(depth, way, source)
                    drawn, why = (None, why) if cameras is None else self.pictures(cameras, depth)
                    made[depth, way] = why if drawn is None else drawn
        drawn = {k: v for k, v in made.items() if not isinstance(v, str)}
        masks = [v["mask"] for k, v in drawn.items() if k == ("sensor", GIVEN)] or [v["mask"] for v in drawn.values()]
        mask = np.logical_or.reduce(masks) if masks else None
        out = {}
        for (depth, way), pictures in made.items():
            out.setdefault(depth, {})[way] = pictures if isinstance(pictures, str) else [
                psnr(pictures["target"], pictures["keep"][k], mask) for k in KEEPS]
        return out


def psnr(a, b, mask):
    error = np.mean((a[mask].astype(float) - b[mask]) ** 2)
    return float(10 * np.log10(255**2 / max(error, 1e-9)))


def nearest_rotation(matrix):
    u, _, vt = np.linalg.svd(matrix)
    return u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt


def laid_over(given, estimated, metric):
    """Returns the similarity from the given world to the estimated one: a matrix whose rotation is scaled."""
    centres = [[p[:3, 3] for p in poses] for poses in (given, estimated)]
    turn = nearest_rotation(sum(e[:3, :3] @ g[:3, :3].T for g, e in zip(given, estimated)))
    apart = [np.linalg.norm(second - first) for first, second in centres]
    out = np.eye(4)
    out[:3, :3] = turn * (1 if metric else apart[1] / apart[0])
    middle = [np.mean(c, 0) for c in centres]
    out[:3, 3] = middle[1] - out[:3, :3] @ middle[0]
    return out


def measurements(m, scene):
    """[(context, target, {depth: {poses: PSNR or reason}})] of a scene's triplets."""

    def make():
        with open(os.path.join(DATA, scene, "transforms.json"), encoding="utf-8") as file:
            triplets = even_triplets(json.load(file))
        return [(context, target, Case(m, scene, context, target).measured()) for context, target in triplets]

    return m.kept(f"colour.{scene}", make)


def decibels(rows, sign=""):
    return [f"{statistics.fmean(column):{sign}.2f}" for column in zip(*rows)] if rows else ["", ""]


def rows(m, scene):
    cases = [found for _, _, found in measurements(m, scene)]
    title = scene
    for depth, ways in WAYS.items():
        having = [case[depth] for case in cases if depth in case]
        for way in ways if having else ():
            scores = [case[way] for case in having if not isinstance(case[way], str)]
            both = [(case[way], case[GIVEN]) for case in having
                    if not isinstance(case[way], str) and not isinstance(case[GIVEN], str)]
            change = decibels([[a - b for a, b in zip(*pair)] for pair in both], "+") if way != GIVEN else ["", ""]
            yield [title, depth, way, f"{len(scores)} of {len(having)}", *decibels(scores), *change]
            title = ""


def refusals(m, scene):
    for context, target, found in measurements(m, scene):
        for depth, ways in found.items():
            for way, score in ways.items():
                if isinstance(score, str):
                    yield [scene, f"{context[0]}, {context[1]}", str(target), depth, way, score]


def lines(m):
    yield ABOUT
    titles = ["scene", "depth", "poses", "drawn", *(f"{k} %, dB" for k in KEEPS), *(f"change, {k} %" for k in KEEPS)]
    yield from table(titles, (row for scene in COLOUR_SCENES for row in rows(m, scene)))
    yield ""
    yield "Refused:"
    yield ""
    yield from table(["scene", "context", "target", "depth", "poses", "reason"],
                     (row for scene in COLOUR_SCENES for row in refusals(m, scene)))
