# SPDX-License-Identifier: Apache-2.0
"""The runtime: views in, a scene of an exact number of Gaussians, pictures of it."""
import collections
import contextlib
import os
from typing import Any, Deque, Iterator, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from ._native import HOST, address, called, check, ffi, lib
from .arguments import pair, real, whole
from .configuration import Settings, configuration
from .errors import InputError
from .frame import Frame
from .heads import HeadName, head_of
from .hooks import Progress
from .image_stage import camera_of, develop
from .request import Importance, request_of
from .runtime import Runtime
from .scene import Scene


class Reconstructor(Runtime):
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

    _KIND = "reconstructor"

    def __init__(self, width: int, height: int, *, views: int = 2, gaussians: Optional[int] = None,
                 head: HeadName = "small", render_size: Optional[Tuple[int, int]] = None,
                 depth: str = "sensor", workers: int = 1, arena_bytes: Optional[int] = None,
                 progress: Optional[Progress] = None, settings: Settings = {}) -> None:
        weights = head_of(head)
        render_width, render_height = pair("render_size", render_size or (width, height))
        config = configuration(width, height, views, gaussians, weights, {
            "depth": depth, "workers": workers, "render_width": render_width, "render_height": render_height,
            "keep_analysis": 1, **settings})
        super().__init__(config, weights, arena_bytes, progress)
        self._loaded: Any = None # the scene in the arena if its colours depend on the camera
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
        """Takes a scene from elsewhere to be drawn, in the place of views and scene. One with harmonics has in each
        picture the colours that its camera sees.

        Raises ValueError where it has more Gaussians than there is room for, or one is out of range.
        """
        gaussians = scene.gaussians
        if len(gaussians) > self._config.max_gaussians:
            raise InputError(f"{len(gaussians)} Gaussians are more than there is room for: {self._config.max_gaussians}")
        if np.may_share_memory(gaussians, self._arena):
            scene = scene.copy()
        file, kept = scene.native()
        with self._at_work() as runtime:
            self._go_on()
            self._points.clear()
            self._load(runtime, file, ffi.NULL, (0, 0))
            self._loaded = (file, kept) if scene.depends_on_camera else None

    # ---- properties ----

    @property
    def valid_points(self) -> Optional[int]:
        """Pixels of the views so far with a depth, at the working size. None by stereo and by add_rows(): a build finds
        them."""
        known = [points for points in self._points if points is not None]
        return sum(known) if len(known) == len(self._points) else None

    def __repr__(self) -> str:
        size = f"{self._config.width}x{self._config.height}"
        return (f"<Reconstructor: {size}, {len(self._points)} of {self._config.views} views, at most "
                f"{self._config.max_gaussians} Gaussians{', closed' if self.closed else ''}>")

    # ---- internal ----

    def _go_on(self) -> None:
        super()._go_on()
        self._loaded = None

    def _draw(self, runtime: Any, camera: Any, target: Any) -> None:
        if self._loaded is not None:
            self._load(runtime, self._loaded[0], camera, (target.width, target.height))
        super()._draw(runtime, camera, target)

    def _of_scene(self, depth_q20: "NDArray[np.uint32]", eye: Any, exponent: int) -> "Tuple[NDArray[np.uint32], int]":
        if self._loaded is None:
            return depth_q20, exponent
        depths = np.empty(depth_q20.shape)
        lib.t3r_scene_depths_as(HOST, self._loaded[0], eye, address(depth_q20, "uint32_t *"), depths.size,
                                address(depths, "double *"))
        unit = max(self._loaded[0].frame.exponent, int(np.frexp(depths.max())[1]) - 12) # 2**12 units and less fit
        steps = np.rint(np.ldexp(depths, 20 - unit))
        return np.minimum(steps, 2**32 - 1).astype(np.uint32), unit

    def _load(self, runtime: Any, file: Any, eye: Any, size: Tuple[int, int]) -> None:
        """Appends the Gaussians of a file, as the eye sees them."""
        status = lib.t3r_scene_load_as(HOST, runtime, file, eye, *size)
        if status == lib.T3R_ERR_ARGUMENT: # a Gaussian: that after those which are there
            scene = ffi.new("t3r_scene *")
            check(lib.t3r_get_scene(runtime, scene), "t3r_scene_begin", runtime, ffi.addressof(file, "frame"))
            check(status, "t3r_scene_append", runtime, file.gaussians + scene.count, what=f"Gaussian {scene.count}")
        check(status, "t3r_scene_load")

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


def _measured(frame: Frame, config: Any) -> Optional[int]:
    """Returns the number of pixels with a depth at the working size, by the image stage, because a runtime counts
    them only with a scene. None by stereo."""
    if config.depth != lib.T3R_DEPTH_SENSOR:
        return None
    steps = develop(frame, config.width, config.height).depth
    return 0 if steps is None else int(np.count_nonzero(steps))
