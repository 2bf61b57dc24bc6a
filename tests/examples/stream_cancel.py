#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stream_cancel.py TRIM3R STREAM_CANCEL: with time each frame becomes a keyframe; without time each is cancelled, and the
map stays valid."""
import re
import tempfile

from checks import check, done, run
from common import EXAMPLE, room

FRAMES, MOST = 4, 1500

with tempfile.TemporaryDirectory() as folder:
    room(f"{folder}/walk.mcap", 128, FRAMES)
    for limit, outcome in ((1_000_000, "taken"), (0, "cancelled")):
        said = run(EXAMPLE, f"{folder}/walk.mcap", limit).stdout
        lines = re.findall(r"^frame (\d+): (\w+), (\d+) Gaussians$", said, re.M)
        check([int(line[0]) for line in lines] == list(range(FRAMES)), f"every frame: {said}")
        check({line[1] for line in lines} == {outcome}, f"a limit of {limit} ms: {said}")
        check(all((0 < int(line[2]) <= MOST) == (outcome == "taken") for line in lines), f"the map: {said}")
done()
