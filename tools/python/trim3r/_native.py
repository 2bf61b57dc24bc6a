# SPDX-License-Identifier: Apache-2.0
"""The package's shared library, and what calls of it have in common."""
import errno
import os
import pathlib
import re
from typing import Any, Callable, Sequence

import numpy as np

from ._declarations import ffi as _ffi
from .errors import error_of

ffi: Any = _ffi
lib: Any = ffi.dlopen(str(pathlib.Path(__file__).with_name("libtrim3r_python.so")))
ERROR_BYTES = 512
INTERFACE: int = lib.t3r_interface() # the declarations are of the headers that the library was compiled with
HOST: Any = lib.t3r_host_interface() # the same of the host library
_CALLS = {"reconstruct": "build", "scene_begin": "load", "scene_append": "load", "stream_keyframe": "keyframe"} # or the same
_VALUE = re.compile(r"\bT3R_(?:ALLOCATE|DEPTH|DISTORTION|PIXEL)_(\w+)") # of settings and arguments that take names
_STATUS_NAMES = {getattr(lib, name): name for name in dir(lib) if name.startswith(("T3R_ERR_", "T3R_HOST_ERR_"))}
_SYSTEM = {os.strerror(code): code for code in errno.errorcode}


def text_of(pointer: Any) -> str:
    """A text of the library; "" for NULL."""
    return "" if pointer == ffi.NULL else str(ffi.string(pointer).decode("utf-8", "replace"))


def _in_python(text: str) -> str:
    """A sentence of the library with the names that the package has for things."""
    text = re.sub(r"\bt3r_(\w+)\(\)", lambda match: _CALLS.get(match[1], match[1]) + "()", text)
    text = _VALUE.sub(lambda match: repr(match[1].lower()), text)
    return re.sub(r"\bconfig\.", "", text).replace("NULL", "None").replace("--drop-invalid", "drop_invalid=True")


def _reason(status: int, call: str, arguments: Sequence[Any]) -> str:
    """The sentence about an error of a call, or the words for its status."""
    explain = getattr(lib, call + "_error", None)
    if explain is None:
        return text_of(lib.t3r_error_text(status))
    text = ffi.new("char[]", lib.T3R_ERROR_BYTES)
    return _in_python(text_of(explain(status, *arguments, text, lib.T3R_ERROR_BYTES)))


def check(status: int, call: str, *arguments: Any, what: str = "") -> None:
    """Raises the error of a t3r_status that is not T3R_OK, for the reason that the library finds in the arguments of the
    call; `what` is put before it."""
    if status != lib.T3R_OK:
        raise error_of(_STATUS_NAMES[status], (f"{what}: " if what else "") + _reason(status, call, arguments))


def called(call: str, *arguments: Any, what: str = "") -> None:
    """Calls a function of the library by its name, and raises its error."""
    check(getattr(lib, call)(*arguments), call, *arguments, what=what)


def host_called(call: str, *arguments: Any, path: str = "") -> str:
    """Calls a function of the host library that writes into error[] by its name, and returns its remarks.

    Raises its error: OSError where the system refuses a file, which `path` names.
    """
    error = ffi.new("char[]", ERROR_BYTES)
    status = getattr(lib, call)(*arguments, error, ERROR_BYTES)
    text = text_of(error)
    if status == lib.T3R_OK:
        return text
    reason = text.rpartition(": ")[2]
    if status == lib.T3R_HOST_ERR_FILE and reason in _SYSTEM:
        raise OSError(_SYSTEM[reason], reason, path)
    raise error_of(_STATUS_NAMES[status], _in_python(text))


def value_named(kind: str, name_of: Callable[[int], Any], count: int, name: str) -> int:
    """The value of an enumeration that the library gives this name.

    Raises ValueError, which lists the names, where there is none.
    """
    names = {text_of(name_of(value)): value for value in range(count)}
    names.pop("", None)
    if name not in names:
        raise ValueError(f"{kind} is one of {', '.join(names)}, not {name!r}")
    return names[name]


def address(array: "np.ndarray[Any, Any]", kind: str) -> Any:
    """A C pointer to the first element. The array must outlive its use."""
    return ffi.cast(kind, array.__array_interface__["data"][0])


def dtype_of(name: str) -> "np.dtype[Any]":
    """The structured dtype with the layout of a C struct of numbers."""
    ctype = ffi.typeof(name)
    names, formats, offsets = [], [], []
    for field, told in ctype.fields:
        length = (told.type.length,) if told.type.kind == "array" else ()
        element = told.type.item if length else told.type
        names.append(field)
        formats.append((np.dtype(element.cname.removesuffix("_t")), length))
        offsets.append(told.offset)
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": ffi.sizeof(name)})


def borrowed(pointer: Any, count: int, owner: Any, dtype: "np.dtype[Any]") -> "np.ndarray[Any, Any]":
    """`count` elements at a C pointer as a read-only array, which keeps `owner` alive."""
    kept = ffi.gc(ffi.cast("uint8_t *", pointer), lambda _: owner)
    array = np.frombuffer(ffi.buffer(kept, count * dtype.itemsize), dtype=dtype)
    array.setflags(write=False)
    return array
