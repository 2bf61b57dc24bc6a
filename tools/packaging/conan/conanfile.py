# SPDX-License-Identifier: Apache-2.0
"""The recipe for Conan 2: `conan create tools/packaging/conan` in the tree."""
import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy

FEATURES = ("comparison", "stereo", "streams", "learned", "refinement", "extras", "backdrop")


class Trim3rConan(ConanFile):
    name = "trim3r"
    version = "0.2.0"
    license = "Apache-2.0"
    description = "Posed camera frames to a budgeted set of 3-D Gaussians, in integers"
    topics = ("gaussian-splatting", "embedded", "fixed-point", "reconstruction")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], **{feature: [True, False] for feature in FEATURES}}
    default_options = {"shared": False, **{feature: True for feature in FEATURES}}

    def export_sources(self):
        tree = os.path.join(self.recipe_folder, "..", "..", "..")
        for pattern in ("CMakeLists.txt", "libraries.cmake", "LICENSE", "runtime/*", "quant/heads/*", "tools/packaging/*",
                        "tools/amalgamate"):
            copy(self, pattern, src=tree, dst=self.export_sources_folder)

    def configure(self):
        self.settings.rm_safe("compiler.libcxx")
        self.settings.rm_safe("compiler.cppstd")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["T3R_TOOLS"] = False
        toolchain.cache_variables["T3R_SHARED"] = bool(self.options.shared)
        for feature in FEATURES:
            toolchain.cache_variables[f"T3R_WITH_{feature.upper()}"] = bool(getattr(self.options, feature))
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", src=self.source_folder, dst=os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        library = self.cpp_info.components["trim3r"]
        library.libs = ["trim3r"]
        library.defines = [f"T3R_FEATURE_{feature.upper()}=0" for feature in FEATURES if not getattr(self.options, feature)]
        library.set_property("cmake_target_name", "trim3r::trim3r")
        library.set_property("pkg_config_name", "trim3r")
        heads = self.cpp_info.components["heads"]
        heads.libs = ["trim3r_heads"]
        heads.requires = ["trim3r"]
        heads.set_property("cmake_target_name", "trim3r::heads")
        heads.set_property("pkg_config_name", "trim3r-heads")
