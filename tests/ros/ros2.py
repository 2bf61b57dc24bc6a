#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""ros2.py TRIM3R ros2_drive|none: the shell for ROS 2 in one process, on messages that Debian's rosidl generates and the
stand-in of rclcpp. Clouds and hashes are those of `trim3r replay --stream`, whatever way poses come. Wrong messages are
refused with a reason and change nothing."""
import sys
import tempfile

from checks import check, done, run, skip
from common import check_clouds, check_hashes, check_points, walk

trim3r, drive = sys.argv[1:]
if drive == "none":
    skip("the messages of ROS 2 cannot be generated: rosidl or ROS 1's definitions are missing (tools/setup --tests)")

FAULTS = ("colour: encoding is none of", "colour: step is less than", "colour: data hold fewer", "colour: width or height",
          "depth: header.frame_id is \"elsewhere\"", "depth: encoding is none of",
          "camera_info: K[0] (fx) is not a number", "pose: position.y is not a number", "camera_info: D has terms beyond")

with tempfile.TemporaryDirectory() as folder:
    recording, replayed = walk(trim3r, folder)
    cloud, scene = f"{folder}/cloud", f"{folder}/scene.ply"
    for kind in ("pose", "odometry", "transform", "tf", "faults"):
        shown = run(drive, recording, cloud, scene, kind)
        check_hashes(shown.stderr, replayed, kind)
        check_clouds(shown.stdout.splitlines(), replayed, kind)
        refused = 9 if kind == "faults" else 0
        check(f"{10 + refused} colour images, 10 frames, {refused} refused" in shown.stderr, f"{kind}: {shown.stderr}")
        warnings = [line for line in shown.stderr.splitlines() if line.startswith("[WARN]")]
        check((warnings == []) == (kind != "faults"), f"{kind}: {warnings}")
        for fault in FAULTS if kind == "faults" else ():
            check(sum(fault in line for line in warnings) == 1, f"told once: {fault}: {warnings}")
        check("\033" not in shown.stderr, "what messages hold does not reach a terminal")
    check_points(cloud, scene, "the last cloud")
done()
