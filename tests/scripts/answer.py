#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""answer.py TOOLS DOCS: every script that measures, and the demo, prints its usage, and refuses unknown options
before it does anything; pages begin as their scripts would write them."""
import os
import re
import sys

from common import check, done, need_opencv, run

tools, docs = sys.argv[1:3]
scripts = os.path.join(tools, "study", "scripts")
SCRIPTS = ("auto", "formats", "growth", "live", "pages", "paper", "peers", "poses", "results", "speed", "stability", "stereo_results",
           "stream")
WRONG = {  # next to an unknown option
    "growth": [["colour"], ["size", "--write"], ["--quick", "--write"]],
    "live": [["--runs", "few"]],
    "pages": [["nothing"], ["auto", "--all"]],
    "paper": [["nothing"], ["--write", "--quick"], ["views", "--write"], ["--tuned-pruned", "101"], ["--head-of", "x"]],
    "peers": [["--rounds", "few"], ["--rounds", "0"], ["--write", "--only", "kmeans"], ["--only", "sorting"]],
    "poses": [["--jobs", "some"], ["nothing"]],
    "results": [["nothing"], ["heads", "--write"]],
    "speed": [["--runs", "few"], ["nothing"], ["--recorded", "--runs", "3"]],
    "stability": [["--jobs", "some"], ["room"]],
    "stereo_results": [["hololens_b", "--write"]],
}

for folder, _, names in os.walk(tools):
    for path in (os.path.join(folder, name) for name in names):
        with open(path, "rb") as file:
            check(file.read(2) != b"#!" or os.access(path, os.X_OK), f"{path} is a script that does not start")

need_opencv()
for name in SCRIPTS:
    script = os.path.join(scripts, name)
    text = run(script, "--help").stdout
    check(text.startswith("usage: " + name) and f"tools/study/scripts/{name}" in text, f"{name} --help has a usage and examples")
    for wrong in [["--no-such-option"], *WRONG.get(name, [])]:
        check("error: " in run(script, *wrong, expect=2).stderr, f"{name} {wrong} is refused with a reason")
demo = os.path.join(tools, "demo")
check("tools/demo" in run(demo, "--help").stdout, "demo --help")
check("tools/demo" in run(demo, "--no-such-option", expect=2).stderr, "the demo takes no options")

for name, page in {"auto": "auto.md", "stream": "stream.md"}.items():
    with open(os.path.join(scripts, name), encoding="utf-8") as file:
        head = re.search(r'^HEAD = """(.*?)"""$', file.read(), flags=re.M | re.S).group(1)
    with open(os.path.join(docs, "study", page), encoding="utf-8") as file:
        begins = re.escape(head + "\n| scene |").replace("EPOCH", r"\d+")
        check(re.match(begins, file.read()), f"{page} does not begin as tools/study/scripts/{name} --write makes it")
done()
