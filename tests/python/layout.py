#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""layout.py LIBRARY COMPILER: each struct and each constant of the package equals the compiler's, and each function
exists."""
import pathlib
import subprocess
import sys
import tempfile

from common import ROOT, check, np, trim3r
from trim3r._native import dtype_of, ffi, lib

from checks import done, run

INCLUDES = [f"-I{ROOT / folder}" for folder in ("runtime/include", "platform", "quant/heads", "tools", "tools/python")]


def structs():
    """Yields the structs that the headers define."""
    for name in ffi.list_types()[0]:
        pointer = ffi.typeof(name + " *") # some names are functions', which have no size
        if pointer.kind == "pointer" and pointer.item.kind == "struct" and pointer.item.fields is not None:
            yield name, pointer.item


def constants():
    return [name for name in dir(lib) if isinstance(getattr(lib, name), int) and name.isupper()]


def program():
    """Returns C that prints a line for each size, offset and constant, as the compiler sees it."""
    lines = ['#include "interface.h"', "#include <stdio.h>", "int main(void)", "{"]
    for name, ctype in structs():
        lines.append(f'printf("{name}: %zu\\n", sizeof({name}));')
        for field, _ in ctype.fields:
            place = f"offsetof({name}, {field}), sizeof((({name} *)0)->{field})"
            lines.append(f'printf("{name}.{field}: %zu %zu\\n", {place});')
    lines += [f'printf("{name}: %lld\\n", (long long){name});' for name in constants()]
    return "\n".join([*lines, "return 0;", "}", ""])


def expected():
    for name, ctype in structs():
        yield f"{name}: {ffi.sizeof(ctype)}"
        for field, told in ctype.fields:
            yield f"{name}.{field}: {told.offset} {ffi.sizeof(told.type)}"
    yield from (f"{name}: {getattr(lib, name)}" for name in constants())


def differing(wanted, seen):
    return [pair for pair in zip(wanted, seen) if pair[0] != pair[1]]


def main():
    with tempfile.TemporaryDirectory(prefix="trim3r-python-") as folder:
        source = pathlib.Path(folder) / "layout.c"
        source.write_text(program())
        subprocess.run([sys.argv[2], "-std=gnu11", *INCLUDES, source, "-o", source.with_suffix("")], check=True)
        seen = run(source.with_suffix("")).stdout.splitlines()
    wanted = list(expected())
    check(len(wanted) == len(seen) and len(wanted) > 300, f"{len(wanted)} lines for {len(seen)}")
    check(differing(["t3r_frame.width: 4 4"], ["t3r_frame.width: 8 4"]), "an offset that is planted is found")
    check(not differing(wanted, seen), f"cffi and the compiler differ: {differing(wanted, seen)}")
    functions = [name for name in dir(lib) if not name.isupper()]
    check(len(functions) > 80 and all(getattr(lib, name) is not None for name in functions), "every function is there")
    gaussian = dtype_of("t3r_gaussian")
    check(gaussian.itemsize == ffi.sizeof("t3r_gaussian") and gaussian["factor"].shape == (9,), f"{gaussian}")
    check(np.zeros(1, gaussian)["position_q20"].dtype == np.int32, "a field's type")
    version = f"{lib.T3R_VERSION_MAJOR}.{lib.T3R_VERSION_MINOR}.{lib.T3R_VERSION_PATCH}"
    check(trim3r.__version__ == version and trim3r.BITS_EPOCH == lib.T3R_BITS_EPOCH, "the version")
    done()


if __name__ == "__main__":
    main()
