# SPDX-License-Identifier: Apache-2.0
"""Streams: a map of Gaussians that follows a moving camera."""
import dataclasses
import os
from typing import Any, Dict, Optional, Tuple

from ._native import ffi, host_called, lib, text_of
from .arguments import Path, grid, pair, path_bytes, whole
from .camera import Camera
from .configuration import Settings, configuration
from .frame import Frame
from .heads import HeadName, head_of
from .hooks import Progress
from .image_stage import camera_of
from .runtime import Runtime
from .scene import Scene
from .stream_state import read_state, state_of

_KEYFRAMES = 4  # live ones, as the program has them


@dataclasses.dataclass(frozen=True)
class Report:
    """What a keyframe changed, and what the gate measured of its frame.

    Attributes
    ----------
    refusal : str
        Why the frame was not taken, as "blurred"; "" = it is a keyframe. After a refusal the map is unchanged, and the
        numbers up to `shown` are 0, except keyframes and gaussians.
    keyframes : int
        Keyframes so far, with this one.
    gaussians, added, removed, crowded : int
        Gaussians in the map; those that the keyframe added; earlier ones that it contradicts, or replaces because it
        sees them far finer; earlier ones discarded for lack of room.
    points, shown : int
        Pixels of the keyframe with a depth, including filled ones; those of them that the map already showed.
    moved, realigned : bool
        A new piece of the map begins; the map has moved with poses that jumped.
    depth, dark, bright : float
        Shares of the pixels, 0..1: with a measured depth; below level 16; above level 239.
    detail : float
        Fine differences of the picture over its coarse ones, 0..4: low where it is blurred.
    compared : int
        Gaussians that were compared with the frame, at most 4096.
    contradicted, likeness : float
        The share of these that the frame sees through; the correlation of the others' colours with the frame's; 0..1.
    recent : int
        Gaussians in the picture that the last keyframe saw, at most 4096.
    in_view, hidden, hidden_likeness : float
        The share of all that the last keyframe saw; the share of these that something near hides; the correlation of
        their colours with the frame's; 0..1.
    exposure : float
        Stops by which the frame is brighter than the map, -4..4.
    """

    refusal: str
    keyframes: int
    gaussians: int
    added: int
    removed: int
    crowded: int
    points: int
    shown: int
    moved: bool
    realigned: bool
    depth: float
    dark: float
    bright: float
    detail: float
    compared: int
    contradicted: float
    likeness: float
    recent: int
    in_view: float
    hidden: float
    hidden_likeness: float
    exposure: float

    @property
    def taken(self) -> bool:
        """Whether the frame is a keyframe."""
        return not self.refusal


def _report_of(native: Any) -> Report:
    """A Report of a t3r_stream_report, each field by its own name or with the suffix _q8."""
    values: Dict[str, Any] = {}
    for field in dataclasses.fields(Report):
        is_share = field.type in (float, "float")
        values[field.name] = getattr(native, field.name + "_q8") / 256 if is_share else getattr(native, field.name)
    values["refusal"] = "" if native.refusal == lib.T3R_REFUSAL_NONE else text_of(lib.t3r_refusal_name(native.refusal))
    values["moved"], values["realigned"] = bool(native.moved), bool(native.realigned)
    return Report(**values)


def _is_report(native: Any) -> bool:
    """Whether a t3r_stream_report is about a frame; else it is all 0."""
    return bool(native.keyframes > 0 or native.refusal != lib.T3R_REFUSAL_NONE)


