#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""recipes.py: the recipes for Conan, vcpkg and Yocto parse, agree with the tree, and set existing options.

The tools need not be installed. Conan's recipe runs with stand-ins for Conan's classes, vcpkg's port with stand-ins for
vcpkg's functions, and Yocto's recipe is read line by line.
"""
import hashlib
import json
import pathlib
import re
import sys
import tempfile
import types

from library import FEATURES, ROOT, ended, there

from checks import check, done

PACKAGING = ROOT / "tools" / "packaging"
OPTIONS = {"T3R_TOOLS", "T3R_SHARED", *(f"T3R_WITH_{name.upper()}" for name in FEATURES)}



class Recorder:
    """Accepts any call, any attribute and any key; records what was set."""

    def __init__(self, *_):
        self.set, self.items = {}, {}

    def __getattr__(self, name):
        return self.__dict__.setdefault(name, Recorder())

    def __getitem__(self, key):
        return self.items.setdefault(key, Recorder())

    def __setitem__(self, key, value):
        self.set[key] = value

    def __call__(self, *_, **__):
        return None


def conan_recipe(source, toolchains):
    """Returns the recipe's class, with stand-ins for its imports."""
    def toolchain(_):
        toolchains.append(Recorder())
        return toolchains[-1]

    modules = {"conan": {"ConanFile": object}, "conan.tools": {}, "conan.tools.files": {"copy": Recorder()},
               "conan.tools.cmake": {"CMake": Recorder, "CMakeToolchain": toolchain, "cmake_layout": Recorder()}}
    for name, names in modules.items():
        sys.modules[name] = types.ModuleType(name)
        vars(sys.modules[name]).update(names)
    space = {}
    exec(compile(source, "conanfile.py", "exec"), space)  # pylint: disable=exec-used
    return next(value for name, value in space.items() if name.endswith("Conan"))


def conan_findings(source):
    toolchains = []
    try:
        recipe = conan_recipe(source, toolchains)()
    except SyntaxError as error:
        return [f"conanfile.py: {error}"]
    recipe.settings, recipe.cpp_info = Recorder(), Recorder()
    recipe.source_folder = recipe.package_folder = "folder"
    recipe.options = types.SimpleNamespace(**{**recipe.default_options, "stereo": False})
    recipe.configure()
    recipe.layout()
    recipe.generate()
    recipe.build()
    recipe.package()
    recipe.package_info()
    variables = toolchains[0].cache_variables.set
    library = recipe.cpp_info.components["trim3r"]
    return [finding for finding, bad in (
        (f"conanfile.py: sets {sorted(variables)}", set(variables) != OPTIONS),
        ("conanfile.py: stereo is not left out", variables.get("T3R_WITH_STEREO") is not False),
        ("conanfile.py: stereo's macro is not told", library.defines != ["T3R_FEATURE_STEREO=0"]),
        ("conanfile.py: options and defaults differ", set(recipe.options.__dict__) != set(recipe.default_options)),
        ("conanfile.py: a default is not among an option's values",
         any(value not in recipe.__class__.options[name] for name, value in recipe.default_options.items()))) if bad]



KEYS = {"name", "version", "description", "license", "supports", "dependencies", "default-features", "features"}
NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
STAND_INS = """
foreach(name vcpkg_cmake_install vcpkg_cmake_config_fixup vcpkg_fixup_pkgconfig vcpkg_install_copyright)
  function(${name})
  endfunction()
endforeach()
function(vcpkg_check_features)
  list(POP_FRONT ARGN option variable features)
  while(ARGN)
    list(POP_FRONT ARGN feature switch)
    list(APPEND made "-D${switch}=ON")
  endwhile()
  set(${variable} "${made}" PARENT_SCOPE)
endfunction()
function(vcpkg_cmake_configure)
  message(STATUS "configure ${ARGN}")
endfunction()
set(CURRENT_PACKAGES_DIR "${CMAKE_CURRENT_LIST_DIR}/nothing")
include("${PORT}")
"""


