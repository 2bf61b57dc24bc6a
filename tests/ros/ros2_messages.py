#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""ros2_messages.py FOLDER: generates the C++ messages of ROS 2 that the node uses, by Debian's rosidl. The definitions
are Debian's for ROS 1 (packages ros-*-msgs), changed where ROS 2 differs: names of packages, the header, times and the
names of CameraInfo's arrays. Ends with 77 where a package is missing."""
import json
import pathlib
import re
import sys

SHARE = pathlib.Path("/usr/share")
GENERATOR = SHARE / "rosidl_generator_cpp" / "resource"
MESSAGES = {
    "std_msgs": ("Header",),
    "geometry_msgs": ("Point", "Quaternion", "Vector3", "Pose", "PoseStamped", "PoseWithCovariance", "Transform",
                      "TransformStamped", "Twist", "TwistWithCovariance"),
    "sensor_msgs": ("Image", "CompressedImage", "RegionOfInterest", "CameraInfo", "PointField", "PointCloud2"),
    "nav_msgs": ("Odometry",),
    "tf2_msgs": ("TFMessage",),
}
SERVICES = {"std_srvs": ("Trigger",)}
GIVEN = {  # built into ROS 1, or different there
    ("builtin_interfaces", "msg", "Time"): "int32 sec\nuint32 nanosec\n",
    ("std_msgs", "msg", "Header"): "builtin_interfaces/Time stamp\nstring frame_id\n",
}


def ros2(text, name):
    """Converts a definition of ROS 1 to ROS 2."""
    lines = [re.sub(r"\s*#.*", "", line).rstrip() for line in text.splitlines()]
    lines = [re.sub(r"^Header\b", "std_msgs/Header", line) for line in lines if line]
    if name == "CameraInfo":
        lines = [re.sub(r"\b([DKRP])$", lambda found: found[1].lower(), line) for line in lines]
    return "\n".join(lines) + "\n"


def definitions():
    """Returns {(package, kind, name): text}."""
    found = dict(GIVEN)
    for kind, packages in (("msg", MESSAGES), ("srv", SERVICES)):
        for package, names in packages.items():
            for name in names:
                text = (SHARE / package / kind / f"{name}.{kind}").read_text(encoding="utf-8")
                found.setdefault((package, kind, name), ros2(text, name))
    return found


def generate(folder):
    from rosidl_adapter.msg import convert_msg_to_idl
    from rosidl_adapter.srv import convert_srv_to_idl
    from rosidl_generator_cpp import generate_cpp
    convert = {"msg": convert_msg_to_idl, "srv": convert_srv_to_idl}
    files = {}
    for (package, kind, name), text in definitions().items():
        root = folder / "definitions" / package
        (root / kind).mkdir(parents=True, exist_ok=True)
        (root / kind / f"{name}.{kind}").write_text(text, encoding="utf-8")
        convert[kind](root, package, pathlib.Path(kind) / f"{name}.{kind}", root / kind)
        files.setdefault(package, []).append(f"{root}:{kind}/{name}.idl")
    for package, tuples in files.items():
        arguments = folder / "definitions" / f"{package}.json"
        given = {"package_name": package, "idl_tuples": tuples, "template_dir": str(GENERATOR),
                 "output_dir": str(folder / package), "target_dependencies": []}
        arguments.write_text(json.dumps(given), encoding="utf-8")
        generate_cpp(str(arguments))


def main():
    try:
        generate(pathlib.Path(sys.argv[1]))
    except (ImportError, OSError) as error:
        print(f"SKIPPED: {error} (tools/setup --tests installs it)")
        sys.exit(77)


if __name__ == "__main__":
    main()
