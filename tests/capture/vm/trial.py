# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder: one job in a virtual machine, and checks of its output."""
import json
import os
import time

import machine
from checks import check, done, skip  # noqa: F401

OUT_OF_TIME = 600  # seconds: a machine without KVM on a busy processor


class Trial:
    """The files in the machine's folder out after `job`; a failure shows the log and the files `told`."""

    def __init__(self, folder, programs, job, driver, told=(), **options):
        self.start, self.told = time.monotonic(), told
        self.files, self.accelerator, said = machine.run(os.path.abspath(folder), list(map(os.path.abspath, programs)),
                                                         job, OUT_OF_TIME, driver, **options)
        check("log" in self.files, f"the machine ({self.accelerator}) comes to its end:\n{said[-3000:]}")

    def check(self, condition, text):
        shown = "" if condition else "".join(
            f"\n--- {name}\n{self.text(name)[-3000:]}" for name in ("log", *self.told) if name in self.files)
        check(condition, f"{text}{shown}")

    def text(self, name):
        self.check(name in self.files, f"{name} is there")
        return self.files[name].decode(errors="replace")

    def json(self, name):
        self.check(self.text(name).strip() != "", f"{name} is not empty")
        return json.loads(self.files[name])

    def recorded(self, name, frames):
        """Checks NAME.live, .replay and .info, the results of a capture, its recording's replay and `info`. Returns
        the first."""
        live, replay, info = (self.json(f"{name}.{part}") for part in ("live", "replay", "info"))
        self.check(live["frames"] == frames, f"{name}: {live}")
        self.check(replay["frames_hash"] == live["frames_hash"], f"{name}: the replay's hash is the live one")
        self.check(info["frames"] == frames and info["note"] == "", f"{name}: {info}")
        return live

    def done(self):
        done()
        print(f"{self.accelerator}, {time.monotonic() - self.start:.0f} s")


# For jobs: captures, replays and inspects; the first argument names the results .live, .replay and .info. $through may
# hold a command that runs the capture.
RECORD = """
record() {
    name=$1
    shift
    $through trim3r capture --hash --json --quiet -o a.mcap "$@" > out/$name.live 2> out/$name.told
    status=$?
    trim3r capture --source replay:a.mcap --hash --json > out/$name.replay
    trim3r info --json a.mcap > out/$name.info
}
"""
