# SPDX-License-Identifier: Apache-2.0
"""Files with which pages begin, each made once for all of them, from built-in input."""
import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import zipfile

import mcap_read
import pages
from png import png

sys.path.append(str(pages.ROOT / "tests" / "import"))  # ros_bag, which needs numpy

SIDE = 40, 30  # size of synthetic pictures
ROOM = 64  # side of the room.mcap with which most pages begin
WALK = 96  # of the frames in the bag


class Given:
    """Makes a file by its name when a page first asks for it, and copies it into the page's folder."""

    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.folder.mkdir()

    def put(self, name, target):
        made = self.folder / name.rstrip("/")
        if not made.exists():
            MAKERS[name](self, made)
        (shutil.copytree if made.is_dir() else shutil.copyfile)(made, target / made.name)

    def run(self, *arguments):
        subprocess.run([self.program, *map(str, arguments)], check=True, capture_output=True, cwd=self.folder)

    def views(self):
        """Makes three pictures of the room at 256x256 and a text with their poses, in COLMAP's form."""
        start = self.folder / "views"
        if not start.exists():
            self.run("room", "--frames", 3, "-o", "large.mcap")
            self.run("build", "large.mcap", "--context", "0,1,2", "--head", "none", "--refine", 0, "--gaussians", 9,
                     "--colmap", start)
        return start


def recording(given, path):
    given.run("room", "--size", f"{ROOM}x{ROOM}", "-o", path)


def photos(given, path):
    shutil.copytree(given.views() / "images", path)


def colmap(given, path):
    shutil.copytree(given.views(), path)


