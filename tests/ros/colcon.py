#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""colcon.py PACKAGE STAND_IN [whole]: Debian's colcon and ament configure the package and compile its sources. The packages
of ROS 2 that Debian lacks are stand-ins: messages that Debian's rosidl generates, and rclcpp and tf2 of the tests. With
`whole` the tree around it is built, too, which takes a minute: the program starts and ends."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from checks import check, done, run, skip

package, stand_in = map(pathlib.Path, sys.argv[1:3])
whole = sys.argv[3:] == ["whole"]
if shutil.which("colcon") is None or not pathlib.Path("/usr/share/ament_cmake").is_dir():
    skip("colcon or ament_cmake is missing (tools/setup --tests installs them)")
MESSAGES = ("builtin_interfaces", "std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "tf2_msgs", "std_srvs")
SOURCES = ("ros2_node", "ros2_main", "node")
RUNTIME = ("rosidl_runtime_cpp", "rosidl_runtime_c", "rosidl_typesupport_interface")


def stand_for(prefix, name, folders):
    """A package of that name, whose target has these include folders."""
    place = prefix / "share" / name / "cmake"
    place.mkdir(parents=True)
    (place / f"{name}Config.cmake").write_text(
        f"add_library({name}::{name} INTERFACE IMPORTED)\n"
        f"target_include_directories({name}::{name} INTERFACE {' '.join(map(str, folders))})\n"
        f"set({name}_TARGETS {name}::{name})\n", encoding="utf-8")


def prepare(folder):
    messages = run_or_skip(folder / "messages")
    prefix = folder / "prefix"
    for name in MESSAGES[2:]:
        stand_for(prefix, name, [messages, *(messages / other for other in MESSAGES),
                                 *(f"/usr/include/{part}" for part in RUNTIME)])
    for name in ("rclcpp", "tf2"):
        stand_for(prefix, name, [stand_in])
    return prefix


def run_or_skip(folder):
    script = pathlib.Path(__file__).with_name("ros2_messages.py")
    ended = subprocess.run([sys.executable, "-B", script, folder], capture_output=True, text=True)
    if ended.returncode == 77:
        skip(ended.stdout.strip())
    check(ended.returncode == 0, ended.stdout + ended.stderr)
    return folder


with tempfile.TemporaryDirectory() as name:
    work = pathlib.Path(name)
    environment = {**os.environ, "CMAKE_PREFIX_PATH": str(prepare(work)), "COLCON_HOME": name, "MAKEFLAGS": "-j2"}
    target = [] if whole else ["--cmake-target", SOURCES[0] + ".o"]
    built = subprocess.run(["colcon", "build", "--base-paths", package, "--packages-select", "trim3r_ros", *target,
                            "--cmake-args", "-DCMAKE_BUILD_TYPE=None", f"-DPython3_EXECUTABLE={sys.executable}", "-Wno-dev"],
                           cwd=work, env=environment, capture_output=True, text=True)
    check(built.returncode == 0, built.stdout + built.stderr)
    if whole:
        installed = work / "install" / "trim3r_ros"
        told = run(installed / "lib" / "trim3r_ros" / "trim3r_node").stderr
        check("at most 10000 Gaussians" in told and "0 colour images" in told, f"the node starts and ends: {told}")
        check((installed / "share" / "trim3r_ros" / "package.xml").is_file(), "the package is installed")
    else:
        run("make", "-C", work / "build" / "trim3r_ros", *(source + ".o" for source in SOURCES[1:]))
        objects = [path.name for path in (work / "build" / "trim3r_ros" / "CMakeFiles").rglob("*.cpp.o")]
        check({source + ".cpp.o" for source in SOURCES} <= set(objects), f"every source is compiled: {objects}")
done()