def manifest_findings(text):
    try:
        manifest = json.loads(text)
    except json.JSONDecodeError as error:
        return [f"vcpkg.json: {error}"]
    names = [manifest["name"], *manifest["features"], *(row["name"] for row in manifest["dependencies"])]
    return [finding for finding, bad in (
        (f"vcpkg.json: keys {sorted(set(manifest) - KEYS)}", not set(manifest) <= KEYS),
        (f"vcpkg.json: a name among {names}", not all(map(NAME.fullmatch, names))),
        ("vcpkg.json: a feature without a description",
         not all(set(row) == {"description"} for row in manifest["features"].values())),
        ("vcpkg.json: features", tuple(manifest["features"]) != FEATURES or
         tuple(manifest["default-features"]) != FEATURES)) if bad]


def port_findings(port, folder):
    script = folder / "port.cmake"
    script.write_text(STAND_INS)
    made = ended("cmake", f"-DPORT={port}", "-P", script)
    if made.returncode != 0:
        return [f"portfile.cmake: {made.stderr}"]
    given = set(re.findall(r"-D(\w+)=(?:ON|OFF|[01])", made.stdout))
    return [] if given == OPTIONS else [f"portfile.cmake: sets {sorted(given)}"]



LINE = re.compile(r'(?:#.*|inherit [a-z ]+|([A-Z_]+(?:\[\w+\]|:\$\{PN\})?) (?:=|\?=|\?\?=|\+=) "([^"]*)")?')


def yocto_findings(text):
    values = {}
    for number, line in enumerate(text.splitlines(), 1):
        match = LINE.fullmatch(line)
        if match is None:
            return [f"the recipe's line {number}: {line}"]
        if match[1]:
            values[match[1]] = match[2]
    given = set(re.findall(r"-D(\w+)=", text)) | {"T3R_SHARED"} # both libraries by default
    checksum = hashlib.md5((ROOT / "LICENSE").read_bytes()).hexdigest()
    return [finding for finding, bad in (
        ("the recipe's licence is another", values.get("LIC_FILES_CHKSUM") != f"file://LICENSE;md5={checksum}"),
        (f"the recipe sets {sorted(given)}", given != OPTIONS),
        ("the recipe's features", tuple(values.get("PACKAGECONFIG", "").split()) != FEATURES),
        ("a feature without its switch", not all(
            values.get(f"PACKAGECONFIG[{name}]") == f"-DT3R_WITH_{name.upper()}=ON,-DT3R_WITH_{name.upper()}=OFF"
            for name in FEATURES)),
        ("the bills of materials go into no package", values.get("FILES:${PN}") != "${datadir}/sbom"),
        ("no summary", not values.get("SUMMARY"))) if bad]


def main():
    conan = (PACKAGING / "conan/conanfile.py").read_text()
    manifest = (PACKAGING / "vcpkg/trim3r/vcpkg.json").read_text()
    port = PACKAGING / "vcpkg/trim3r/portfile.cmake"
    yocto = next((PACKAGING / "yocto").glob("*.bb")).read_text()

    check(conan_findings(conan.replace("T3R_SHARED", "T3R_SHARE")), "blind: Conan's recipe with a wrong option")
    check(conan_findings(conan.replace("def build(self):", "def build(self)")), "blind: Conan's recipe does not parse")
    check(manifest_findings(manifest.replace('"supports"', '"support"', 1)), "blind: vcpkg's manifest with a wrong key")
    check(yocto_findings(yocto.replace("md5=", "md5=0")), "blind: another licence")
    check(yocto_findings(yocto.replace("/sbom", "/some")), "blind: bills in no package")
    check(yocto_findings(yocto + "oops\n"), "blind: a line that is none")
    findings = [*conan_findings(conan), *manifest_findings(manifest), *yocto_findings(yocto)]
    with tempfile.TemporaryDirectory(prefix="trim3r-recipes-") as folder:
        folder = pathlib.Path(folder)
        if there("cmake"):
            wrong = folder / "portfile.cmake"
            wrong.write_text(port.read_text().replace("T3R_TOOLS", "T3R_TOOL"))
            check(port_findings(wrong, folder), "blind: vcpkg's port with a wrong option")
            findings += port_findings(port, folder)
    for finding in findings:
        check(False, finding)
    done()


if __name__ == "__main__":
    main()
