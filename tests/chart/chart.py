#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""chart.py TRIM3R: `trim3r chart` from outside: SVG, PNG and report, what is refused, tables of older versions."""
import json
import os
import random
import re
import struct
import sys
import tempfile
import xml.dom.minidom
import zlib

from checks import check, done, run
from common import built_in, made_up
from png import png

trim3r = sys.argv[1]
INPUT, USAGE = 1, 2


def elements(path, name, kind=None):
    found = xml.dom.minidom.parse(path).getElementsByTagName(name)
    return [e for e in found if kind is None or kind in e.getAttribute("class").split()]


def texts(path, name):
    return ["".join(c.data for c in e.childNodes if c.nodeType == c.TEXT_NODE) for e in elements(path, name)]


def read_png(path):
    """Width, height and the filtered rows of a PNG without interlacing: of the first pixel every filter keeps the colour."""
    with open(path, "rb") as file:
        data = file.read()
    check(data[:8] == b"\x89PNG\r\n\x1a\n", "a PNG")
    at, packed, width, height = 8, b"", 0, 0
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
            check((depth, colour) == (8, 2), "8 bits of red, green, blue")
        packed += data[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += 12 + size
    return width, height, zlib.decompress(packed)


def draws(folder):
    table, svg, png = made_up(f"{folder}/t.csv"), f"{folder}/t.svg", f"{folder}/t.png"
    run(trim3r, "chart", table, "--svg", svg, "--png", png)
    check(texts(svg, "text").count("PSNR") == 4, "a panel a cost")
    for title in ("Build time", "Render time", "Arena", "Scene"):
        check(title in texts(svg, "text"), f"the axis {title}")
    titles = texts(svg, "title")
    check(sum("best, 100 % kept: " in t for t in titles) == 4, "settings under the pointer, in every panel")
    check(any("30.85 dB" in t and "630 ms" in t and "on the front" in t for t in titles),
          f"the mean over scenes: {titles}")
    check(not any("worse" in t and "on the front" in t for t in titles), "what is beaten is not on the front")
    check(len(elements(svg, "circle", "ring")) == sum("on the front" in t for t in titles), "the front is ringed")
    check("prefers-color-scheme:dark" in open(svg, encoding="utf-8").read(), "it follows the reader")
    width, height, pixels = read_png(png)
    check(width == 2080 and len(pixels) == height * (1 + 3 * width), "pixels, twice as many as the picture says")
    check(len(set(pixels)) > 50, "something is drawn")
    run(trim3r, "chart", table, "--png", f"{folder}/dark.png", "--dark", "--against", "build_ms", "--scene", "room1")
    check(tuple(pixels[1:4]) == (0xfb, 0xfa, 0xf8), "light is light")
    check(tuple(read_png(f"{folder}/dark.png")[2][1:4]) == (0x16, 0x18, 0x1b), "dark is dark")
    run(trim3r, "chart", table, "--svg", svg, "--quality", "ssim", "--against", "scene_bytes,arena_bytes")
    check("SSIM against scene and arena" in texts(svg, "text"), "what was asked for")
    again = f"{folder}/again.svg"
    run(trim3r, "chart", table, table, "--svg", again, "--quality", "ssim", "--against", "scene_bytes,arena_bytes")
    check(open(svg, encoding="utf-8").read() == open(again, encoding="utf-8").read(), "a table twice is the table")


def reports(folder):
    tables, folders = built_in(trim3r, folder)
    page = f"{folder}/report.html"
    run(trim3r, "chart", *tables, "--pictures", folders[0], "--pictures", folders[1], "-o", page)
    text = open(page, encoding="utf-8").read()
    check("Whole-picture SSIM" in text, "the whole picture can be chosen")
    run(trim3r, "chart", tables[0], "--svg", f"{folder}/whole.svg", "--quality", "psnr_all", "--against", "build_ms")
    check("Whole-picture PSNR against build time" in texts(f"{folder}/whole.svg", "text"), "and drawn")
    check("http" not in text.replace("http://www.w3.org/2000/svg", "").replace("http-equiv", ""), "nothing is fetched")
    rows = sum(open(t, encoding="utf-8").read().count(".png") for t in tables)
    scenes = {line.split(",")[0] for t in tables for line in open(t, encoding="utf-8").read().splitlines()[1:]}
    check(len(scenes) == 2 and rows > 20, f"{rows} rows")
    check(text.count("<script type=\"text/plain\"") > rows, "a picture a row, targets and masks")
    check("trim3r \u00b7 refine 0" in text and "unless named, small, 8 bits, refine 8" in text, "names")
    small = f"{folder}/small.html"
    run(trim3r, "chart", *tables, "--pictures", folders[0], "--pictures", folders[1], "-o", small, "--picture-mib", "1")
    check(os.path.getsize(small) <= os.path.getsize(page), "no more pictures than there is room for")
    told = run(trim3r, "chart", tables[0], "-o", f"{folder}/bare.html", "--pictures", folders[1])
    check("not in the folders" in told.stderr, "pictures that are missing")
    run(trim3r, "chart", tables[0], "-o", f"{folder}/bare.html")
    check("<script type=\"text/plain\"" not in open(f"{folder}/bare.html", encoding="utf-8").read(), "without pictures")
    with open(f"{folder}/hostile.csv", "w", encoding="utf-8") as file:
        file.write("scene,method,psnr,build_ms\n</script><script>alert(1)</script>,\"<b>&'\"\"\",20,5\n")
    run(trim3r, "chart", f"{folder}/hostile.csv", "-o", page, "--svg", f"{folder}/hostile.svg")
    check("alert(1)</script>" not in open(page, encoding="utf-8").read(), "texts of a table stay texts")
    check("<b>&'\"" in texts(f"{folder}/hostile.svg", "text"), "and are shown as they are")


def noise(path, side, seed):
    """Writes a PNG that hardly compresses."""
    dice = random.Random(seed)
    with open(path, "wb") as file:
        file.write(png([dice.randbytes(3 * side) for _ in range(side)], level=0))


def small_reports(folder):
    """A report stays below 4 MB unless an option allows more; the front's pictures have priority."""
    table = made_up(f"{folder}/many.csv", scenes=1, cases=1)
    with open(table, encoding="utf-8") as file:
        heading, *rows = file.read().splitlines()
    with open(table, "w", encoding="utf-8") as file:
        file.write("\n".join([heading + ",picture", *(f"{row},{i}.png" for i, row in enumerate(rows))]) + "\n")
    for i in range(len(rows)):
        noise(f"{folder}/{i}.png", 400, i)
    page, whole = f"{folder}/some.html", f"{folder}/whole.html"
    run(trim3r, "chart", table, "--pictures", folder, "-o", page)
    run(trim3r, "chart", table, "--pictures", folder, "-o", whole, "--all-pictures")
    check(os.path.getsize(page) < 4_000_000 < os.path.getsize(whole), f"{os.path.getsize(page)} bytes by default")
    with open(page, encoding="utf-8") as file:
        data = json.loads(re.search(r'id="data">(.*?)</script>', file.read(), re.S)[1])
    shown = {data["series"][point["series"]]["name"] for point in data["points"]
             for cell in point["cells"] if cell[1] is not None}
    check(shown and "worse" not in shown, f"what is on the front is shown first: {shown}")


def older(folder):
    """Tables that eval wrote before it reported wavelet, levels, clusters, bytes of the scene and pictures."""
    old, new = f"{folder}/old.csv", f"{folder}/new.svg"
    with open(old, "w", encoding="utf-8") as file:
        file.write("scene,context,target,method,head,bits,refine,allocate,depth,ablation,keep,gaussians,psnr,build_ms\r\n"
                   "room,\"0,2\",1,trim3r,small,8,4,density,sensor,,10,13107,31,200\r\n"
                   "room,\"0,2\",1,trim3r,small,8,4,density,sensor,,5,6553,30,150\r\n")
    run(trim3r, "chart", old, "--svg", new)
    check("PSNR against build time" in texts(new, "text"), "the costs that there are")
    told = run(trim3r, "chart", old, "-o", f"{folder}/old.html", "--pictures", folder)
    check("no table names pictures" in told.stderr, "pictures that no table names")
    run(trim3r, "chart", old, made_up(f"{folder}/t.csv"), "--svg", new)


def refuses(folder):
    table = made_up(f"{folder}/t.csv")

    def refuse(status, words, *arguments):
        result = run(trim3r, "chart", *arguments, expect=status)
        for word in words.split("|"):
            check(word in result.stderr, f"chart {arguments}: '{word}' is not in: {result.stderr}")

    out = ("--svg", f"{folder}/never.svg")
    refuse(USAGE, "EVAL.csv is missing", *out)
    refuse(USAGE, "there is no output", table)
    refuse(USAGE, "--pictures belongs", table, *out, "--pictures", folder)
    refuse(USAGE, "one folder for all", table, "-o", f"{folder}/never.html", "--pictures", folder, "--pictures", folder)
    refuse(USAGE, "--dark belongs", table, *out, "--dark")
    refuse(USAGE, "--quality takes", table, *out, "--quality", "sharp")
    refuse(USAGE, "--against takes", table, *out, "--against", "build_ms,psnr")
    refuse(USAGE, "--against takes", table, *out, "--against", "build_ms,")
    refuse(USAGE, "names build_ms twice", table, *out, "--against", "build_ms,build_ms")
    refuse(USAGE, "--picture-mib", table, *out, "--picture-mib", "0")
    refuse(INPUT, "no scene 'attic'", table, *out, "--scene", "attic")
    refuse(INPUT, "no row|planar_psnr", table, *out, "--quality", "planar_psnr")
    refuse(INPUT, "gone.csv", f"{folder}/gone.csv", *out)
    refuse(INPUT, folder, folder, *out)
    bad = f"{folder}/bad.csv"
    for text, words in (("psnr,build_ms\n1,2\n1\n", "bad.csv:3: 1 cells"), ("psnr,build_ms\n1,inf\n", "bad.csv:2: build_ms"),
                        ("psnr,build_ms\n1,\"2\n", "bad.csv:2: a quote"), ("", "bad.csv:1: the table is empty"),
                        ("psnr,build_ms\n,2\n", "no row"), ("psnr,build_ms\n1," + "9" * 400 + "\n", "bad.csv:2")):
        with open(bad, "w", encoding="utf-8") as file:
            file.write(text)
        refuse(INPUT, words, bad, *out)
    with open(bad, "wb") as file:
        file.write(bytes(range(128, 256)) * 40)
    refuse(INPUT, "bad.csv:1: bytes that are no printable UTF-8", bad, *out)
    os.mkdir(f"{folder}/wrong")
    with open(f"{folder}/wrong/x.png", "wb") as file:
        file.write(b"no picture")
    with open(bad, "w", encoding="utf-8") as file:
        file.write("psnr,build_ms,picture\n1,2,x.png\n")
    refuse(INPUT, "wrong/x.png", bad, "-o", f"{folder}/never.html", "--pictures", f"{folder}/wrong")
    refuse(INPUT, "nowhere", table, "--svg", f"{folder}/nowhere/x.svg")
    refuse(INPUT, "nowhere", table, "--png", f"{folder}/nowhere/x.png")
    refuse(INPUT, "nowhere", table, "-o", f"{folder}/nowhere/x.html")
    check(not any(name.startswith("never") for name in os.listdir(folder)), "nothing is left of what failed")


for part in (draws, reports, small_reports, older, refuses):
    with tempfile.TemporaryDirectory() as where:
        part(where)
done()
