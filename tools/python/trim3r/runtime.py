# SPDX-License-Identifier: Apache-2.0
"""A runtime of the library in an arena of its own: what a reconstructor and a stream have in common."""
import contextlib
import sys
import threading
from typing import Any, Dict, Iterator, Optional, Tuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ._native import INTERFACE, address, called, check, ffi, lib, text_of
from ._settings import SETTINGS
from .arguments import pair, whole
from .camera import Camera
from .errors import InputError, StateError
from .frame import check_plane
from .heads import Head
from .hooks import Hooks, Progress
from .image_stage import arena_of
from .picture import Picture, put_planes, target_of
from .scene import GAUSSIAN, Scene

CPU_BYTES = 128
Self = TypeVar("Self", bound="Runtime")


class Runtime:
    """An arena, the runtime in it, and its callbacks. It takes one call at a time, and ends with close()."""

    _KIND = "runtime"  # the name in messages

    def __init__(self, config: Any, head: Head, arena_bytes: Optional[int], progress: Optional[Progress]) -> None:
        self._lock = threading.Lock()
        self._runtime: Any = None
        self._config, self._head = config, head
        plan = ffi.new("t3r_plan_info *")
        called("t3r_plan_as", INTERFACE, config, plan)
        if arena_bytes is not None and whole("arena_bytes", arena_bytes, 0, sys.maxsize) < plan.min_bytes:
            raise InputError(f"an arena of {arena_bytes} bytes is too small: it takes {plan.min_bytes}", "T3R_ERR_ARENA")
        self._arena = arena_of(plan.bytes if arena_bytes is None else arena_bytes)
        runtime = ffi.new("t3r_runtime **")
        called("t3r_init_as", INTERFACE, runtime, address(self._arena, "void *"), self._arena.nbytes, config)
        self._hooks = Hooks(progress, config.workers)
        self._bind(runtime[0])
        self._runtime = runtime[0]
        self._generation = 0

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
            self._draw(runtime, camera.native((width, height)), target_of(out))
        return out

    def picture(self, camera: Camera, size: Optional[Tuple[int, int]] = None) -> Picture:
        """Draws the scene with its depth and alpha. Parameters and errors are those of render()."""
        width, height = self._size(size)
        colour = np.empty((height, width, 3), dtype=np.uint8)
        depth, alpha = np.empty((height, width), dtype=np.uint32), np.empty((height, width), dtype=np.uint16)
        target = target_of(colour)
        put_planes(target, depth, alpha)
        with self._at_work() as runtime:
            self._draw(runtime, camera.native((width, height)), target)
            scene = ffi.new("t3r_scene *")
            self._check("t3r_get_scene", runtime, scene)
        depth, exponent = self._of_scene(depth, camera.native((width, height)), scene.frame.exponent)
        return Picture(colour, depth, alpha, exponent)

    def _of_scene(self, depth_q20: "NDArray[np.uint32]", eye: Any, exponent: int) -> "Tuple[NDArray[np.uint32], int]":
        """The depths in scene units, and the exponent of these."""
        return depth_q20, exponent

    # ---- properties ----

    @property
    def arena_bytes(self) -> int:
        """The size of the arena in bytes."""
        return int(self._arena.nbytes)

    @property
    def stage_hashes(self) -> Dict[str, str]:
        """16 hexadecimal digits for each stage that ran since the last build() or keyframe(), by its name; of one that ran
        several times, the last."""
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

    def __reduce__(self) -> Tuple[Any, ...]:
        raise TypeError(f"a {type(self).__name__} is not pickled or copied: pickle the scene or a copy of it")

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # ---- internal ----

    @contextlib.contextmanager
    def _at_work(self) -> Iterator[Any]:
        """The runtime, for one call at a time."""
        if not self._lock.acquire(blocking=False):
            raise StateError(f"the {self._KIND} is at work: in another thread, or in this one, which its progress calls")
        try:
            if self._runtime is None:
                raise StateError(f"the {self._KIND} is closed")
            yield self._runtime
        finally:
            self._lock.release()

    def _bind(self, runtime: Any) -> None:
        """Gives a runtime what no arena holds: the processor's features, the head's weights and the callbacks."""
        lib.t3r_set_cpu(runtime, lib.t3r_cpu_features())
        if self._head.nbytes and self._config.views > 0:
            called("t3r_bind_head", runtime, self._head.weights, self._head.nbytes, what="head")
        self._hooks.bind(runtime)

    def _attach(self, saved: "NDArray[np.uint8]", what: str) -> None:
        """Goes on from the bytes of a saved arena. After an error nothing has changed.

        Raises InputError where it is damaged, or of other settings or another head.
        """
        arena, runtime = arena_of(saved.nbytes), ffi.new("t3r_runtime **")
        arena[:] = saved
        called("t3r_attach_as", INTERFACE, runtime, address(arena, "void *"), arena.nbytes, what=what)
        its, ours = (lib.t3r_get_config(one) for one in (runtime[0], self._runtime))
        for name in SETTINGS:
            if getattr(its, name) != getattr(ours, name):
                raise InputError(f"{what}: {name} is {getattr(its, name)} in the state, not {getattr(ours, name)}")
        if lib.t3r_head_crc(runtime[0]) != lib.t3r_head_crc(self._runtime):
            raise InputError(f"{what}: the state is of another head")
        self._bind(runtime[0])
        self._arena, self._runtime = arena, runtime[0]
        self._hooks.hashes.clear()
        self._go_on()

    def _size(self, size: Optional[Tuple[int, int]]) -> Tuple[int, int]:
        """Returns the width and height of a picture. None: the working size."""
        width, height = pair("size", size or (self._config.width, self._config.height))
        return (whole("width", width, 1, self._config.render_width, "T3R_ERR_ARGUMENT"),
                whole("height", height, 1, self._config.render_height, "T3R_ERR_ARGUMENT"))

    def _draw(self, runtime: Any, camera: Any, target: Any) -> None:
        """Draws the scene in the arena."""
        self._check("t3r_render", runtime, camera, target)

    def _check(self, call: str, *arguments: Any) -> None:
        check(self._hooks.run(getattr(lib, call), *arguments), call, *arguments)

    def _go_on(self) -> None:
        """Scenes that were made so far hold no longer."""
        self._generation += 1

    def _scene(self, scene: Any) -> Scene:
        start = int(ffi.cast("uintptr_t", scene.gaussians)) - self._arena.__array_interface__["data"][0]
        gaussians = self._arena[start:start + scene.count * GAUSSIAN.itemsize].view(GAUSSIAN)
        gaussians.setflags(write=False)
        made = self._generation
        return Scene.in_frame(gaussians, scene.frame, scene.valid_points, lambda: self._generation == made)
