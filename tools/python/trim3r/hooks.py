# SPDX-License-Identifier: Apache-2.0
"""Callbacks of the library while it works: progress, hashes of stages, threads."""
from typing import Any, Callable, Dict, Optional

from ._native import called, ffi, lib
from .errors import StateError
from .stages import STAGES

Progress = Callable[[str, int, int], None]


class Hooks:
    """The callbacks of one runtime.

    `hashes` has the hash of each stage that ran, by its name. A callback that raises stops the work, and `run()` raises
    the same again: KeyboardInterrupt, say, which Python raises within a callback.
    """

    def __init__(self, progress: Optional[Progress], threads: int) -> None:
        self.hashes: Dict[str, str] = {}
        self._progress = progress
        self._raised: Optional[BaseException] = None
        # bound once: the library calls them as long as its runtime is used; what they raise must not pass through it
        self._on_progress = ffi.callback("int(void *, t3r_stage, uint32_t, uint32_t)", self._take_progress,
                                         error=1, onerror=self._take_error)
        self._on_hash = ffi.callback("void(void *, t3r_stage, uint64_t)", self._take_hash, onerror=self._take_error)
        self._threads: Any = ffi.NULL
        if threads > 1:
            started = lib.t3r_threads_start(threads)
            if started == ffi.NULL:
                raise StateError(f"the system refuses {threads} threads")
            self._threads = ffi.gc(started, lib.t3r_threads_stop)

    def bind(self, runtime: Any) -> None:
        """Has the runtime call them."""
        hooks = ffi.new("t3r_hooks *", {"user": self._threads, "progress": self._on_progress,
                                        "stage_hash": self._on_hash})
        if self._threads != ffi.NULL:
            hooks.parallel_for = lib.t3r_threads_run
        called("t3r_set_hooks", runtime, hooks)

    def run(self, function: Callable[..., int], *arguments: Any) -> int:
        """Calls a function of the library and returns its status, or raises what a callback raised."""
        self._raised = None
        status = function(*arguments)
        raised, self._raised = self._raised, None
        if raised is not None:
            raise raised
        return status

    def stop(self) -> None:
        """Ends the threads."""
        if self._threads != ffi.NULL:
            ffi.release(self._threads)
            self._threads = ffi.NULL

    def _take_progress(self, _user: Any, stage: int, done: int, total: int) -> int:
        if self._raised is None and self._progress is not None:
            self._progress(STAGES[stage], done, total)
        return 0 if self._raised is None else 1

    def _take_hash(self, _user: Any, stage: int, value: int) -> None:
        self.hashes[STAGES[stage]] = f"{value:016x}"

    def _take_error(self, _kind: Any, error: BaseException, _traceback: Any) -> None:
        self._raised = self._raised or error
