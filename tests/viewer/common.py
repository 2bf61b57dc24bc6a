# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder."""

import browser  # noqa: F401
from checks import check, done, run, skip  # noqa: F401


def need_page(trim3r, folder):
    """Makes the room and a scene of it. The program must contain a page, else it was built without clang, lld and wasi-libc."""
    room, scene = f"{folder}/room.mcap", f"{folder}/scene.ply"
    run(trim3r, "room", "--size", "64x48", "-o", room)
    run(trim3r, "build", room, "--context", "0,2", "--keep", "10", "-o", scene)
    tried = run_any(trim3r, "view", scene, "-o", f"{folder}/page.html")
    if tried.returncode != 0 and "built without the page" in tried.stderr:
        skip("the program was built without clang, lld and wasi-libc (tools/setup --viewer)")
    return room, scene


def run_any(*command):
    import subprocess
    return subprocess.run([str(part) for part in command], capture_output=True, text=True)
