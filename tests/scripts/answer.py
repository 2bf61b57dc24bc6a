#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""answer.py TOOLS: every script that measures, and the demo, tells how it is used, and refuses what it does not know before it
does anything."""
import os
import sys

from checks import check, done, run
from common import need_opencv

tools = sys.argv[1]
scripts = os.path.join(tools, "study", "scripts")
PAGES = ("results", "paper", "stability", "colours", "stream", "cost", "speed", "formats")
WRONG = {  # beside an unknown option
    **{name: [["nothing"]] for name in PAGES},
    "gallery": [["room.mcap"], ["-o", "folder"], ["room.mcap", "-o", "folder", "--check"]],
    "live": [["--runs", "few"]],
    "pages": [["nothing"], ["results", "--all"], ["--minutes", "few"]],
    "paper": [["nothing"], ["--write", "--quick"], ["transfer", "--write"], ["--head-of", "x"]],
    "speed": [["nothing"], ["--rounds", "few"], ["--rounds", "0"]],
}

for folder, _, names in os.walk(tools):
    for path in (os.path.join(folder, name) for name in names):
        with open(path, "rb") as file:
            check(file.read(2) != b"#!" or os.access(path, os.X_OK), f"{path} is a script that does not start")

need_opencv()
for name in (*PAGES, "gallery", "live", "pages"):
    script = os.path.join(scripts, name)
    text = run(script, "--help").stdout
    check(text.startswith("usage: " + name) and f"tools/study/scripts/{name}" in text, f"{name} --help has a usage and examples")
    for wrong in [["--no-such-option"], *WRONG.get(name, [])]:
        check("error: " in run(script, *wrong, expect=2).stderr, f"{name} {wrong} is refused with a reason")
demo = os.path.join(tools, "demo")
check("tools/demo" in run(demo, "--help").stdout, "demo --help")
check("tools/demo" in run(demo, "--no-such-option", expect=2).stderr, "the demo takes no options")
done()
