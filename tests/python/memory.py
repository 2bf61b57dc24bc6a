#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""memory.py LIBRARY TRIM3R: pixels are passed without a copy, results lie in the arena, and nothing is freed too
early."""
import dataclasses
import gc
import pathlib
import sys
import tempfile
import tracemalloc
import weakref

from common import FRAMES, SIDE, check, np, refused, small, trim3r, with_views

from checks import done, run

WIDE, HIGH = 640, 480


def hashes_of(*frames):
    with with_views(frames) as made:
        made.build(200)
        return made.stage_hashes


def address(array):
    return array.__array_interface__["data"][0]


def check_pointers():
    """The library gets the array's own address and stride, for whole arrays and for crops."""
    large = np.zeros((HIGH, WIDE, 3), np.uint8)
    steps = np.zeros((HIGH, WIDE), np.uint16)
    for rows, columns in ((slice(None), slice(None)), (slice(5, 105), slice(7, 207)), (slice(0, 100, 2), slice(50))):
        frame = trim3r.Frame(large[rows, columns], FRAMES[0].camera, steps[rows, columns])
        native, kept = frame.native()
        check(int(trim3r._native.ffi.cast("uintptr_t", native.planes[0])) == address(frame.colour), "colour's address")
        check(int(trim3r._native.ffi.cast("uintptr_t", native.depth)) == address(frame.depth), "depth's address")
        check(native.stride_bytes[0] == frame.colour.strides[0], "colour's stride")
        check((native.width, native.height) == frame.size == frame.colour.shape[1::-1], "the size")
        check(kept[0][0] is frame.colour and kept[1] is frame.depth, "the arrays are held as long as they are used")


def check_no_copies():
    """A large view uses little of Python's memory: far less than a copy of its pixels."""
    large = trim3r.room(1, WIDE, HIGH)[0]
    with small(1) as made:
        tracemalloc.start()
        made.add_view(large)
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    check(most < large.depth.nbytes / 4, f"{most} bytes for a view of {large.colour.nbytes} and {large.depth.nbytes}")


def check_crops():
    """Rows with gaps, and arrays of other layouts, give the bits of a copy without gaps."""
    wanted = hashes_of(*FRAMES[:2])
    apart = []
    for frame in FRAMES[:2]:
        colour, depth = np.full((2 * SIDE, SIDE + 9, 3), 77, np.uint8), np.full((2 * SIDE, SIDE + 9), 7, np.uint16)
        colour[::2, 4:SIDE + 4], depth[::2, 4:SIDE + 4] = frame.colour, frame.depth
        apart.append(dataclasses.replace(frame, colour=colour[::2, 4:SIDE + 4], depth=depth[::2, 4:SIDE + 4]))
    check(hashes_of(*apart) == wanted, "rows apart")
    turned = [dataclasses.replace(frame, colour=np.ascontiguousarray(frame.colour[..., ::-1]), format="bgr24")
              for frame in FRAMES[:2]]
    check(hashes_of(*turned) == wanted, "blue first")
    metres = [dataclasses.replace(f, depth=f.depth * f.depth_unit) for f in FRAMES[:2]]
    check(hashes_of(*metres) == wanted, "depth in metres")
    holes = metres[0].depth.astype(np.float32)
    holes[0, :5] = [np.nan, np.inf, -1, 0, 1e9]
    native, kept = dataclasses.replace(metres[0], depth=holes).native()
    check(not kept[1][0, :5].any() and native.depth_unit_q40 == 1099511628, "what is no depth becomes 0")
    for channels in ((SIDE, SIDE), (SIDE, SIDE, 2)):
        plain = np.full(channels, 128, np.uint8)
        name = "grey" if len(channels) == 2 else "yuyv"
        check(len(hashes_of(dataclasses.replace(FRAMES[0], colour=plain, format=name))) > 3, name)
    planes = np.full((SIDE, SIDE), 128, np.uint8), np.full((SIDE // 2, SIDE // 2, 2), 128, np.uint8)
    check(len(hashes_of(dataclasses.replace(FRAMES[0], colour=planes, format="nv12"))) > 3, "nv12")


def check_when_read():
    """Pixels are read only while the view is added."""
    wanted, colour = hashes_of(FRAMES[0]), FRAMES[0].colour.copy()
    with small(1) as made:
        made.add_view(dataclasses.replace(FRAMES[0], colour=colour))
        colour[:] = 0
        made.build(200)
        check(made.stage_hashes == wanted, "a change after add_view() is not seen")
        check(hashes_of(dataclasses.replace(FRAMES[0], colour=colour)) != wanted, "a change before it is")


def check_results():
    """A scene lies in the arena and keeps it alive; a picture is drawn into the given array."""
    with with_views() as made:
        scene = made.build(300)
        held = scene.gaussians
        check(np.shares_memory(held, made._arena) and not held.flags.writeable, "the scene lies in the arena")
        kept = scene.copy()
        check(not np.shares_memory(kept.gaussians, made._arena), "a copy does not")
        sheet = np.full((2 * SIDE, 3 * SIDE, 3), 9, np.uint8)
        place = sheet[3:3 + SIDE, 5:5 + SIDE]
        check(made.render(FRAMES[1].camera, out=place) is place, "what was handed over comes back")
        check(np.array_equal(place, made.render(FRAMES[1].camera)), "drawn into a part of a sheet")
        sheet[3:3 + SIDE, 5:5 + SIDE] = 9
        check((sheet == 9).all(), "and nowhere else")
        made.rebuild(200)
        with refused(trim3r.StateError, "copy()"):
            scene.positions.sum()
        check(len(kept.positions) == 300, "the copy is still there")
        arena = weakref.ref(made._arena.base)
        last = made.rebuild(100).gaussians
    del made, held, scene
    gc.collect()
    check(arena() is not None and last["opacity_q15"].any(), "an array of Gaussians keeps the arena")
    del last, place
    gc.collect()
    check(arena() is None, "which goes with the last of them")


def check_recording():
    """Frames of a recording lie in its memory, and outlive it."""
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        path = pathlib.Path(folder) / "room.mcap"
        run(sys.argv[2], "room", "--size", f"{SIDE}x{SIDE}", "--frames", "2", "-o", path)
        recording = trim3r.Recording(path)
        first, again = recording[0], recording[0]
        check(np.shares_memory(first.colour, again.colour), "one memory, however often a frame is asked for")
        check(not first.colour.flags.writeable, "read-only")
        last = [frame.colour for frame in recording][-1]
        del recording, again
        gc.collect()
        check(np.array_equal(first.depth, FRAMES[0].depth) and np.array_equal(last, FRAMES[1].colour), "they outlive it")


def main():
    check_pointers()
    check_no_copies()
    check_crops()
    check_when_read()
    check_results()
    check_recording()
    done()


if __name__ == "__main__":
    main()
