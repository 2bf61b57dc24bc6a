# SPDX-License-Identifier: Apache-2.0
"""declare.py HEADER ROOT PACKAGE BUILD COMPILER OPTION...: what the Python package knows of C, out of the headers.

PACKAGE/_declarations.py has every type and constant that HEADER leads to below ROOT, and the functions of the headers
that HEADER itself includes, in the form that cffi loads. PACKAGE/_settings.py has the settings. BUILD/exports.ld makes
the linker take these functions and data from their archives, and BUILD/exports.map exports nothing else.
"""
import pathlib
import re
import subprocess
import sys

import cffi

MODULE = "_declarations"
MARKER = re.compile(r'^# \d+ "([^"]*)"')
NUMBER = re.compile(r"#define ([A-Z][A-Z0-9_]*[A-Z0-9]) (\d+|0x[0-9a-fA-F]+)[uU]?$")
INLINE = re.compile(r"static inline [^;{]*\{.*?^\}$", re.M | re.S)
ASSERTION = re.compile(r"^_Static_assert\(.*?\);$", re.M | re.S)
FUNCTION = re.compile(r"^(?!typedef)[a-z_][\w \n*]*?\b(\w+)\([^;{}]*\);", re.M)
DATA = re.compile(r"^extern const [\w *]*?\b(\w+)(?:\[\w*\])?;", re.M)


def passages_of(header, root, compiler):
    """(path, text) of every passage below the root, in the order in which the compiler sees them."""
    text = subprocess.run([*compiler, "-E", "-dD", str(header)], check=True, capture_output=True, text=True).stdout
    path, lines = None, []
    for line in [*text.splitlines(), '# 1 ""']:
        marker = MARKER.match(line)
        if not marker:
            lines.append(line)
            continue
        entered = pathlib.Path(marker[1]).resolve()
        if entered == path: # a macro of a system's header, within a declaration perhaps
            continue
        if path is not None and path.is_relative_to(root):
            yield path, "\n".join(lines) + "\n"
        path, lines = entered, []


def declarations(text):
    """Removes everything that cffi does not accept: bodies of functions, assertions, pragmas, macros that are no whole
    number."""
    kept = [line for line in text.splitlines() if not line.startswith("#") or NUMBER.match(line)]
    kept = [NUMBER.sub(r"#define \1 \2", line) for line in kept]
    return ASSERTION.sub("", INLINE.sub("", "\n".join(kept) + "\n"))


def settings_of(header, compiler):
    """Python: {setting: (kind, help, least, most)}, out of the rows of T3R_SETTINGS; values with names have no range."""
    rows = "#define ROW(name, kind, low, high, usual, feature, from, group, option, help) " \
           "#name: (#kind, help, RANGE_##kind(low, high)),\n"
    for kind in ("number", "q8", "toggle"):
        rows += f"#define RANGE_{kind}(low, high) low, high\n"
    for kind in ("wavelet", "allocation", "head", "depth"):
        rows += f"#define RANGE_{kind}(low, high) 0, 0xffffffff\n"
    text = f'#include "{header}"\n{rows}SETTINGS = {{T3R_SETTINGS(ROW)}}\n'
    done = subprocess.run([*compiler, "-E", "-P", "-x", "c", "-"], input=text, check=True, capture_output=True, text=True)
    rows = re.sub(r"\b(\d+)U\b", r"\1", done.stdout[done.stdout.rindex("SETTINGS = {"):]) # UINT32_MAX
    return re.sub(r"\), (?=\")", "),\n            ", rows)


def main():
    header, root, package, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:5])
    compiler = sys.argv[5:]
    direct = set(re.findall(r'^#include "(?:.*/)?([^"/]+)"$', header.read_text(), re.M))
    whole, exports = "", []
    for path, text in passages_of(header, root, compiler):
        text = declarations(text)
        if path.name in direct:
            exports += FUNCTION.findall(text) + DATA.findall(text)
        else:
            text = FUNCTION.sub("", text)
        whole += text
    ffi = cffi.FFI()
    ffi.cdef(whole)
    ffi.set_source(MODULE, None)
    ffi.emit_python_code(str(package / f"{MODULE}.py"))
    (package / "_settings.py").write_text(settings_of(header, compiler))
    (build / "exports.ld").write_text(f"EXTERN({' '.join(exports)})\n")
    (build / "exports.map").write_text("{ global: " + " ".join(f"{name};" for name in exports) + " local: *; };\n")


if __name__ == "__main__":
    main()
