#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""plan.py TRIM3R: what `trim3r plan` refuses and tells."""
import xml.dom.minidom

from program import check, expect, expect_full, expect_json, in_scratch, room, weight_file


def shares_and_operations(base, found):
    check(expect_json(*base[:-2], "--keep", "10%") == found, "--keep 10% is not 13107 of 2 x 256 x 256")
    expect(2, *base, "--keep", 10, err="exclude")
    expect(2, *base[:-2], "--keep", 101, err="--keep")
    operations = found["operations"]
    check(operations["refine"] > operations["wavelet"] > 0, f"operations: {operations}")
    analytic = expect_json(*base, "--head", "analytic")["operations"]
    check(analytic["head"] < operations["head"] and analytic["refine"] == operations["refine"], "a network is no work")
    check("M operations" in expect(0, *base), "no table of operations")
    check("build_ms" not in found, "a time of no machine")


def lists():
    """What fits an arena."""
    listed = expect_json("plan", "--arena", "2M")["choices"]
    losses = [row["expected_loss_db"] for row in listed]
    check(losses == sorted(losses) and len(losses) > 1, f"losses: {losses}")
    check(all(row["min_bytes"] <= 2 << 20 for row in listed) and "build_ms" not in listed[0], f"choices: {listed}")
    several = expect_json("plan", "--arena", "1M", "--size", "128x128")["choices"]
    check(len({row["head"] for row in several}) > 1, "one head alone")
    small = expect_json("plan", "--arena", "2M", "--head", "small", "--refine", 2, "--size", "128x128")["choices"]
    check({(row["head"], row["refine"]) for row in small} == {("small", 2)}, f"head small, two passes: {small}")
    fixed = expect_json("plan", "--arena", "2M", "--gaussians", 777)["choices"]
    check({row["gaussians"] for row in fixed} == {777}, f"777 Gaussians: {fixed}")
    check(expect(0, "plan", "--arena", "2M", "--markdown").startswith("| head |"), "the list in Markdown")
    expect(0, "plan", "--arena", "2M", out="loss dB")
    expect(3, "plan", "--arena", "10K", err="the smallest arena is of")
    expect(2, "plan", "--arena", "2M", "--within", "2M", err="--within")
    expect(2, "plan", "--arena", "2M", "--views", 0, err="--views 0")
    expect(2, "plan", "--time", "100km", err="--time")
    for value in ("0", "-1ms", "ms", "1e3ms", "", "99999999s"):
        expect(2, "plan", f"--time={value}", err="--time")
    expect(1, "plan", "--time", "1ms", "--machine", "absent.json", err="absent.json")
    expect(1, "plan", "--time", "1ms", "--machine", "wide.t3w", err="wide.t3w")


SIZES = {"128K": 128 << 10, "192K": 192 << 10, "256K": 256 << 10, "512K": 512 << 10, "1M": 1 << 20, "4M": 4 << 20}
PARTS = ("arena_bytes", "strip_bytes", "target_bytes", "stack_bytes", "program_bytes", "left_bytes")


def sizes_of_ram():
    """A size of RAM leads to settings, and all that they take is within it."""
    before = 0
    for text, ram in SIZES.items():
        found = expect_json("plan", "--ram", text)
        check(found["ram_bytes"] == ram == sum(found[part] for part in PARTS), f"--ram {text}: {found}")
        own = expect_json("plan", "--size", f"{found['width']}x{found['height']}", "--views", found["views"], "--gaussians",
                          found["gaussians"], "--head", found["head"], "--refine", found["refine"])
        check(own["min_bytes"] <= found["arena_bytes"] <= own["arena_bytes"], f"--ram {text}: the arena: {own}")
        check(own["head_column_bytes"] == found["head_column_bytes"], f"--ram {text}: the head's columns")
        check(found["strip_bytes"] == 5 * found["strip_rows"] * found["width"], f"--ram {text}: a strip of rows")
        check(found["target_bytes"] == 3 * found["width"] * found["height"], f"--ram {text}: a picture")
        check(found["gaussians"] > before, f"--ram {text}: no more Gaussians than with less RAM")
        before = found["gaussians"]
        told = expect(0, "plan", "--ram", text, out=str(found["arena_bytes"]))
        check(all(f" {found[part]}\n" in told for part in PARTS), f"--ram {text}: a line a part: {told}")
        check(f"arena[{found['arena_bytes']}];" in told
              and f"t3r_default_config({found['width']}, {found['height']}, {found['views']}, {found['gaussians']});" in told
              and f"the weights of {found['head']} " in told and f"head_column_bytes = {found['head_column_bytes']};" in told
              and f"refine = {found['refine']};" in told, f"--ram {text}: lines for a firmware: {told}")
    between = expect_json("plan", "--ram", "255K")
    check(between["ram_bytes"] == SIZES["192K"] and sum(between[part] for part in PARTS) == 255 << 10, "between two rows")
    check(expect_json("plan", "--ram", "4G")["left_bytes"] > 1 << 30, "what the largest row leaves")
    expect(3, "plan", "--ram", (128 << 10) - 1, err="131071 bytes of RAM are too few: the smallest size is 131072")
    expect(2, "plan", "--ram", "much", err="--ram")
    for more in (("--size", "64x64"), ("--gaussians", 5), ("--head", "tiny"), ("--refine", 2), ("--within", "1M"),
                 ("--arena", "1M"), ("--markdown",), ("--svg", "a.svg")):
        expect(2, "plan", "--ram", "256K", *more, err="--ram chooses the settings")


