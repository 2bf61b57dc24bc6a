# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts of this folder; the program is their first argument, the example their second."""
import os
import pathlib
import sys

import mcap_read
from checks import check, done, run  # noqa: F401

TRIM3R, EXAMPLE = (os.path.abspath(path) for path in sys.argv[1:3])
ROOT = pathlib.Path(__file__).resolve().parents[2]


def room(path, side, frames):
    """Makes the built-in recording; returns the samples of its colour and depth images."""
    run(TRIM3R, "room", "--size", f"{side}x{side}", "--frames", frames, "--unchunked", "-o", path)
    with open(path, "rb") as file:
        found = list(mcap_read.messages(file.read()))
    colours, depths = ([message for topic, _, message in found if topic.endswith(name)]
                       for name in ("/image", "/depth"))
    check(len(colours) == len(depths) == frames, f"{path}: {[topic for topic, _, _ in found]}")
    return [message[-3 * side * side:] for message in colours], [message[-2 * side * side:] for message in depths]


def without_crc(data):
    """Removes the CRC of the data section, for a recording without chunks: it is in the record DataEnd, opcode 15,
    four bytes long; 0 means none."""
    at = data.rindex(b"\x0f" + (4).to_bytes(8, "little"))
    return data[:at + 9] + bytes(4) + data[at + 13:]
