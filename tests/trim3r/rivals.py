#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""rivals.py TRIM3R: scenes of the rivals by `trim3r build`."""

from program import beyond, check, expect, expect_json, in_scratch, room, write


def vertices(path, count=68):
    """Returns the rows of a scene file as a set, or their first `count` bytes: 12 are the positions."""
    body = open(path, "rb").read().split(b"end_header\n", 1)[1]
    return {body[i:i + count] for i in range(0, len(body), 68)}


def with_a_rim():
    """Every method has the rim of trim3r's scenes: a rival that left it out would lose for that alone."""
    build = ["build", room(), "--context", "0,2", "--working", "32x32", "--refine", 1, "--gaussians", 800]
    expect_json(*build, "-o", "ours.ply")
    count = beyond("ours.ply")
    check(count > 0, "a scene of trim3r has no rim")
    for method in ("random", "pup", "random+finetune", "efficientgs+finetune", "eagles+head", "trim3r+finetune"):
        quick = ("--finetune-iterations", 3) if "+finetune" in method else ()
        found = expect_json(*build, "--method", method, *quick, "-o", "rim.ply")
        check(found["gaussians"] == 800 and beyond("rim.ply") == count, f"{method} has {beyond('rim.ply')} of {count}")
        expect_json(*build, "--method", method, *quick, "--rim", "off", "-o", "none.ply")
        check(beyond("none.ply") == 0, f"{method} has a rim that is off")
    expect_json(*build, "--method", "random", "-o", "rim.ply")
    expect_json("build", room(), "--context", "0,2", "--working", "32x32", "--prune", "rim.ply", "--method", "eagles",
                "--gaussians", 780, "-o", "pruned.ply")
    check(beyond("pruned.ply") == count, "a pruned file loses its rim")


def rivals():
    """Scenes of the rivals: exact counts, Gaussians of the unpruned scene or fine-tuned ones; no hash."""
    recording = room()
    small = ["build", recording, "--context", "0,2", "--working", "32x32", "--refine", 1, "--rim", "off"]
    whole = expect_json(*small, "--keep", 100, "--comments", "-o", "whole.ply")
    check("hash" in whole and whole["method"] == "trim3r", "a scene of trim3r has its hash")
    for rival in ("random", "eagles", "lightgaussian", "pup", "efficientgs"):
        found = expect_json(*small, "--gaussians", 300, "--method", rival, "-o", "rival.ply")
        check(found["gaussians"] == 300 and found["requested"] == 300, f"{rival} does not meet its count")
        check("hash" not in found and "allocate" not in found, "a scene of a rival promises bits")
        check(found["valid_points"] == whole["valid_points"] and found["head"] == "small", "what was pruned")
        check(vertices("rival.ply") < vertices("whole.ply"), f"{rival} changes what it keeps")
    tuned = expect_json(*small, "--gaussians", 300, "--method", "efficientgs+finetune", "--finetune-iterations", 2,
                        "-o", "tuned.ply")
    check(tuned["gaussians"] == 300 and "hash" not in tuned, "fine-tuning keeps the count")
    check(not vertices("tuned.ply") & vertices("rival.ply"), "fine-tuning leaves Gaussians as they are")
    for number, option in enumerate((("--finetune-rounds", 1), ("--finetune-start", "pruned"), ("--finetune-rates", "published"))):
        expect_json(*small, "--gaussians", 300, "--method", "efficientgs+finetune", "--finetune-iterations", 2, *option,
                    "-o", f"other{number}.ply")
        check(vertices(f"other{number}.ply") != vertices("tuned.ply"), f"{option} has no effect")
    expect(0, "render", "tuned.ply", recording, "--view", 1, "-o", "tuned.png")
    expect(0, *small, "--gaussians", 100000, "--method", "eagles", "-o", "all.ply",
           err="100000 Gaussians are more than the views have")
    for method in ("best", "", "pup+", "+finetune"):
        expect(2, *small, "--keep", 9, f"--method={method}", "-o", "x.ply", err=f"--method: '{method}' is not a method")
    for iterations in ("0", "100001", "x"):
        expect(2, *small, "--keep", 9, f"--finetune-iterations={iterations}", "-o", "x.ply", err="--finetune-iterations")
    for option, words in (("rounds=0", "--finetune-rounds"), ("rounds=17", "--finetune-rounds"),
                          ("start=wide", "takes neighbours or pruned"), ("rates=1", "takes tuned or published")):
        expect(2, *small, "--keep", 9, f"--finetune-{option}", "-o", "x.ply", err=words)
    expect(2, *small, "--auto", "--method", "eagles", "-o", "x.ply", err="not for eagles")
    expect(2, *small, "--keep", 9, "--method", "pup", "--profile", "-o", "x.ply", err="--profile belongs to the method trim3r")
    expect(0, *small, "--gaussians", 9, "--head", "none", "--method", "random", "--comments", "-o", "named.ply")
    check(b"comment trim3r head none\n" in open("named.ply", "rb").read(), "--comments does not name the head")
    for command in ("replay", "view", "capture"):
        expect(2, command, recording, "--method", "pup", err="--method")

    prune = ["build", recording, "--context", "0,2", "--working", "32x32", "--prune", "whole.ply"]
    found = expect_json(*prune, "--keep", "50%", "--method", "eagles", "-o", "half.ply")
    check(found["gaussians"] == (whole["gaussians"] + 1) // 2 and found["pruned"] == "whole.ply", "half of a scene")
    check("head" not in found and found["context"] == [0, 2] and found["width"] == 32, "what is told of a pruned scene")
    expect_json(*small, "--keep", 50, "--method", "eagles", "-o", "own.ply")
    check(len(vertices("half.ply", 12) & vertices("own.ply", 12)) > 0.98 * found["gaussians"],
          "a scene from a file is not pruned as the one that it was written from")
    found = expect_json(*prune, "--gaussians", 9, "--method", "pup+finetune", "--finetune-iterations", 1, "-o", "9.ply")
    check(found["gaussians"] == 9, "a pruned scene's count")
    found = expect_json(*prune, "--keep", 9, "-o", "x.ply")
    check((found["method"], found["head"], found["pruned"]) == ("trim3r", "small", "whole.ply") and "hash" in found and
          found["gaussians"] == int(whole["gaussians"] * 0.09 + 0.5), "trim3r prunes a scene, too")
    expect(2, *prune, "--keep", 9, "--method", "pup+head", "-o", "x.ply", err="+head")
    expect(1, "build", recording, "--prune", "none.ply", "--keep", 9, "--method", "pup", "-o", "x.ply", err="none.ply")
    header = open("whole.ply", "rb").read().split(b"end_header\n", 1)[0]
    count = f"element vertex {whole['gaussians']}".encode()
    write("empty.ply", header.replace(count, b"element vertex 0") + b"end_header\n")
    expect(1, "build", recording, "--prune", "empty.ply", "--keep", 9, "--method", "lightgaussian", "-o", "x.ply",
           err="no Gaussians")
    expect(1, *prune[:3], "0,99", *prune[4:], "--keep", 9, "--method", "pup", "-o", "x.ply", err="no frame 99")
    expect(2, *prune[:3], "0,0", *prune[4:], "--keep", 9, "--method", "pup", "-o", "x.ply", err="twice")


in_scratch(rivals)
in_scratch(with_a_rim)