def plan():
    room("32x32", "tiny.mcap")
    weight_file("wide.t3w", "16")
    expect(2, "plan", err="--size")
    expect(2, "plan", "--size", "256x256", err="--gaussians")
    expect(2, "plan", "--size", "4x4", "--gaussians", 5, err="--size")
    expect(2, "plan", "--size", "256", "--gaussians", 5, err="--size")
    expect(2, "plan", "--size", "256x256", "--gaussians", 0, err="--gaussians")
    expect(2, "plan", "--size", "256x256", "--gaussians", 5, "--views", 17, err="--views")
    expect(2, "plan", "--size", "256x256", "--gaussians", 5, "--clusters", 513, err="--clusters")
    expect(2, "plan", "--size", "256x256", "--gaussians", 5, "--json", "--markdown", err="exclude")
    expect(2, "plan", "more", err="too many")
    expect(1, "plan", "--size", "256x256", "--gaussians", 5, "--svg", "missing/a.svg", err="missing/a.svg")
    expect_full("full.svg", "plan", "--size", "256x256", "--gaussians", 5, "--svg", "full.svg")
    expect(2, "plan", "--size", "256x256", "--gaussians", 5, "--render", "0x9", err="--render")
    base = ["plan", "--size", "256x256", "--views", 2, "--gaussians", 13107]
    found = expect_json(*base, "--svg", "arena.svg")
    check(found["min_bytes"] <= found["arena_bytes"], "plan --json lacks its keys")
    for buffer in found["buffers"]:
        check(buffer["offset"] + buffer["bytes"] <= found["arena_bytes"], f"{buffer['name']} leaves the arena")
    xml.dom.minidom.parse("arena.svg")
    table = expect(0, *base, "--markdown", out="|---|")
    check(all((f"| {b['name']} | {b['bytes']} |" in table) == (b['bytes'] > 0) for b in found["buffers"]),
          "the Markdown table is to have all buffers that have bytes")
    check(str(found["min_bytes"]) in expect(0, *base), "the table lacks the least bytes")
    # the inverse: the most Gaussians that so many bytes hold
    within = ["plan", "--size", "96x96", "--within"]
    least = expect_json(*within[:-1], "--gaussians", 900)["min_bytes"]
    most = expect_json(*within, least)["gaussians"]
    check(most >= 900 and expect_json(*within[:-1], "--gaussians", most)["min_bytes"] <= least
          < expect_json(*within[:-1], "--gaussians", most + 1)["min_bytes"], f"{most} is not the most for {least} bytes")
    check(expect_json(*within, least, "--gaussians", 700)["gaussians"] == 700, "--gaussians is not the cap of --within")
    check(expect_json(*within, "900K") == expect_json(*within, 900 << 10), "900K is not 900 x 1024 bytes")
    check(expect_json(*within, "4G")["gaussians"] == 96 * 96 * 2, "more Gaussians than points")
    expect(0, *within, least, out=f"{most} Gaussians fit into {least} bytes")
    expect(3, *within, "9K", err="9216 bytes hold no Gaussian")
    expect(2, "plan", "--size", "16x16", "--within", "9M", "--depth", "stereo", err="stereo")
    for value in ("0", "x", "5X", "-1", ""):
        expect(2, *within, value, err="--within")
    # every Gaussian in every tile, unless a tile takes fewer
    check(found["most_blends"] == 16 * 16 * 13107, "the plan does not bound what a view blends")
    check(expect_json(*base, "--tile-splats", 100)["most_blends"] == 16 * 16 * 100, "--tile-splats bounds nothing")
    expect(0, *base, out=str(16 * 16 * 13107))
    # threads take no less, and full speed for several takes more
    one, four = expect_json(*base, "--threads", 1), expect_json(*base, "--threads", 4)
    check(one == found and four["threads"] == 4 and one["arena_bytes"] < four["arena_bytes"],
          f"--threads 4: {four['arena_bytes']} bytes, {one['arena_bytes']} with one")
    expect(2, *base, "--threads", 17, err="--threads")
    # the settings are those of build
    check(expect_json(*base, "--refine", 0)["arena_bytes"] <= found["arena_bytes"], "refinement saves bytes")
    expect_json(*base, "--levels", 3, "--bridge-radius", 0, "--allocate", "paper")
    # a head needs what plan says: one with wider activations more, and a closed form nothing
    small, wide, analytic = (expect_json(*base, "--head", head) for head in ("small", "wide.t3w", "analytic"))
    check(small["arena_bytes"] == found["arena_bytes"], "the default arena holds small")
    check(analytic["head_column_bytes"] == 0 and small["head_column_bytes"] > 0, "a closed form plans a network")
    check(expect_json(*base, "--head", "tiny")["head_column_bytes"] < small["head_column_bytes"], "tiny plans for small")
    tall = ["plan", "--size", "64x512", "--keep", 1, "--refine", 0, "--head"]
    check(expect_json(*tall, "analytic")["min_bytes"] <= expect_json(*tall, "small")["min_bytes"], "a closed form needs more")
    shares_and_operations(base, found)
    lists()
    sizes_of_ram()
    check(wide["head_column_bytes"] > small["head_column_bytes"], "16-bit activations need no more")
    expect(2, *base, "--head", "big", err="--head")


in_scratch(plan)
