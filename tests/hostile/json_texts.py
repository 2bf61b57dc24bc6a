#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""json_texts.py TRIM3R: every reader of JSON refuses text after the JSON, a name twice in one object, and \\u0000, each of
which programs read differently.

MADE has a file of each kind that is read, the command that reads it, and where its JSON lies.
"""
import io
import json
import os
import pathlib
import re
import shutil
import stat
import struct
import sys
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "import")]

import folder_makers
from checks import check
from program import HEADS, TRIM3R, expect, in_scratch, run

SOURCES = HERE.parent.parent
# Where JSON of others is parsed: the function that all readers of the tools share, and that of heads.
PARSERS = {"tools/cli/tables/json_input.c", "quant/json_object.c"}


def glb(data, text=None):
    """Returns the JSON of a .glb; or the file with another one."""
    count = struct.unpack_from("<I", data, 12)[0]
    if text is None:
        return data[20:20 + count].decode().rstrip(" ")
    packed = text.encode() + b" " * (-len(text.encode()) % 4)
    rest = data[20 + count:]
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(packed) + len(rest), len(packed), 0x4e4f534a) + packed + rest


def sog(data, text=None):
    with zipfile.ZipFile(io.BytesIO(data)) as old:
        if text is None:
            return old.read("meta.json").decode()
        made = io.BytesIO()
        with zipfile.ZipFile(made, "w") as new:
            for name in old.namelist():
                new.writestr(name, text if name == "meta.json" else old.read(name))
        return made.getvalue()


def header(data, text=None):
    count = struct.unpack_from("<Q", data)[0]
    if text is None:
        return data[8:8 + count].decode().rstrip(" ")
    return struct.pack("<Q", len(text.encode())) + text.encode() + data[8 + count:]


def graph(data, text=None):
    """Returns the JSON within the header's JSON."""
    outer = json.loads(header(data))
    if text is None:
        return outer["__metadata__"]["trim3r"]
    outer["__metadata__"]["trim3r"] = text
    return header(data, json.dumps(outer))


def whole(data, text=None):
    return data.decode() if text is None else text.encode()


def made():
    """Makes a file for each reader. Returns (file, where its JSON lies, command)."""
    folder_makers.make_room()
    folder_makers.transforms("nerf")
    folder_makers.record3d("record", as_exr=True)
    folder_makers.record3d("r3d")
    build = "build", "room.mcap", "--context", "0,2", "--gaussians", 50
    for suffix in ("ply", "glb", "sog"):
        expect(0, *build, "-o", f"scene.{suffix}")
    replay = "replay", "room.mcap", "--context", "0,2", "--gaussians", 50
    pathlib.Path("golden.json").write_text(run(*replay, "--json")[1])
    pathlib.Path("pose.json").write_text(json.dumps({"fl_x": 60, "w": 64, "h": 48, "transform_matrix": [
        [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}))
    expect(0, "bench", "--calibrate", "--runs", 1, "-o", "machine.json")
    shutil.copy(os.path.join(HEADS, "small.safetensors"), "head.safetensors")
    pathlib.Path("bench.json").write_text(run("bench", "--json", "--runs", 1, "--stages", "kmeans_ms")[1])
    other = pathlib.Path("other")
    other.write_text(f"""#!/bin/sh
case "$*" in
  *--json*) exec cat "${{0%/*}}/bench.json" ;;
  *) exec {TRIM3R} "$@" ;;
esac
""")
    other.chmod(other.stat().st_mode | stat.S_IXUSR)
    return (("nerf/transforms.json", whole, ("import", "nerf", "-o", "made.mcap", "--force")),
            ("record/metadata.json", whole, ("import", "record", "-o", "made.mcap", "--force")),
            ("r3d/metadata", whole, ("import", "r3d", "-o", "made.mcap", "--force")),
            ("pose.json", whole, ("render", "scene.ply", "--pose", "pose.json", "-o", "made.png")),
            ("golden.json", whole, (*replay, "--expect", "golden.json")),
            ("machine.json", whole, ("plan", "--size", "64x64", "--keep", 10, "--machine", "machine.json")),
            ("bench.json", whole, ("bench", "--runs", 1, "--stages", "kmeans_ms", "--against", os.path.abspath("other"))),
            ("scene.glb", glb, ("convert", "scene.glb", "-o", "made.ply")),
            ("scene.sog", sog, ("convert", "scene.sog", "-o", "made.ply")),
            ("head.safetensors", header, ("head-info", "head.safetensors")),
            ("head.safetensors", graph, ("head-info", "head.safetensors")))


def changes(text):
    """Yields (what, the text with a fault, words of the refusal)."""
    text = text.strip()
    names = [match for match in re.finditer(r'[{,]\s*"([^"\\]+)"\s*:', text)]
    check(names, f"no name in {text[:60]}")
    yield "text after it", text + " x", "follows|one JSON"
    yield "JSON after it", text + "\n{}", "follows|one JSON"
    for match in (names[0], names[-1]):
        at, name = match.start() + 1, match[1]
        yield "a name twice", f'{text[:at]}"{name}":null,{text[at:]}', "twice"
        yield "a name twice, once escaped", f'{text[:at]}"\\u{ord(name[0]):04x}{name[1:]}":null,{text[at:]}', "twice"
        yield "a zero in a name", f'{text[:at]}"{name}\\u0000":null,{text[at:]}', "u0000"
        yield "a zero in a value", f'{text[:at]}"more":"a\\u0000b",{text[at:]}', "u0000"
        yield "a zero after a backslash", f'{text[:at]}"more":"\\\\\\u0000",{text[at:]}', "u0000"


def check_readers():
    for path, part, command in made():
        path = pathlib.Path(path)
        data = path.read_bytes()
        text = part(data)
        path.write_bytes(part(data, text))
        expect(0, *command)
        for what, faulty, words in changes(text):
            path.write_bytes(part(data, faulty))
            status, _, error = run(*command)
            check(status == 1 and re.search(words, error), f"{path}, {what}: {status} {error}")
        path.write_bytes(data)
        expect(0, *command)


def check_parsers():
    """No other source parses JSON, so that the list above cannot lack one."""
    found = {path.relative_to(SOURCES).as_posix() for part in ("quant", "platform", "tools")
             for path in (SOURCES / part).rglob("*.c") if re.search(r"\bcJSON_Parse", path.read_text())}
    check(found == PARSERS, f"JSON is parsed in {sorted(found)}")


in_scratch(check_readers, check_parsers)
