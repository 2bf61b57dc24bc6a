#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""rows.py LIBRARY: a view in strips of rows has the bits of the whole view, for any strips; they are passed without
a copy, and a strip that does not continue the view is refused."""
import dataclasses
import tracemalloc

from common import FRAMES, SIDE, check, np, refused, small, trim3r, with_views

from checks import done


def strip_of(frame, rows, depth_rows=None):
    """Returns these rows of the frame, as (first, one past the last)."""
    depth_rows = depth_rows or rows
    colour = frame.colour
    if isinstance(colour, tuple):
        colour = colour[0][slice(*rows)], colour[1][rows[0] // 2:rows[1] // 2]
    else:
        colour = colour[slice(*rows)]
    return dataclasses.replace(frame, colour=colour, depth=frame.depth[slice(*depth_rows)])


def add_in(made, frame, step):
    """Adds the frame in strips of `step` rows; returns the result of each call."""
    return [made.add_rows(strip_of(frame, (row, min(row + step, SIDE))), row, SIDE) for row in range(0, SIDE, step)]


def hashes_of(frames, **options):
    with with_views(frames, **options) as made:
        made.build(200)
        return made.stage_hashes


def check_bits():
    pair = FRAMES[0], FRAMES[2]
    wanted = hashes_of(pair)
    check(hashes_of(FRAMES[:2]) != wanted, "other views have other hashes")
    for step in (1, 7, SIDE):
        with small() as made:
            for frame in pair:
                told = add_in(made, frame, step)
                check(told == [False] * (len(told) - 1) + [True], f"strips of {step} rows: {told}")
            check(made.valid_points is None, "the points are not known before a build")
            scene = made.build(200)
            check(made.stage_hashes == wanted, f"strips of {step} rows: other bits")
            check(scene.valid_points == 2 * SIDE * SIDE and len(made.build(keep=10)) == round(SIDE * SIDE / 5), "a budget")


def check_apart():
    """Adds colour and depth at different rates, and depth of another size."""
    frame = dataclasses.replace(FRAMES[0], depth=np.ascontiguousarray(FRAMES[0].depth[::2, ::2]))
    with small(1) as made:
        check(not made.add_rows(strip_of(frame, (0, SIDE), (0, 0)), 0, SIDE, depth_row=0, depth_height=SIDE // 2), "colour")
        for row in range(0, SIDE // 2, 8):
            added = made.add_rows(strip_of(frame, (SIDE, SIDE), (row, row + 8)), SIDE, SIDE, depth_row=row,
                                  depth_height=SIDE // 2)
            check(added == (row + 8 == SIDE // 2), f"depth from row {row}")
        made.build(200)
        check(made.stage_hashes == hashes_of([frame]), "depth behind the colour: other bits")


def check_formats():
    """Adds the two planes of nv12, floats of depth, and colours alone by stereo."""
    random = np.random.default_rng(3)
    planes = (random.integers(0, 256, (SIDE, SIDE), np.uint8), random.integers(0, 256, (SIDE // 2, SIDE // 2, 2), np.uint8))
    for frame in (dataclasses.replace(FRAMES[0], colour=planes, format="nv12"),
                  dataclasses.replace(FRAMES[0], depth=FRAMES[0].depth * FRAMES[0].depth_unit)):
        with small(1) as made:
            add_in(made, frame, 8)
            made.build(200)
            check(made.stage_hashes == hashes_of([frame]), f"{frame.format}: other bits")
    with small(depth="stereo") as made:
        for frame in (FRAMES[0], FRAMES[2]):
            for row in range(0, SIDE, 16):
                strip = dataclasses.replace(frame, colour=frame.colour[row:row + 16], depth=None)
                check(made.add_rows(strip, row, SIDE) == (row == SIDE - 16), f"stereo, row {row}")
        made.build(200)
        check(made.stage_hashes == hashes_of((FRAMES[0], FRAMES[2]), depth="stereo"), "by stereo: other bits")


def check_memory():
    """One small strip suffices for a large view: it is read during the call, and not copied."""
    large = trim3r.room(1, 640, 480)[0]
    colour, depth = np.empty((16, 640, 3), np.uint8), np.empty((16, 640), np.uint16)
    strip = dataclasses.replace(large, colour=colour, depth=depth)
    native, kept = strip.native_strip(480, 480)
    check(int(trim3r._native.ffi.cast("uintptr_t", native.planes[0])) == colour.__array_interface__["data"][0]
          and kept[1] is depth and native.height == 480, "the strip's own address")
    with small(1) as made:
        tracemalloc.start()
        for row in range(0, 480, 16):
            colour[:], depth[:] = large.colour[row:row + 16], large.depth[row:row + 16]
            made.add_rows(strip, row, 480)
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        colour[:], depth[:] = 0, 0
        made.build(200)
        check(made.stage_hashes == hashes_of([large]), "a strip that is filled again and again: other bits")
    check(most < large.depth.nbytes / 4, f"{most} bytes for a view of {large.colour.nbytes} and {large.depth.nbytes}")


def check_refused():
    frame = FRAMES[0]
    elsewhere = dataclasses.replace(frame, camera=frame.camera.at(np.eye(4)))
    with small(1) as made:
        with refused(trim3r.StateError):
            made.add_rows(strip_of(frame, (8, 16)), 8, SIDE) # no strip from row 0 precedes
        made.add_rows(strip_of(frame, (0, 8)), 0, SIDE)
        with refused(trim3r.StateError):
            made.add_rows(strip_of(frame, (16, 24)), 16, SIDE)
        with refused(trim3r.StateError):
            made.add_rows(strip_of(elsewhere, (8, 16)), 8, SIDE)
        for row, height, options in ((8, 12, {}), (-1, SIDE, {}), (1 << 40, SIDE, {}), (8, -1, {}), (8, 1 << 40, {}),
                                     (8, SIDE, {"depth_row": -1}), (8, SIDE, {"depth_row": SIDE}),
                                     (8, SIDE, {"depth_height": 9})):
            with refused(ValueError):
                made.add_rows(strip_of(frame, (8, 16)), row, height, **options)
        with refused(ValueError, "a list"):
            made.add_rows(dataclasses.replace(frame, colour=[1, 2]), 8, SIDE)
        with refused(ValueError, "no camera"):
            made.add_rows(dataclasses.replace(strip_of(frame, (8, 16)), camera=None), 8, SIDE)
        with refused(ValueError, "sides"):
            made.add_view(strip_of(frame, (0, 0))) # only a strip may lack rows
        with refused(trim3r.StateError):
            made.build(100)
        check(add_in(made, frame, 32)[-1], "a strip from row 0 begins anew")
        with refused(trim3r.StateError):
            made.add_rows(strip_of(frame, (0, 8)), 0, SIDE) # too little memory
        made.build(200)
        check(made.stage_hashes == hashes_of([frame]), "what was refused leaves nothing behind")
        made.reset()
        empty = dataclasses.replace(frame, depth=np.zeros_like(frame.depth))
        with refused(trim3r.DepthError):
            add_in(made, empty, 16)
        with refused(trim3r.DepthError):
            made.add_rows(dataclasses.replace(frame, depth=None), 0, SIDE)


def main():
    check_bits()
    check_apart()
    check_formats()
    check_memory()
    check_refused()
    done()


if __name__ == "__main__":
    main()
