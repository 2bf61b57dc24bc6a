#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_stereo.py TRIM3R: scenes from colours alone: the built-in room, with and without its recorded depth; more
views; pairs that cannot be matched, and the message about them."""
import csv
import json
import os
import shutil
import sys
import tempfile

from checks import check, done, run

TRIM3R = os.path.abspath(sys.argv[1])
INPUT, USAGE = 1, 2
STEREO = ["--depth", "stereo"]
# PSNR of the room's middle view in dB, by percent kept, where context views saw its surface: measured minus 0.5. With
# depth 31.7, 31.6.
FLOORS = {"100": 29.12 - 0.5, "10": 29.28 - 0.5}
WHOLE = 29.28 - 0.5  # the same at 10 % of the whole picture, as without recorded depth


def trim3r(*words, expect=0, says=()):
    found = run(TRIM3R, *words, expect=expect)
    for text in [says] if isinstance(says, str) else says:
        check(text in found.stderr, f"{words}: '{text}' is not in '{found.stderr.strip()}'")
    return found.stdout


def rows_of(*words):
    trim3r("eval", *words, "--csv", "rows.csv")
    with open("rows.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def posed_folder(name, frames):
    """Writes a folder for import, without depth: (picture, rotation w x y z and translation world to camera)."""
    os.mkdir(name)
    listed = []
    for i, (picture, q, t) in enumerate(frames):
        shutil.copy(picture, f"{name}/{i}.png")
        columns = list(zip(*rotation_of(q)))  # camera to world
        centre = [-sum(c * v for c, v in zip(column, t)) for column in columns]
        matrix = [[r[0], -r[1], -r[2], c] for r, c in zip(columns, centre)] + [[0, 0, 0, 1]]
        listed.append({"file_path": f"{i}.png", "transform_matrix": matrix, "w": 256, "h": 256, "fl_x": 221.703125,
                       "fl_y": 221.703125, "cx": 128, "cy": 128})
    with open(f"{name}/transforms.json", "w", encoding="utf-8") as file:
        json.dump({"frames": listed}, file)
    trim3r("import", name, "-o", f"{name}.mcap")
    return f"{name}.mcap"


def room_frames(room):
    """Returns pictures and poses of the room's frames, read from COLMAP's model."""
    indices = range(5)
    trim3r("build", room, "--context", ",".join(map(str, indices)), "--gaussians", 100, "--head", "none", "--refine", 0,
           "--colmap", "model")
    with open("model/sparse/0/images.txt", encoding="ascii") as file:
        lines = [line.split() for line in file if not line.startswith("#")][::2]
    return [(f"model/images/{words[9]}", list(map(float, words[1:5])), list(map(float, words[5:8]))) for words in lines]


def with_depth_recorded(room):
    case = [room, "--context", "0,2", "--target", "1", "--keep", "100,10"]
    measured, matched = rows_of(*case), rows_of(*case, *STEREO)
    check([r["depth"] for r in measured + matched] == ["sensor"] * 2 + ["stereo"] * 2, "the column depth")
    for row, sensed in zip(matched, measured):
        psnr, keep = float(row["psnr"]), row["keep"]
        print(f"{keep} %: {psnr:.2f} dB, with the recorded depth {float(sensed['psnr']):.2f}")
        check(psnr >= FLOORS[keep], f"{keep} %: {psnr:.2f} dB")
    built = json.loads(trim3r("build", room, "--context", "0,2", "--keep", "10%", *STEREO, "-o", "s.ply", "--json"))
    valid = built["valid_points"]
    check(built["depth"] == "stereo" and built["unmatched"] == [], "what is told of the depth")
    check(65536 < valid < 131072 and built["gaussians"] == (valid * 10 + 50) // 100, "--keep counts matched points")
    check(built["arena_bytes"] <= 5 << 20, f"an arena of {built['arena_bytes']} bytes")
    plan = json.loads(trim3r("plan", "--size", "256x256", "--gaussians", built["gaussians"], *STEREO, "--json"))
    check(plan["arena_bytes"] == built["arena_bytes"] and plan["depth"] == "stereo", "the plan's arena")
    exact = json.loads(trim3r("build", room, "--context", "0,2", "--gaussians", 777, *STEREO, "-o", "s.ply", "--json"))
    check(exact["gaussians"] == 777, "--gaussians is met exactly")
    for way in ([], ["--arena", "min"], ["--threads", "3"]):
        hashed = json.loads(trim3r("replay", room, "--context", "0,2", *STEREO, *way, "--json"))
        check(hashed["hash"] == hashes.setdefault("replay", hashed["hash"]), f"the same bits with {way}")
    trim3r("build", room, "--context", "0,2", "--keep", 5, "--method", "eagles+head", *STEREO, "-o", "s.ply")
    kept = rows_of(room, "--context", "0,2", "--target", "1", "--keep", "10", *STEREO, "--images", "pictures")
    check(kept[0]["picture"].endswith("trim3r_stereo_10.png") and os.path.exists(f"pictures/{kept[0]['picture']}"),
          f"the picture's name: {kept[0]['picture']}")


def colours_alone(frames):
    flat = posed_folder("flat", frames)
    trim3r("build", flat, "--keep", 10, "-o", "s.ply", expect=INPUT, says=["has no depth", "--depth stereo"])
    case = [flat, "--context", "0,2", "--target", "1", "--keep", "10"]
    row = rows_of(*case, *STEREO)[0]
    print(f"without depth, 10 %: {row['psnr']} dB of the whole picture")
    check(row["psnr"] == row["psnr_all"] and row["psnr_seen"] == "", "without depth the whole picture counts")
    check(float(row["psnr"]) >= WHOLE, f"{row['psnr']} dB of the whole picture")
    more = rows_of(*case, "--views", "4", *STEREO)[0]
    check(more["context"].split(",")[:2] == ["0", "2"] and len(more["context"].split(",")) == 4, more["context"])
    print(f"four views: {more['psnr']} dB")
    check(float(more["psnr"]) >= 30.53 - 0.5, f"four views: {more['psnr']} dB")
    stress = json.loads(trim3r("stress", flat_triplets(flat), "--working", "64x64", "--rows", "noise", "--strengths", "1",
                               "--captures", "0", *STEREO, "--json"))
    check([r["status"] for r in stress["rows"]] == ["measured"] * 2, "stress on colours alone")


def flat_triplets(recording):
    """Makes the same with a triplet."""
    with open("flat/transforms.json", encoding="utf-8") as file:
        root = json.load(file)
    root["trim3r_triplets"] = [{"context": [0, 2], "target": 1}]
    with open("flat/transforms.json", "w", encoding="utf-8") as file:
        json.dump(root, file)
    trim3r("import", "flat", "-o", recording)
    return recording


def refusals(room, frames):
    build = ["--keep", 10, "-o", "s.ply", *STEREO]
    trim3r("build", room, "--context", "3", *build, expect=INPUT, says="two context frames")
    trim3r("build", room, "--context", "0,2", "--working", "31x64", *build, expect=USAGE, says="32 and more")
    trim3r("eval", "--planar", frames[0][0], "--keep", 10, *STEREO, expect=USAGE, says="--planar")
    w, x, y, z = frames[0][1]
    turned = [w - 0.2 * y, x - 0.2 * z, y + 0.2 * w, z + 0.2 * x]
    norm = sum(c * c for c in turned) ** 0.5
    turned = [c / norm for c in turned]
    centre = centre_of(frames[0])
    here = translation_to(turned, centre)
    back = [-y, -z, w, x]  # half a turn about its own y axis
    odd = posed_folder("odd", [frames[0], (frames[2][0], frames[0][1], frames[0][2]), (frames[2][0], turned, here),
                               (frames[2][0], back, translation_to(back, centre_of(frames[2]))), frames[2]])
    for pair, reason in (("0,1", "no baseline"), ("0,2", "pure rotation"), ("0,3", "too little overlap")):
        first, second = pair.split(",")
        for command in (["build", odd, "--context", pair, *build],
                        ["eval", odd, "--context", pair, "--target", "4", "--keep", "10", *STEREO]):
            trim3r(*command, expect=INPUT, says=[f"frames {first} and {second}", reason])
    trim3r("build", odd, "--context", "0,1,2", *build, expect=INPUT, says=["frames 0 and", "nor any other two"])
    said = trim3r("build", odd, "--context", "0,3,4", *build)
    check("frame 3 has no depth" in said and "too little overlap" in said, said)
    told = json.loads(trim3r("build", odd, "--context", "0,3,4", *build, "--json"))
    check(told["unmatched"] == [3], f"{told['unmatched']}")


def rotation_of(q):
    w, x, y, z = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def centre_of(frame):
    rotation = rotation_of(frame[1])
    return [-sum(rotation[i][k] * frame[2][i] for i in range(3)) for k in range(3)]


def translation_to(q, centre):
    return [-sum(r * c for r, c in zip(row, centre)) for row in rotation_of(q)]


hashes = {}
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    trim3r("room", "-o", "room.mcap")
    with_depth_recorded("room.mcap")
    listed = room_frames("room.mcap")
    colours_alone(listed)
    refusals("room.mcap", listed)
done()
