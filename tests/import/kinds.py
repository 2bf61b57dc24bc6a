#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""kinds.py TRIM3R: a folder of each kind that people have, and the message of import, info and build: what it is, and
the command or the option that makes a recording of it."""
import json
import os

from program import check, in_scratch, run, write

UNIT = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
CAPTURE = json.dumps({"frames": [{"file_path": "images/0.png", "transform_matrix": UNIT}]})
BAG = "rosbag2_bagfile_information:\n  relative_file_paths:\n    - bag.db3\n"
THEN = ", then trim3r import OUT -o REC.mcap"
ESTIMATE = "--poses estimate"

# Each kind: the files that make it, and parts of the message.
KINDS = {
    "Polycam": (["keyframes/images/1.jpg", "keyframes/cameras/1.json", "mesh_info.json"],
                ["a scan of Polycam", "ns-process-data polycam --data {0} --output-dir OUT", THEN]),
    "Polycam, corrected": (["keyframes/corrected_images/1.jpg", "keyframes/corrected_cameras/1.json"], ["a scan of Polycam"]),
    "Stray Scanner": (["rgb.mp4", "odometry.csv", "camera_matrix.csv", "depth/000000.png"],
                      ["a scan of Stray Scanner", "ffmpeg -i {0}/rgb.mp4 OUT/%06d.png", ESTIMATE, "camera_matrix.csv"]),
    "Record3D, packed": (["scan.r3d"], ["a packed scan of Record3D", "unzip {0}/NAME.r3d -d OUT", THEN]),
    "Record3D": (["metadata", "rgbd/0.jpg"], ["{0}/metadata"]),
    "NeRFCapture without its lens": ([("transforms.json", CAPTURE), "images/0.png"], ["transforms.json", "fl_x"]),
    "Spectacular AI": (["data.jsonl", "data.mkv", "calibration.json"], ["Spectacular AI", "sai-cli process {0} OUT", THEN]),
    "rosbag2 in SQLite": ([("metadata.yaml", BAG), ("bag.db3", "SQLite format 3\0")], ["mcap convert"]),
    "rosbag2 without its list": (["bag_0.mcap"], ["ros2 bag reindex {0}"]),
    "COLMAP without pictures": ([("sparse/0/cameras.txt", "1 PINHOLE 8 8 9 9 4 4\n"), ("sparse/0/images.txt", ""),
                                 "sparse/0/points3D.txt"], ["sparse/0"]),
    "COLMAP without a model": (["database.db", "images/0.png"], ["colmap mapper --database_path {0}/database.db"]),
    "TUM RGB-D without a lens": ([("rgb.txt", "0 rgb/0.png\n"), ("groundtruth.txt", "0 0 0 0 0 0 0 1\n")], ["--intrinsics"]),
    "ScanNet, packed": (["scene0000_00.sens"], ["a packed scan of ScanNet", "--export_poses", THEN]),
    "Scaniverse": (["2026-01-01.spz"], ["Scaniverse", "trim3r render, view and convert take", "{0}/NAME.spz"]),
    "scenes": (["splat.ply"], ["a folder of scenes", "{0}/NAME.ply"]),
    "a mesh": (["model.usdz"], ["a folder of meshes", ".ply or .spz"]),
    "3D Gaussian Splatting": (["cfg_args", "cameras.json", "point_cloud/iteration_30000/point_cloud.ply"],
                              ["3D Gaussian Splatting", "{0}/point_cloud/iteration_N/point_cloud.ply", "render --path"]),
    "nerfstudio's run": (["config.yml", "nerfstudio_models/step.ckpt"], ["ns-export gaussian-splat --load-config {0}/config.yml"]),
    "Blender": (["transforms_train.json", "transforms_test.json", "train/r_0.png"], ["ln -s transforms_train.json {0}/transforms.json"]),
    "LLFF": (["poses_bounds.npy", "images/0.JPG"], ["a scene of LLFF", "trim3r import {0}/images", ESTIMATE, "--intrinsics"]),
    "EuRoC": (["mav0/cam0/data.csv", "mav0/cam0/data/1.png"], ["a sequence of EuRoC", "trim3r import {0}/mav0/cam0/data", ESTIMATE]),
    "KITTI": (["calib.txt", "times.txt", "image_2/000000.png"], ["a sequence of KITTI", "{0}/image_2", "P2 in calib.txt"]),
    "ARKitScenes": (["lowres_wide.traj", "lowres_wide/1.png"], ["ARKitScenes", "{0}/lowres_wide", ".pincam"]),
    "Aria": (["recording.vrs"], ["ns-process-data aria --vrs-file {0}/NAME.vrs", THEN]),
    "OpenDroneMap": (["opensfm/reconstruction.json", "odm_report/shots.geojson"], ["ns-process-data odm --data {0}", THEN]),
    "OpenSfM": (["reconstruction.json", "camera_models.json"], ["opensfm export_colmap {0}"]),
    "Metashape": (["scan.psx", "scan.files/0/frame.zip"], ["ns-process-data metashape", "--xml CAMERAS.xml"]),
    "pointmaps": (["points.npz"], ["--pointmaps NAME.npz"]),
    "an unpacked scene": (["meta.json", "means_l.webp"], ["an unpacked .sog"]),
    "a video": (["film.mp4"], ["ffmpeg -i IN"]),
    "WebP": (["1.webp", "2.webp"], ["dwebp"]),
    "pictures in images": (["images/0.png"], ["trim3r scene {0}/images", "trim3r import {0}/images", ESTIMATE]),
    "pictures in rgb": (["rgb/0.jpeg"], ["trim3r scene {0}/rgb", "trim3r import {0}/rgb", ESTIMATE]),
    "pictures in a folder below": (["notes/a.txt", "photos/0.JPG", "zoo/1.png"], ["no pictures, but {0}/photos has some: name that folder"]),
    "nothing": ([], ["transforms.json", "rgb.txt"]),
}


def make(folder, files):
    os.makedirs(folder)
    for file in files:
        name, content = file if isinstance(file, tuple) else (file, "x")
        os.makedirs(os.path.dirname(f"{folder}/{name}"), exist_ok=True)
        write(f"{folder}/{name}", content)


def every_kind():
    for number, (kind, (files, words)) in enumerate(KINDS.items()):
        folder = f"{number} [a]*" # no pattern
        make(folder, files)
        for line in (["import", folder, "-o", "r.mcap"], ["info", folder], ["build", folder, "--keep", "10", "-o", "s.ply"]):
            code, out, error = run(*line)
            lacking = [word for word in (each.format(folder) for each in words) if word not in error]
            if line[0] != "import" and kind == "TUM RGB-D without a lens": # info describes it
                continue
            check(code == 1 and out == "" and not lacking, f"{kind}, {line[0]}: {code} {out}{error} lacks {lacking}")
            check(error.count("\n") == 1, f"{kind}, {line[0]}: more than one line: {error}")
    check(len(KINDS) > 20, "fewer than twenty kinds")


in_scratch(every_kind)