class Stream(Runtime):
    """A map that follows a moving camera with depth, in a fixed number of bytes: docs/streams.md.

    `keyframe()` takes one frame after another; the caller chooses which. The map may be drawn and read in between. It
    is a context manager, and `close()` ends it. Calls release Python's lock, and one stream takes one call at a time.

    Parameters
    ----------
    width, height : int
        The working size in pixels, to which frames are resized, 8..4096 each.
    gaussians : int
        The most Gaussians of the map, 1..2**24.
    views : int
        The live keyframes, whose planes are kept for refinement, 1..16.
    head, render_size, workers, arena_bytes, progress, settings
        As Reconstructor has them. Settings of streams are gate, half_life, refine_stride and remember.

    Raises
    ------
    ValueError
        A setting is out of its range or not there, or the arena is too small.
    OSError
        The file of weights cannot be read.
    """

    _KIND = "stream"

    def __init__(self, width: int, height: int, gaussians: int, *, views: int = _KEYFRAMES, head: HeadName = "small",
                 render_size: Optional[Tuple[int, int]] = None, workers: int = 1, arena_bytes: Optional[int] = None,
                 progress: Optional[Progress] = None, settings: Settings = {}) -> None:
        weights = head_of(head)
        render_width, render_height = pair("render_size", render_size or (width, height))
        views = whole("views", views, 1, lib.T3R_MAX_VIEWS, "T3R_ERR_CONFIG")
        config = configuration(width, height, views, gaussians, weights, {
            "workers": workers, "render_width": render_width, "render_height": render_height, **settings, "stream": 1})
        super().__init__(config, weights, arena_bytes, progress)
        self._report = ffi.new("t3r_stream_report *")  # zeros: none yet

    def keyframe(self, frame: Frame) -> Report:
        """Takes a frame into the map, unless the gate refuses it: Report.refusal has the reason.

        An exception in `progress` stops the call, which raises it again. The map stays valid and within its size: the
        frame adds nothing, or, during refinement, is a keyframe with fewer passes, and `report` is about it.

        Raises
        ------
        ValueError
            The arrays or the camera cannot be used.
        StateError
            The stream is closed or at work.
        """
        native, kept = frame.native()
        camera = camera_of(frame).native(frame.size)
        report = ffi.new("t3r_stream_report *")
        with self._at_work() as runtime:
            self._go_on()
            self._hooks.hashes.clear()
            try:
                self._check("t3r_stream_keyframe", runtime, native, camera, report)
            finally: # stopped in refinement, the frame is a keyframe
                if _is_report(report):
                    self._report = report
            del kept
        return _report_of(report)

    def overlap(self, camera: Camera, size: Optional[Tuple[int, int]] = None) -> float:
        """How much of a picture by this camera the newest keyframe shows, 0..1. Below about 0.7 a keyframe is due.

        Parameters
        ----------
        camera : Camera
            That of the new picture.
        size : pair of int, optional
            Its width and height, at most 4096. The camera's own size without it, else the working size.

        Raises
        ------
        ValueError
            The camera cannot be used.
        StateError
            There is no keyframe yet.
        """
        width, height = grid("size", size or camera.size or (self._config.width, self._config.height))
        overlap = ffi.new("uint32_t *")
        with self._at_work() as runtime:
            self._check("t3r_stream_overlap", runtime, camera.native((width, height)), width, height, overlap)
        return int(overlap[0]) / 256

    @property
    def scene(self) -> Scene:
        """The map, in the arena: valid until the next keyframe() or reset(). Raises StateError before a keyframe."""
        scene = ffi.new("t3r_scene *")
        with self._at_work() as runtime:
            self._check("t3r_get_scene", runtime, scene)
            return self._scene(scene)

    def snapshot(self) -> Scene:
        """The map as it is now, in memory of its own. Raises StateError before a keyframe."""
        return self.scene.copy()

    @property
    def report(self) -> Optional[Report]:
        """The report on the last frame that was taken or refused; None before one."""
        return _report_of(self._report) if _is_report(self._report) else None

    @property
    def keyframes(self) -> int:
        """Keyframes so far."""
        return int(self._report.keyframes)

    def reset(self) -> None:
        """Empties the map; the settings stay."""
        with self._at_work() as runtime:
            self._go_on()
            self._check("t3r_reset", runtime)
            self._report = ffi.new("t3r_stream_report *")

    def save_state(self, path: Path) -> None:
        """Writes all of the stream into a file: the map, the live keyframes, the report.

        A stream of the same settings and head goes on from it by load_state(), with the same bits: in another process, on
        a processor of the same word size and byte order, with the same build of trim3r. The file appears when it is whole.

        Raises
        ------
        OSError
            The system refuses to write it. An existing file stays.
        StateError
            The stream is closed or at work.
        """
        with self._at_work():
            state = state_of(self._report, self._arena)
        host_called("t3r_write_whole", path_bytes(path), ffi.from_buffer(state), len(state), path=os.fsdecode(path))

    def load_state(self, path: Path) -> None:
        """Goes on from a file of save_state(), in place of what the stream holds.

        Raises
        ------
        OSError
            The file cannot be read.
        InputError
            It is no state, or damaged; or it is of another version, head or setting, and the text says which. The
            stream is then as before.
        StateError
            The stream is closed or at work.
        """
        name = os.fsdecode(path)
        with self._at_work():
            with open(name, "rb") as file:
                report, arena = read_state(file.read(), name)
            self._attach(arena, name)
            self._report = report

    def __repr__(self) -> str:
        size = f"{self._config.width}x{self._config.height}"
        return (f"<Stream: {size}, {self.keyframes} keyframes, "
                f"at most {self._config.max_gaussians} Gaussians"
                f"{', closed' if self.closed else ''}>")
