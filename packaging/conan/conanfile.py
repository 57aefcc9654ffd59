# SPDX-License-Identifier: MIT
# conan create packaging/conan: both libraries over libm alone; with_cvode takes the system's SUNDIALS, with_ccd its libccd.
import os
from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class QuatImpact(ConanFile):
    name = "quat-impact"
    license = "MIT"
    description = "Quaternion geometry and exact rigid-body impact"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "with_cvode": [True, False], "with_ccd": [True, False]}
    default_options = {"shared": False, "with_cvode": False, "with_ccd": False}
    languages = "C"

    def set_version(self):
        text = load(self, os.path.join(self.recipe_folder, "../../CMakeLists.txt"))
        self.version = text.split("VERSION ")[2].split()[0]

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "../..")
        for part in ["CMakeLists.txt", "README.md", "CHANGELOG.md", "LICENSE", "cmake/*", "libquat/*", "libimpact/*", "view/*", "examples/*", "packaging/*"]:
            copy(self, part, root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for name in ["IMPACT_BUILD_LUA", "IMPACT_BUILD_TESTS", "QUAT_WITH_GSL"]:
            toolchain.cache_variables[name] = False
        toolchain.cache_variables["IMPACT_WITH_CVODE"] = bool(self.options.with_cvode)
        toolchain.cache_variables["IMPACT_WITH_CCD"] = bool(self.options.with_ccd)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        self.cpp_info.set_property("cmake_find_mode", "none")  # the libraries' own CMake files serve
        self.cpp_info.builddirs = [os.path.join("lib", "cmake")]
