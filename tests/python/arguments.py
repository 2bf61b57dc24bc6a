#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""arguments.py LIBRARY: every number that the package takes is refused out of its range, by its name, and so is a number of
another type. Nothing wraps, and nothing raises OverflowError."""
import dataclasses
import inspect
import re

from common import FRAMES, SIDE, check, np, refused, small, trim3r, with_views
from trim3r._settings import SETTINGS

from checks import done

CAMERA = FRAMES[1].camera
FIELDS = {"fx_q16": 0, "fy_q16": 0, "cx_q16": 0, "cy_q16": 0, "distortion_q24": 5, "position_q32": 3, "rotation_q30": 4}
NAMED = ("wavelet", "allocation", "head", "depth") # settings whose values have names
FAR = (-1 << 70, -1 << 40, -1 << 31, 1 << 32, 1 << 40, 1 << 64, 1 << 70)
NAN, INFINITE = float("nan"), float("inf")


def made_with(**options):
    return trim3r.Reconstructor(**{"width": SIDE, "height": SIDE, "head": "tiny", **options})


def stream_with(**options):
    return trim3r.Stream(**{"width": SIDE, "height": SIDE, "gaussians": 100, "head": "tiny", **options})


def room(**options):
    return trim3r.room(**{"frames": 1, "width": SIDE, "height": SIDE, **options})


def camera_with(field, value):
    """Draws with a camera, a number of which is the value."""
    count = FIELDS[field]
    whole = value if count == 0 else (*getattr(CAMERA, field)[:count - 1], value)
    return dataclasses.replace(CAMERA, **{field: whole}).native((SIDE, SIDE))


def calibrated(**options):
    return trim3r.Camera.calibrated(**{"fx": 60, "fy": 60, "cx": 32, "cy": 32, "pose": np.eye(4), **options})


def rows(made, stream):
    """Returns the integers: (where the argument stands, its name in messages, least, most, a call with a value)."""
    def add_rows(name):
        return lambda value: small(1).add_rows(FRAMES[0], **{"row": 0, "height": SIDE, name: value})

    yield from ((("room", name), name, *bounds, lambda value, name=name: room(**{name: value}))
                for name, bounds in (("frames", (1, 1000)), ("width", (8, 4096)), ("height", (8, 4096)),
                                     ("seed", (0, 2**32 - 1))))
    yield from ((("develop", name), name, 8, 4096, lambda value, name=name:
                 trim3r.develop(FRAMES[0], **{"width": SIDE, "height": SIDE, name: value})) for name in ("width", "height"))
    yield from ((("Reconstructor", name), name, *bounds, lambda value, name=name: made_with(**{name: value}))
                for name, bounds in (("width", (8, 4096)), ("height", (8, 4096)), ("views", (0, 16)),
                                     ("gaussians", (1, 1 << 24)), ("workers", (1, 16)), ("arena_bytes", (0, None))))
    yield from ((("Stream", name), name, *bounds, lambda value, name=name: stream_with(**{name: value}))
                for name, bounds in (("width", (8, 4096)), ("height", (8, 4096)), ("views", (1, 16)),
                                     ("gaussians", (1, 1 << 24)), ("workers", (1, 16)), ("arena_bytes", (0, None))))
    yield from (((owner, "render_size"), name, 1, 4096, lambda value, call=call, at=at: call(render_size=at(value)))
                for owner, call in (("Reconstructor", made_with), ("Stream", stream_with))
                for name, at in (("render_width", lambda v: (v, SIDE)), ("render_height", lambda v: (SIDE, v))))
    yield from ((("Reconstructor.add_rows", name), name, least, 4096, add_rows(name))
                for name, least in (("row", 0), ("height", 2), ("depth_row", 0), ("depth_height", 2)))
    for call in (made.build, made.rebuild):
        yield (f"Reconstructor.{call.__name__}", "gaussians"), "gaussians", 1, 2 * SIDE * SIDE, call
    for call in (made.render, made.picture, stream.render, stream.picture):
        yield from (((f"{type(call.__self__).__name__}.{call.__name__}", "size"), name, 1, SIDE,
                     lambda value, call=call, at=at: call(dataclasses.replace(CAMERA, size=None), at(value)))
                    for name, at in (("width", lambda v: (v, SIDE)), ("height", lambda v: (SIDE, v))))
    yield from ((("Stream.overlap", "size"), name, 1, 4096, lambda value, at=at:
                 stream.overlap(dataclasses.replace(CAMERA, size=None), at(value)))
                for name, at in (("width", lambda v: (v, SIDE)), ("height", lambda v: (SIDE, v))))
    yield from ((("evaluate", "size"), name, 8, 4096, lambda value, at=at:
                 trim3r.evaluate(FRAMES[::2], FRAMES[1], [10], size=at(value)))
                for name, at in (("width", lambda v: (v, SIDE)), ("height", lambda v: (SIDE, v))))
    yield ("evaluate", "workers"), "workers", 1, 16, lambda value: trim3r.evaluate(FRAMES[::2], FRAMES[1], [10], workers=value)
    yield from ((("Camera", field), field, -(1 << bits), (1 << bits) - 1,
                 lambda value, field=field: camera_with(field, value))
                for field, bits in ((field, 63 if field == "position_q32" else 31) for field in FIELDS))
    yield from ((("Camera.resized", name), name, 1, 4096, lambda value, name=name:
                 CAMERA.resized(**{"width": SIDE, "height": SIDE, name: value})) for name in ("width", "height"))
    for call in (lambda size: calibrated(size=size).native((SIDE, SIDE)),
                 lambda size: dataclasses.replace(CAMERA, size=size).resized(SIDE, SIDE)):
        yield from (((owner, "size"), name, 1, 4096, lambda value, call=call, at=at: call(at(value)))
                    for owner in ("Camera", "Camera.calibrated")
                    for name, at in (("width", lambda v: (v, SIDE)), ("height", lambda v: (SIDE, v))))
    gaussians = made.build(5).gaussians.copy()
    yield ("Scene", "valid_points"), "valid_points", 0, 2**32 - 1, lambda value: trim3r.Scene(gaussians, (0, 0, 0), 0, value)
    yield ("Scene", "exponent"), "exponent", -24, 24, lambda value: trim3r.Scene(gaussians, (0, 0, 0), value)
    yield ("Scene", "finer"), "finer", 0, 48, lambda value: trim3r.Scene(gaussians, (0, 0, 0), 0, finer=value)
    yield ("Scene", "origin_q32"), "origin_q32[2]", -(1 << 62) + 1, (1 << 62) - 1, lambda value: trim3r.Scene(
        gaussians, (0, 0, value), 0)


def check_integers(made, stream):
    found = set()
    for place, name, least, most, call in rows(made, stream):
        found.add(place)
        for value in (True, np.True_, 1.0, np.float64(2), 1j):
            with refused(TypeError, name.split("[")[0], "an integer"):
                call(value)
        with refused((TypeError, ValueError), name.split("[")[0]):
            call("1")
        beyond = [least - 1, *([] if most is None else [most + 1])]
        for value in (*beyond, *(far for far in FAR if not least <= far <= (most or 1 << 63))):
            with refused(ValueError, name, f"{least}..", str(value)):
                call(value)
    return found


def check_settings():
    for name, (kind, _, least, most) in SETTINGS.items():
        for value in (1.0, None, *(() if kind == "toggle" else (True,))):
            with refused(TypeError, name):
                made_with(settings={name: value})
        for value in (least - 1, most + 1, *(far for far in FAR if not least <= far <= most)):
            with refused(ValueError, name, *(() if kind in NAMED else (f"{least}..{most}",))):
                made_with(settings={name: value})
    with made_with(settings={"exposure": False, "flying": True}) as made:
        check(made.arena_bytes > 0, "a setting that is on or off is a truth value, too")


def reals(made):
    """Returns the real numbers: (where the argument stands, its name in messages, values out of range, a call)."""
    tiny = (NAN, INFINITE, -INFINITE)
    huge = (*tiny, 1e300, -1e300, 1 << 70, -1 << 70, 10**400)
    yield from ((("Camera.calibrated", name), name, huge, lambda value, name=name: calibrated(**{name: value}))
                for name in ("fx", "fy", "cx", "cy"))
    yield ("Camera.calibrated", "coefficients"), "coefficient 1", huge, lambda value: calibrated(
        distortion="radtan", coefficients=[0, value])
    yield ("Frame", "depth_unit"), "depth_unit", (*huge, 0, -1, 1e-13, 128), lambda value: small(1).add_view(
        dataclasses.replace(FRAMES[0], depth_unit=value))
    for call in (made.build, made.rebuild):
        yield (f"Reconstructor.{call.__name__}", "keep"), "keep", (*huge, 0, -1, 101), lambda value, call=call: call(keep=value)
        yield (f"Reconstructor.{call.__name__}", "max_loss"), "max_loss", (*huge, -1, 11), lambda value, call=call: call(
            max_loss=value)
    yield ("evaluate", "keep"), "keep", (*huge, 0, -1, 101), lambda value: trim3r.evaluate(FRAMES[::2], FRAMES[1], [value])


def check_reals(made):
    found = set()
    for place, name, beyond, call in reals(made):
        found.add(place)
        for value in (True, np.True_, "1", b"1", None, 1j, [1, 2]):
            if value is not None or name != "keep": # None: no budget is named
                with refused(TypeError, name, "a number"):
                    call(value)
        for value in beyond:
            with refused(ValueError, name):
                call(value)
    for pose in (np.eye(4, dtype=bool), np.eye(4) * 1j, np.eye(4).astype(str)):
        with refused(TypeError, "pose"):
            calibrated(pose=pose)
        with refused(TypeError, "pose"):
            CAMERA.at(pose)
    for at in ((0, 3), (1, 1)):
        for value in (NAN, INFINITE, -INFINITE):
            pose = np.eye(4)
            pose[at] = value
            for call in (CAMERA.at, lambda pose: calibrated(pose=pose)):
                with refused(ValueError, "pose", "finite"):
                    call(pose)
    return found


# Classes and calls that the library fills, and parameters whose types hold numbers of arrays and of mappings.
HANDED_OUT = {"Row", "Report", "Triplet", "Picture", "Scene.in_frame", "Camera.native", "Camera.from_native", "Frame.native_strip"}
OTHER = {"pose", "progress", "settings", *trim3r.Arrays._fields}


def numbers():
    """Yields (function, parameter) of everything public with int or float in its type."""
    for name in trim3r.__all__:
        thing = getattr(trim3r, name)
        if not inspect.isclass(thing) and not inspect.isfunction(thing):
            continue
        members = inspect.getmembers(thing, inspect.isroutine) if inspect.isclass(thing) else []
        calls = [(name, thing), *((f"{name}.{m}", call) for m, call in members
                                  if not m.startswith("_") and (inspect.isfunction(call) or inspect.ismethod(call)))]
        for called, call in calls:
            yield from ((called, parameter.name) for parameter in inspect.signature(call).parameters.values()
                        if re.search(r"\b(int|float)\b", str(parameter.annotation))
                        and called not in HANDED_OUT and parameter.name not in OTHER)


def main():
    with with_views() as made, stream_with() as stream:
        made.build(100)
        stream.keyframe(FRAMES[0])
        found = check_integers(made, stream) | check_reals(made)
    check_settings()
    public = set(numbers())
    check(len(public) > 30 and public == found, f"not tried, or not public: {sorted(public ^ found)}")
    done()


if __name__ == "__main__":
    main()
