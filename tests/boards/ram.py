#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""ram.py TRIM3R FOLDER: runs the settings that `trim3r plan` gives for 128 KiB of RAM on an emulated Cortex-M3.

The board has exactly so much RAM. It holds data, a strip of a frame, the picture, the arena and the stack. The bits
must be those of this machine, and the firmware must reset its watchdog in time."""
import json
import pathlib
import re
import shutil
import sys
from types import SimpleNamespace

import cortex_m
from checks import check, done, near, skip
from firmware import FEATURES, run, words
from reference import host, recording

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

PAGE = (ROOT / "docs" / "study" / "boards.md").read_text()
RAM_PAGE = (ROOT / "docs" / "ram.md").read_text()
BOARD, SIZE, RAM = "mps2-an385", "128K", 128 << 10
STRETCH_MOST = 20_000_000

if any(shutil.which(tool) is None for tool in cortex_m.TOOLS):
    skip("no cross compiler or emulator here")
program, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
settings = json.loads(run(program, "plan", "--ram", SIZE, "--json"))
options = SimpleNamespace(program=program, out=folder, recording=None, size=(settings["width"], settings["height"]),
                          views=settings["views"], gaussians=settings["gaussians"], clusters=0, refine=settings["refine"],
                          head=settings["head"], optimize="-O2", lto=False, clang=False, features=FEATURES, ram=RAM)
path = recording(options)
elf = cortex_m.firmware_of(BOARD, options)
places = {line.split()[-1]: int(line.split()[0], 16) for line in run("arm-none-eabi-nm", elf).splitlines()}
check(places["stack_top_at"] - places["data_begin_at"] == RAM, "RAM has as many bytes as it should")
said = cortex_m.start(BOARD, elf, [*words(path, options), "hashes=1"])
whole, stages = host(path, options)
check(said["hash final"] == whole, f"the board has the bits of this machine: {said['hash final']}, {whole}")
check(all(said[f"hash {stage}"] == hash_of for stage, hash_of in stages.items()), "of every stage")
check(int(said["gaussians"]) == settings["gaussians"], "the budget is exact")
taken = sum(int(said[f"{part}_bytes"]) for part in ("data", "memory", "stack_room"))
check(taken <= RAM and int(said["stack_bytes"]) <= settings["stack_bytes"], f"{taken} bytes of RAM: {said}")
shown = re.search(r"\n## 128 KiB of RAM\n.*?\n\| RAM, bytes \| ([\d,]+) \|", PAGE, re.S)
check(shown is not None, "docs/study/boards.md shows the settings for 128 KiB")
used = sum(int(said[f"{part}_bytes"]) for part in ("data", "memory", "stack"))
near(used, float(shown[1].replace(",", "")), 0.02 * RAM, "RAM as on the page")
check(int(said["arena_bytes"]) >= int(said["arena_min_bytes"]), "the arena is no smaller than the least")
dealt = sum(settings[f"{part}_bytes"] for part in ("strip", "target")) + int(said["arena_bytes"])
check(int(said["memory_bytes"]) <= dealt + 3 * 64, f"of a frame no more than a strip is in memory: {said}")
_, longest = cortex_m.count(BOARD, elf, words(path, options), options)
check(longest <= STRETCH_MOST, f"a watchdog is fed every {STRETCH_MOST:,} instructions: {longest:,}")

counts = re.search(rf"^\| {SIZE} \|.* \| ([\d,]+) / ([\d,]+) \| [\d.]+ \|", RAM_PAGE, re.M)
check(counts is not None, "docs/ram.md shows the instructions on both boards")
for board, figure in zip(("mps2-an500", "mps3-an547"), (float(text.replace(",", "")) for text in counts.groups())):
    stages, _ = cortex_m.count(board, cortex_m.firmware_of(board, options), [*words(path, options), "plain=0"], options)
    near(sum(stages.values()) / 1e6, figure, 0.02 * figure, f"{board}: instructions as on the page")
done()
