# SPDX-License-Identifier: Apache-2.0
"""C code of the training: compiled on first use into $TRIM3R_BUILD, otherwise into ~/.cache/trim3r."""
import ctypes
import glob
import hashlib
import os
import subprocess
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
RUNTIME = os.path.join(HERE, "..", "..", "..", "runtime")
HEADS = os.path.join(HERE, "..", "..", "..", "quant", "heads")


def build(name, sources, flags, headers=(), folder=None):
    """Returns the path of the shared library made of `sources`; compiles only if sources, flags or machine changed."""
    folder = folder or os.environ.get("TRIM3R_BUILD") or os.path.expanduser("~/.cache/trim3r")
    command = [os.environ.get("CC", "cc"), *flags, "-shared", "-fPIC"]
    digest = hashlib.sha256(" ".join(command + [os.uname().nodename]).encode())
    for path in (*sources, *headers):
        with open(path, "rb") as file:
            digest.update(file.read())
    library = os.path.join(folder, f"{name}-{digest.hexdigest()[:16]}.so")
    if not os.path.exists(library):
        os.makedirs(folder, exist_ok=True)
        handle, fresh = tempfile.mkstemp(suffix=".so", dir=folder)  # several trainers may build at once
        os.close(handle)
        try:
            subprocess.run([*command, "-o", fresh, *sources, "-lm"], check=True)
            os.replace(fresh, library)
        finally:
            if os.path.exists(fresh):
                os.unlink(fresh)
    return library


def here(*pattern):
    return sorted(glob.glob(os.path.join(HERE, "..", "..", "..", *pattern), recursive=True))


def rivals(*parts):
    """Sources of tools/study/rivals, and what they are made of."""
    tools = [path for part in ("geometry/quaternion", "scene/gaussian_shape", "scene/splat_camera")
             for path in here("tools", part + ".c")]  # fmt: skip
    return tools + [path for part in parts for path in here("tools", "study", "rivals", part + ".c")]


RIVAL_HEADERS = here("tools", "study", "rivals", "*.h") + here("tools", "scene", "*.h") + here("tools", "geometry", "*.h")
INCLUDES = ["-I" + folder for folder in (RUNTIME, os.path.join(RUNTIME, "include"), os.path.join(HERE, "..", ".."), HEADS)]


def splatter(*more):
    """Loads splat.c: the differentiable splatter and the refinement. more: compiler flags."""
    flags = ("-std=gnu11", "-O3", "-march=native", "-ffast-math", "-fno-finite-math-only", "-fopenmp", *INCLUDES, *more)
    library = ctypes.CDLL(build("splat", [os.path.join(HERE, "splat.c"), *rivals("splat_*")], flags, RIVAL_HEADERS))
    pointer, number = ctypes.c_void_p, ctypes.c_int32
    library.splat_forward.argtypes = [number] * 3 + [pointer] * 4
    library.splat_backward.argtypes = [number] * 3 + [pointer] * 6
    library.splat_refine.argtypes = [number] * 3 + [pointer] * 7
    return library


def preparer():
    """Loads prepare.c, the runtime that it calls, and the rivals' ranking."""
    sources = [os.path.join(HERE, name) for name in ("prepare.c", "prepare_rival.c")] + rivals("choose", "score*", "splat_*")
    sources += here("quant", "heads", "small.c") + here("runtime", "**", "*.c")
    headers = RIVAL_HEADERS + here("runtime", "**", "*.h") + here("tools", "study", "train", "prepare_rival.h")
    flags = ("-std=c11", "-O3", "-march=native", "-ffp-contract=off", *INCLUDES)
    library = ctypes.CDLL(build("prepare", sources, flags, headers))
    library.prepare.restype = ctypes.c_int32
    library.prepare.argtypes = [ctypes.c_void_p] * 6
    return library
