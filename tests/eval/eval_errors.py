#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""eval_errors.py TRIM3R: every wrong use of `trim3r eval` gives a message with the place, and the right exit status."""
import os
import resource
import sys
import tempfile

from checks import check, done, run
from png import png

trim3r = sys.argv[1]
INPUT, USAGE, BUDGET = 1, 2, 3


def refuse(status, *words_and_arguments):
    """refuse(STATUS, "word", ..., [arguments]): expects every word on stderr, and nothing like a score on stdout."""
    *words, arguments = words_and_arguments
    result = run(trim3r, "eval", *arguments, expect=status)
    for word in words:
        check(word in result.stderr, f"eval {arguments}: '{word}' is not in: {result.stderr}")


with tempfile.TemporaryDirectory() as folder:
    room = f"{folder}/room.mcap"
    run(trim3r, "room", "--size", "64x64", "-o", room)
    one = [room, "--context", "0,2", "--target", "1"]

    refuse(USAGE, "REC.mcap is missing", ["--keep", "10"])
    refuse(USAGE, "the budget is missing", one)
    refuse(USAGE, "--context and --target", [room, "--context", "0,2", "--keep", "10"])
    refuse(USAGE, "--context and --target", [room, "--target", "1", "--keep", "10"])
    for keep in ("0", "101", "10,", "ten", "-5", ""):
        refuse(USAGE, "--keep takes percentages", [*one, f"--keep={keep}"])
    for context, why in {"0,": "takes numbers", "a": "takes numbers", ",".join(str(i) for i in range(17)): "names too many"}.items():
        refuse(USAGE, f"--context {why}", [room, "--context", context, "--target", "1", "--keep", "10"])
    refuse(USAGE, "--target takes", [room, "--context", "0,2", "--target", "1,3", "--keep", "10"])
    refuse(USAGE, "--depth", [*one, "--keep", "10", "--depth", "radar"])
    refuse(USAGE, "--head", [*one, "--keep", "10", "--head", "huge"])
    refuse(USAGE, "--heads", [*one, "--keep", "10", "--heads", "small,huge"])
    refuse(USAGE, "--heads", [*one, "--keep", "10", "--heads", "small,"])
    refuse(USAGE, "exclude", [*one, "--keep", "10", "--heads", "small", "--head", "tiny"])
    refuse(USAGE, "same name and bits", [*one, "--keep", "10", "--heads", "small,tiny,small"])
    with open(f"{folder}/bad.t3w", "wb") as file:
        file.write(b"T3RW" + bytes(100))
    result = run(trim3r, "eval", *one, "--keep", "10", "--heads", f"analytic,{folder}/bad.t3w", expect=INPUT)
    check("bad.t3w: a weight file of another format" in result.stderr and result.stdout == "", "a bad head among others")
    refuse(USAGE, "--size belongs to --planar", [*one, "--keep", "10", "--size", "32x32"])
    refuse(USAGE, "--size takes", ["--planar", room, "--keep", "10", "--size", "32"])
    refuse(USAGE, "--size takes", ["--planar", room, "--keep", "10", "--size", "4x4"])
    refuse(USAGE, "--planar takes images", ["--planar", *one, "--keep", "10"])
    refuse(USAGE, "--working belongs", ["--planar", room, "--keep", "10", "--working", "32x32"])
    refuse(USAGE, "the same name", [room, room, "--keep", "10"])
    refuse(USAGE, "IMAGE... is missing", ["--planar", "--keep", "10"])

    refuse(INPUT, f"{folder}/none.mcap", [f"{folder}/none.mcap", "--keep", "10"])
    refuse(INPUT, room, "no frame 999", [room, "--context", "0,2", "--target", "999", "--keep", "10"])
    refuse(INPUT, room, "no frame 999", [room, "--context", "0,999", "--target", "1", "--keep", "10"])
    refuse(BUDGET, "too small", [*one, "--keep", "10", "--arena", "1000"])

    for name, data in (("empty.mcap", b""), ("text.mcap", b"not a recording, but long enough to be looked at\n" * 9)):
        with open(f"{folder}/{name}", "wb") as file:
            file.write(data)
        refuse(INPUT, name, [f"{folder}/{name}", "--keep", "10"])
        refuse(INPUT, name, [room, f"{folder}/{name}", "--keep", "10"])
        refuse(INPUT, name, ["--planar", f"{folder}/{name}", "--keep", "10"])
    with open(f"{folder}/deep.png", "wb") as file:
        file.write(png([bytes(2 * 16)] * 16, 16, 1))
    refuse(INPUT, "deep.png", ["--planar", f"{folder}/deep.png", "--size", "8x8", "--keep", "10"])
    refuse(INPUT, "none.png", ["--planar", f"{folder}/none.png", "--keep", "10"])

    below = f"{room}/below"
    refuse(INPUT, below, [*one, "--keep", "10", "--csv", below])
    refuse(INPUT, room, [*one, "--keep", "10", "--images", below])
    refuse(INPUT, below, [*one, "--keep", "10", "--html", below])
    # a full disk: no file grows beyond 256 bytes
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    for option in ("--csv", "--html", "--images"):
        resource.setrlimit(resource.RLIMIT_FSIZE, (256, limits[1]))
        refuse(INPUT, f"{folder}/full", [*one, "--keep", "100,50,20,10", option, f"{folder}/full"])
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        if option == "--html":
            check(not [name for name in os.listdir(folder) if "full" in name], "half a page is left")
        elif option == "--csv":
            os.remove(f"{folder}/full")
    # reported before the work: no row is printed
    result = run(trim3r, "eval", *one, "--keep", "10", "--html", folder, expect=INPUT)
    check("not a regular file" in result.stderr and result.stdout == "", "a folder as page")
    os.environ["TMPDIR"] = below
    refuse(INPUT, "TMPDIR", [*one, "--keep", "10", "--from-file"])
    text = run(trim3r, "eval", "--help").stdout
    check("Examples:" in text and "--planar" in text, "the help has examples")
done()
