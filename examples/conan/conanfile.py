"""crescent::check as a Conan 2 package: `conan create examples/conan --build=missing`."""

from pathlib import Path

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class Crescent(ConanFile):
    name = "crescent"
    description = "Tests for importance samplers in rendering"
    license = "Apache-2.0"
    package_type = "static-library"
    settings = "os", "compiler", "build_type", "arch"
    requires = "fmt/[>=9.1 <13]", "nlohmann_json/[>=3.11 <4]", "onetbb/[>=2021.8 <2023]", "xxhash/[>=0.8 <1]"

    def set_version(self):
        self.version = load(self, Path(self.recipe_folder) / "../../VERSION").strip()

    def export_sources(self):
        root = Path(self.recipe_folder) / "../.."
        for pattern in ("CMakeLists.txt", "VERSION", "LICENSE", "cmake/*", "src/*", "include/*"):
            copy(self, pattern, root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["CRESCENT_RUN"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        # The package's own crescentConfig.cmake is what find_package(crescent) reads.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["lib/cmake/crescent"]
