#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""replay.py TRIM3R REPLAY_TEST: a recording passes against the results stored with it, and fails with one bit of a
sample changed, with a digit of the results changed, truncated, extended, or with another recording."""
import tempfile

from checks import check, done, run
from common import EXAMPLE, room, without_crc

SIDE = 128
STAGES = ["image", "depth", "pointmap", "wavelet", "superclusters", "budget", "head", "refine", "raster"]


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)
    return path


def changed(data, sample, bit):
    """Flips one bit of a message's bytes."""
    at = data.index(sample[0]) + sample[1]
    return data[:at] + bytes([data[at] ^ 1 << bit]) + data[at + 1:]


with tempfile.TemporaryDirectory() as folder:
    recording, expected, other = f"{folder}/room.mcap", f"{folder}/room.txt", f"{folder}/other.mcap"
    colours, depths = room(recording, SIDE, 5)
    with open(recording, "rb") as file:
        data = file.read()
    told = run(EXAMPLE, recording).stdout
    check([line.split()[:3] for line in told.splitlines()] ==
          [["frame", frame, stage] for frame in "134" for stage in STAGES], told)
    write(expected, told.encode())

    def fails(words, path=recording, against=expected):
        ended = run(EXAMPLE, path, against, expect=1)
        for word in [words] if isinstance(words, str) else words:
            check(word in ended.stdout, f"'{word}' is not in '{ended.stdout}'")

    check(run(EXAMPLE, recording, expected).stdout == "", "the same bits")
    run(EXAMPLE, write(other, without_crc(data)), expected)
    middle = SIDE * SIDE // 2 + SIDE // 2
    for frame, build in ((0, 1), (3, 3), (4, 4)):
        for image, at in ((colours[frame], 3 * middle + 1), (depths[frame], 2 * middle)):
            fails([f"frame {build} image", "expected: frame"], write(other, without_crc(changed(data, (image, at), 0))))
    run(EXAMPLE, write(other, changed(data, (colours[0], 0), 0)), expected, expect=2)  # the file's own CRC

    for stage in STAGES[::4]:
        at = told.index(f"frame 3 {stage} ") + len(f"frame 3 {stage} ")
        digit = "1" if told[at] == "0" else "0"
        fails(f"expected: frame 3 {stage} {digit}",
              against=write(f"{folder}/wrong.txt", (told[:at] + digit + told[at + 1:]).encode()))
    lines = told.splitlines(keepends=True)
    fails("expected: nothing", against=write(f"{folder}/short.txt", "".join(lines[:-1]).encode()))
    fails("ends too soon", against=write(f"{folder}/long.txt", (told + lines[-1]).encode()))
    fails("frame 1 image", against=write(f"{folder}/empty.txt", b""))
    room(other, SIDE, 4)
    fails("ends too soon", path=other)
    run(EXAMPLE, f"{folder}/none.mcap", expect=2)
    run(EXAMPLE, recording, f"{folder}/none.txt", expect=2)
done()
