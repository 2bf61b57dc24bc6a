# SPDX-License-Identifier: Apache-2.0
"""The runtime: views in, a scene of an exact number of Gaussians, pictures of it."""
import collections
import contextlib
import os
import sys
import threading
from typing import Any, Deque, Dict, Iterator, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from ._native import INTERFACE, address, called, check, ffi, lib, text_of
from .arguments import pair, real, whole
from .camera import Camera
from .configuration import Settings, configuration
from .errors import InputError, StateError
from .frame import Frame, check_plane
from .heads import HeadName, head_of
from .hooks import Hooks, Progress
from .image_stage import arena_of, camera_of, develop
from .picture import Picture, put_planes, target_of
from .request import Importance, request_of
from .scene import GAUSSIAN, Scene

CPU_BYTES = 128


class Reconstructor:
    """A runtime and its arena, which is all the memory that it uses.

    The order of calls is that of trim3r.h: views are added, then a scene is built, rebuilt at other budgets and drawn;
    `reset()` starts over. It is a context manager, and `close()` ends it. Calls release Python's lock, so several
    reconstructors work at the same time in threads. One of them takes one call at a time.

    Parameters
    ----------
    width, height : int
        The working size in pixels, to which views are resized, 8..4096 each.
    views : int
        The most context views, 0..16. 0: it draws scenes and builds none.
    gaussians : int, optional
        The most Gaussians of a scene, and the budget where a build names none; 1..2**24. All points without it.
    head : str or path-like
        "tiny", "small", "analytic", or a path that ends in .t3w.
    render_size : pair of int, optional
        The largest picture, width and height, 1..4096 each. The working size without it.
    depth : str
        "sensor": the frames' own. "stereo": of the colours of two and more posed views.
    workers : int
        Threads, 1..16. They change no bit.
    arena_bytes : int, optional
        The size of the arena. Without it that with which nothing is slower for lack of room. It changes no bit.
    progress : callable, optional
        Called with the name of the stage, what is done and the total of that, now and then, from any thread. To raise
        an exception in it stops the work; the call that works raises it again.
    settings : mapping of str to int or str
        Any other setting, as docs/library.md lists them: {"refine": 8} say. allocate and wavelet take names, too.
        `keep_analysis` is 1 here unless it is given.

    Raises
    ------
    ValueError
        A setting is out of its range or not there, or the arena is too small.
    OSError
        The file of weights cannot be read.

    Notes
    -----
    `max_loss` needs `keep_analysis` and `refine` above 0, as is the default.
    """

    def __init__(self, width: int, height: int, *, views: int = 2, gaussians: Optional[int] = None,
                 head: HeadName = "small", render_size: Optional[Tuple[int, int]] = None,
                 depth: str = "sensor", workers: int = 1, arena_bytes: Optional[int] = None,
                 progress: Optional[Progress] = None, settings: Settings = {}) -> None:
        self._lock = threading.Lock()
        self._runtime: Any = None
        self._head = head_of(head)
        render_width, render_height = pair("render_size", render_size or (width, height))
        self._config = configuration(width, height, views, gaussians, self._head, {
            "depth": depth, "workers": workers, "render_width": render_width, "render_height": render_height,
            "keep_analysis": 1, **settings})
        plan = ffi.new("t3r_plan_info *")
        called("t3r_plan_as", INTERFACE, self._config, plan)
        if arena_bytes is not None and whole("arena_bytes", arena_bytes, 0, sys.maxsize) < plan.min_bytes:
            raise InputError(f"an arena of {arena_bytes} bytes is too small: it takes {plan.min_bytes}", "T3R_ERR_ARENA")
        self._arena = arena_of(plan.bytes if arena_bytes is None else arena_bytes)
        runtime = ffi.new("t3r_runtime **")
        called("t3r_init_as", INTERFACE, runtime, address(self._arena, "void *"), self._arena.nbytes, self._config)
        lib.t3r_set_cpu(runtime[0], lib.t3r_cpu_features())
        if self._head.nbytes and views > 0:
            called("t3r_bind_head", runtime[0], self._head.weights, self._head.nbytes, what="head")
        self._hooks = Hooks(progress, workers)
        self._hooks.bind(runtime[0])
        self._runtime = runtime[0]
        self._generation = 0
        self._points: Deque[Optional[int]] = collections.deque(maxlen=views) # of each view; None: not known

    # ---- views ----

    def add_view(self, frame: Frame) -> None:
        """Takes a context view.

        Its pixels are read during this call, where they lie: the arrays may change or go after it.

        Parameters
        ----------
        frame : Frame
            With a camera and, by sensor, with depth; of any size.

        Raises
        ------
        ValueError
            The arrays or the camera cannot be used. DepthError: there is not one measurement.
        StateError
            There is no room for another view, or there is a scene already.
        """
        with self._at_work() as runtime:
            native, kept = frame.native()
            camera = camera_of(frame).native(frame.size)
            if self._config.warm: # which discards the scene, and makes room
                self._go_on()
            self._check("t3r_add_view", runtime, native, camera)
            del kept
            self._points.append(_measured(frame, self._config))

    def add_rows(self, strip: Frame, row: int, height: int, *, depth_row: Optional[int] = None,
                 depth_height: Optional[int] = None) -> bool:
        """Takes rows of a context view, as a camera delivers them, so that no frame need be whole in memory.

        Strips come in order, those of colour and those of depth each from row 0 on. They need not keep step: an array
        without rows, as colour[:0], is none of them. The strip that completes both adds the view, with the bits of
        add_view(). Pixels are read during this call, where they lie.

        Parameters
        ----------
        strip : Frame
            Its arrays hold the rows from `row` and `depth_row` on; of "nv12" an even number. All else is that of the
            whole frame, and the same in every strip.
        row, height : int
            The first row of colour, and the rows of the whole picture, 2..4096.
        depth_row, depth_height : int, optional
            The same of depth. Without them row and height.

        Returns
        -------
        bool
            Whether the view is whole, and was added.

        Raises
        ------
        ValueError
            The arrays or the camera cannot be used, or rows lie beyond the picture. DepthError: there is not one
            measurement.
        StateError
            The strip is out of order, or of another frame than the one before it; what came stays. There is no room for
            another view, or there is a scene already.

        Notes
        -----
        A strip from row 0 of both begins a view. It discards one that came in part, as add_view(), build() and reset()
        do. `valid_points` is not known until a build.
        """
        row, height = whole("row", row, 0, lib.T3R_MAX_SIDE), whole("height", height, 2, lib.T3R_MAX_SIDE)
        depth_row = row if depth_row is None else whole("depth_row", depth_row, 0, lib.T3R_MAX_SIDE)
        depth_height = height if depth_height is None else whole("depth_height", depth_height, 2, lib.T3R_MAX_SIDE)
        with self._at_work() as runtime:
            native, kept = strip.native_strip(height, depth_height)
            camera = camera_of(strip).native((strip.size[0], height))
            rows, depth_rows = strip.size[1], 0 if strip.depth is None else strip.depth.shape[0]
            if self._config.warm: # which discards the scene
                self._go_on()
            self._check("t3r_add_rows", runtime, native, camera, row, rows, depth_row, depth_rows)
            del kept
            stereo = self._config.depth == lib.T3R_DEPTH_STEREO
            is_whole = row + rows == height and (stereo or depth_row + depth_rows == depth_height)
            if is_whole:
                self._points.append(None)
            return is_whole

    def reset(self) -> None:
        """Discards views and scene; the settings stay."""
        with self._at_work() as runtime:
            self._go_on()
            self._check("t3r_reset", runtime)
            self._points.clear()

    # ---- scenes ----

    def build(self, gaussians: Optional[int] = None, *, keep: Optional[float] = None, max_loss: float = 0,
              allocate: Optional[str] = None, head: Optional[HeadName] = None,
              importance: Optional[Importance] = None) -> Scene:
        """Makes a scene of the views.

        Parameters
        ----------
        gaussians : int, optional
            The budget. The scene has exactly so many, or all valid points where they are fewer.
        keep : float, optional
            The budget in percent of the valid points, above 0, at most 100; never more than the arena has room for.
            Without either: that of the constructor.
        max_loss : float
            Where above 0: as few Gaussians, at most the budget, as are predicted to lose so many dB at most, 0..10.
        allocate : str, optional
            How the budget is spread: "density", "paper", "pixel", "uniform", "random". That of the constructor without
            it.
        head : str or path-like, optional
            The head of this scene alone, as the constructor names it. A network needs an arena that was made for one.
        importance : sequence of ndarray of uint16, shape (height, width), optional
            A plane a view, at the working size: the points of the highest are kept.

        Returns
        -------
        Scene
            In the arena, valid until the next build, load or reset.

        Raises
        ------
        ValueError
            A parameter is out of its range, or the views cannot be used. DepthError: no two views can be matched.
        StateError
            There are no views.
        """
        return self._make("t3r_reconstruct", gaussians, keep, max_loss, allocate, head, importance)

    def rebuild(self, gaussians: Optional[int] = None, *, keep: Optional[float] = None, max_loss: float = 0,
                allocate: Optional[str] = None, head: Optional[HeadName] = None,
                importance: Optional[Importance] = None) -> Scene:
        """Makes another scene of the views analysed last, without a new analysis. Otherwise as build().

        Raises StateError also where there is no analysis.
        """
        return self._make("t3r_rebuild", gaussians, keep, max_loss, allocate, head, importance)

    def load(self, scene: Scene) -> None:
        """Takes a scene from elsewhere to be drawn, in the place of views and scene.

        Raises ValueError where it has more Gaussians than there is room for, or one is out of range.
        """
        gaussians = np.ascontiguousarray(scene.gaussians)
        if len(gaussians) > self._config.max_gaussians:
            raise InputError(f"{len(gaussians)} Gaussians are more than there is room for: {self._config.max_gaussians}")
        if np.may_share_memory(gaussians, self._arena):
            gaussians = gaussians.copy()
        with self._at_work() as runtime:
            self._go_on()
            self._points.clear()
            self._check("t3r_scene_begin", runtime, scene.native_frame())
            first = address(gaussians, "const t3r_gaussian *")
            for index in range(len(gaussians)):
                called("t3r_scene_append", runtime, first + index, what=f"Gaussian {index}")

    # ---- pictures ----

    def render(self, camera: Camera, size: Optional[Tuple[int, int]] = None,
               out: Optional["NDArray[np.uint8]"] = None) -> "NDArray[np.uint8]":
        """Draws the scene.

        Parameters
        ----------
        camera : Camera
            For the pixel grid of the picture: resized() makes one of a camera for another size. One with a distortion
            is refused: dataclasses.replace(camera, distortion="none") is the pinhole of the same view.
        size : pair of int, optional
            Width and height in pixels, at most render_size. That of `out`, else the working size, without it.
        out : ndarray of uint8, shape (H, W, 3), optional
            Where to draw. Its rows may lie apart.

        Returns
        -------
        ndarray of uint8, shape (H, W, 3)
            `out`, or a new array.

        Raises
        ------
        ValueError
            The camera, the size or the array cannot be used.
        StateError
            There is no scene.
        """
        if out is None:
            width, height = self._size(size)
            out = np.empty((height, width, 3), dtype=np.uint8)
        check_plane("out", out, np.dtype(np.uint8), 3)
        height, width = out.shape[:2]
        if size is not None and self._size(size) != (width, height):
            raise ValueError(f"out has the shape {out.shape}, not that of {size[0]}x{size[1]} pixels")
        if not out.flags.writeable:
            raise ValueError("out is read-only")
        with self._at_work() as runtime:
            self._check("t3r_render", runtime, camera.native((width, height)), target_of(out))
        return out

    def picture(self, camera: Camera, size: Optional[Tuple[int, int]] = None) -> Picture:
        """Draws the scene with its depth and alpha. Parameters and errors are those of render()."""
        width, height = self._size(size)
        colour = np.empty((height, width, 3), dtype=np.uint8)
        depth, alpha = np.empty((height, width), dtype=np.uint32), np.empty((height, width), dtype=np.uint16)
        target = target_of(colour)
        put_planes(target, depth, alpha)
        with self._at_work() as runtime:
            self._check("t3r_render", runtime, camera.native((width, height)), target)
            scene = ffi.new("t3r_scene *")
            self._check("t3r_get_scene", runtime, scene)
        return Picture(colour, depth, alpha, scene.frame.exponent)

    # ---- properties ----

    @property
    def valid_points(self) -> Optional[int]:
        """Pixels of the views so far with a depth, at the working size. None by stereo and by add_rows(): a build finds
        them."""
        known = [points for points in self._points if points is not None]
        return sum(known) if len(known) == len(self._points) else None

    @property
    def arena_bytes(self) -> int:
        """The size of the arena in bytes."""
        return int(self._arena.nbytes)

    @property
    def stage_hashes(self) -> Dict[str, str]:
        """16 hexadecimal digits for each stage that ran since the last build(), by its name; of one that ran several
        times, the last."""
        return dict(self._hooks.hashes)

    @property
    def cpu(self) -> str:
        """Names of the processor's features that the inner loops use, such as "sse4.1 avx2"; "none" for plain C."""
        text = ffi.new("char[]", CPU_BYTES)
        with self._at_work() as runtime:
            lib.t3r_cpu_describe(lib.t3r_get_cpu(runtime), text, CPU_BYTES)
        return text_of(text)

    @property
    def closed(self) -> bool:
        """Whether close() was called."""
        return self._runtime is None

    def close(self) -> None:
        """Ends its threads and lets its memory go, once no scene of it is used."""
        if self._runtime is not None:
            with self._at_work():
                self._go_on()
                self._runtime = None
                self._hooks.stop()
                self._arena = np.empty(0, dtype=np.uint8)

    def __enter__(self) -> "Reconstructor":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # ---- internal ----

    @contextlib.contextmanager
    def _at_work(self) -> Iterator[Any]:
        """The runtime, for one call at a time."""
        if not self._lock.acquire(blocking=False):
            raise StateError("the reconstructor is at work: in another thread, or in this one, which its progress calls")
        try:
            if self._runtime is None:
                raise StateError("the reconstructor is closed")
            yield self._runtime
        finally:
            self._lock.release()

    def _size(self, size: Optional[Tuple[int, int]]) -> Tuple[int, int]:
        """Returns the width and height of a picture. None: the working size."""
        width, height = pair("size", size or (self._config.width, self._config.height))
        return (whole("width", width, 1, self._config.render_width, "T3R_ERR_ARGUMENT"),
                whole("height", height, 1, self._config.render_height, "T3R_ERR_ARGUMENT"))

    def _check(self, call: str, *arguments: Any) -> None:
        check(self._hooks.run(getattr(lib, call), *arguments), call, *arguments)

    def _go_on(self) -> None:
        """Scenes that were made so far hold no longer."""
        self._generation += 1

    def _make(self, call: str, gaussians: Optional[int], keep: Optional[float], max_loss: float,
              allocate: Optional[str], head: Optional[HeadName], importance: Optional[Importance]) -> Scene:
        with self._at_work() as runtime, self._bound(runtime, head) as head_value:
            budget = self._budget(runtime, gaussians, keep)
            request, kept = request_of(self._config, len(self._points), budget, max_loss, allocate, importance)
            request.head = head_value
            self._go_on()
            if call == "t3r_reconstruct":
                self._hooks.hashes.clear()
            scene = ffi.new("t3r_scene *")
            self._check(call, runtime, request, scene)
            del kept
            return self._scene(scene)

    @contextlib.contextmanager
    def _bound(self, runtime: Any, name: Optional[HeadName]) -> Iterator[int]:
        """The head of one request, as a t3r_head. A network's weights are bound for as long."""
        if name is None:
            yield lib.T3R_HEAD_CONFIGURED
            return
        head = head_of(name)
        try:
            if head.nbytes:
                called("t3r_bind_head", runtime, head.weights, head.nbytes, what=os.fspath(name))
            yield head.value
        finally:
            if head.nbytes:
                lib.t3r_bind_head(runtime, self._head.weights, self._head.nbytes)

    def _budget(self, runtime: Any, gaussians: Optional[int], keep: Optional[float]) -> int:
        """Returns the budget in Gaussians; 0 = the constructor's."""
        most = self._config.max_gaussians
        if gaussians is not None and keep is not None:
            raise ValueError("a budget is either `gaussians` or `keep`")
        if gaussians is not None:
            return whole("gaussians", gaussians, 1, most)
        if keep is None:
            return 0
        if not 0 < real("keep", keep) <= 100:
            raise ValueError(f"keep is above 0 and at most 100 percent, not {keep}")
        points = self._matched(runtime) if self.valid_points is None else self.valid_points
        return min(int(most), max(1, int(np.floor(points * keep / 100 + 0.5))))

    def _matched(self, runtime: Any) -> int:
        """Returns the number of points that a match finds: of the current scene, else of a build of one Gaussian."""
        scene = ffi.new("t3r_scene *")
        if lib.t3r_get_scene(runtime, scene) != lib.T3R_OK:
            request = ffi.new("t3r_request *", {"gaussians": 1, "head": lib.T3R_HEAD_ANALYTIC})
            self._check("t3r_reconstruct", runtime, request, scene)
        return int(scene.valid_points)

    def _scene(self, scene: Any) -> Scene:
        start = int(ffi.cast("uintptr_t", scene.gaussians)) - self._arena.__array_interface__["data"][0]
        gaussians = self._arena[start:start + scene.count * GAUSSIAN.itemsize].view(GAUSSIAN)
        gaussians.setflags(write=False)
        made = self._generation
        return Scene.in_frame(gaussians, scene.frame, scene.valid_points, lambda: self._generation == made)


def _measured(frame: Frame, config: Any) -> Optional[int]:
    """Returns the number of pixels with a depth at the working size, by the image stage, because a runtime counts
    them only with a scene. None by stereo."""
    if config.depth != lib.T3R_DEPTH_SENSOR:
        return None
    steps = develop(frame, config.width, config.height).depth
    return 0 if steps is None else int(np.count_nonzero(steps))