def scannet(given, path):
    for i in range(2):
        for name, bits, channels, value in (("color", 8, 3, lambda x, y: (x * 5, y * 7, 90)),
                                            ("depth", 16, 1, lambda x, y: (1000 + x + y,))):
            (path / name).mkdir(parents=True, exist_ok=True)
            write_png(path / name / f"{i}.png", bits, channels, value)
        (path / "pose").mkdir(exist_ok=True)
        (path / "pose" / f"{i}.txt").write_text(f"1 0 0 {i / 10}\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
    (path / "intrinsic").mkdir()
    (path / "intrinsic" / "intrinsic_color.txt").write_text("35 0 19.5 0\n0 35 14.5 0\n0 0 1 0\n0 0 0 1\n")


def record3d(given, path):
    (path / "rgbd").mkdir(parents=True)
    for i in range(2):
        write_png(path / "rgbd" / f"{i}.png", 8, 3, lambda x, y: (x * 5, y * 7, 90))
        (path / "rgbd" / f"{i}.depth").write_bytes(struct.pack("<f", 2) * (SIDE[0] * SIDE[1]))
    write_json(path / "metadata", {"w": SIDE[0], "h": SIDE[1], "dw": SIDE[0], "dh": SIDE[1],
                                   "K": [35, 0, 0, 0, 35, 0, 20, 15, 1],
                                   "poses": [[0, 0, 0, 1, i / 10, 0, 0] for i in range(2)]})


def photo(given, path):
    shutil.copyfile(given.views() / "images" / "frame_000001.png", path)


def posed(given, path):
    """Makes three pictures with depth side by side, in NeRFCapture's form."""
    path.mkdir()
    frames = []
    for i in range(3):
        write_png(path / f"c{i}.png", 8, 3, lambda x, y: (x * 5 + i, y * 7, 90))
        write_png(path / f"d{i}.png", 16, 1, lambda x, y: (1000 + x + y,))
        pose = [[1, 0, 0, i / 10], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        frames.append({"file_path": f"c{i}.png", "depth_path": f"d{i}.png", "transform_matrix": pose})
    write_json(path / "transforms.json", {"fl_x": 35, "fl_y": 35, "cx": 20, "cy": 15, "w": SIDE[0], "h": SIDE[1],
                                          "integer_depth_scale": 0.002, "frames": frames,
                                          "trim3r_triplets": [{"context": [0, 2], "target": 1}]})


def tum(given, path):
    (path / "rgb").mkdir(parents=True)
    (path / "depth").mkdir()
    write_png(path / "rgb" / "1.png", 8, 3, lambda x, y: (x, y, 50))
    write_png(path / "depth" / "1.png", 16, 1, lambda x, y: (5000,))
    (path / "rgb.txt").write_text("1.00 rgb/1.png\n1.04 rgb/1.png\n")
    (path / "depth.txt").write_text("1.00 depth/1.png\n1.04 depth/1.png\n")
    (path / "groundtruth.txt").write_text("1.00 0 0 0 0 0 0 1\n1.05 0 0 1 0 0 0 1\n")


def trajectory(given, path):
    """Makes a tracker's poses next to the clock of the room's six frames."""
    path.write_text("".join(f"{i / 30:.6f} {i / 50} 0 0 0 0 0 1\n" for i in range(9)))


def bag(given, path):
    """Makes a robot's bag: a folder of rosbag2 with a RealSense's topics, and poses of the robot's body on /tf."""
    import ros_bag as ros

    given.run("room", "--size", f"{WALK}x{WALK}", "--frames", 12, "-o", "walk.mcap")
    names = {"/camera/image": ("/camera/color/image_raw", ros.IMAGE), "/camera/camera_info": ("/camera/color/camera_info", ros.INFO),
             "/camera/depth": ("/camera/aligned_depth_to_color/image_raw", ros.IMAGE)}
    recorded, ahead = ros.Bag(), (0, 0, 0.1)  # of the camera, seen from the body
    recorded.put("/tf_static", ros.TF, 0, ros.transforms((0, "base_link", "camera", ahead, ros.UPRIGHT)))
    for topic, ns, message in mcap_read.messages((given.folder / "walk.mcap").read_bytes()):
        if topic in names:
            recorded.put(*names[topic], ns, message)
        elif topic == "/camera/pose":
            _, (*place, x, y, z, w) = mcap_read.pose(message)
            forward = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
            body = [p - ahead[2] * f for p, f in zip(place, forward)]
            recorded.put("/tf", ros.TF, ns, ros.transforms((ns, "map", "base_link", body, (x, y, z, w))))
    path.mkdir()
    recorded.write(path / "robot_0.mcap")
    (path / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  relative_file_paths:\n    - robot_0.mcap\n")


def importance(given, path):
    path.mkdir()
    for frame in range(2):
        write_png(path / f"{frame}.png", 8, 1, lambda x, y: (x * 3,), (ROOM, ROOM))


def head(given, path):
    shutil.copyfile(pages.ROOT / "quant" / "heads" / "small.safetensors", path)


def scene(given, path):
    """Makes a splat for every point of the room's frames 0 and 2, like another program's network."""
    recording(given, given.folder / "scene.mcap")
    given.run("build", "scene.mcap", "--context", "0,2", "--keep", "100%", "--head", "none", "--refine", 0, "-o", path)


def example(given, path):
    """Extracts the README's program."""
    path.write_text(re.search(r"```c\n(.*?)```", (pages.ROOT / "README.md").read_text(), flags=re.S)[1])


def pointmaps(given, path):
    """Makes a slanted plane in front of the cameras of `photos`, in DUSt3R's form."""
    count, side, focal = 3, 64, 55.0
    points, poses = [], []
    for view in range(count):
        for y in range(side):
            for x in range(side):
                z = 2 + x / side
                points += [(x - 31.5) / focal * z + view / 10, (y - 31.5) / focal * z, z]
        poses += [1, 0, 0, view / 10, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("pts3d.npy", npy((count, side, side, 3), points))
        file.writestr("conf.npy", npy((count, side, side), [5] * (count * side * side)))
        file.writestr("poses.npy", npy((count, 4, 4), poses))
        file.writestr("focals.npy", npy((count,), [focal] * count))


def npy(shape, values):
    head = f"{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}".encode()
    head += b" " * (-(len(head) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + struct.pack(f"<{len(values)}f", *values)


def write_png(path, bits, channels, value, side=SIDE):
    path.write_bytes(png([b"".join(struct.pack(f">{channels}{'H' if bits == 16 else 'B'}", *value(x, y))
                                   for x in range(side[0])) for y in range(side[1])], bits, channels))


def write_json(path, value):
    path.write_text(json.dumps(value))


MAKERS = {"room.mcap": recording, "photos/": photos, "photo.png": photo, "posed/": posed, "tum/": tum, "colmap/": colmap,
          "scannet/": scannet, "record3d/": record3d, "tracker.txt": trajectory, "importance/": importance,
          "small.safetensors": head, "theirs.ply": scene, "dust3r.npz": pointmaps, "example.c": example, "robot/": bag}
