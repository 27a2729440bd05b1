"""A program that checks a sampler, built with the package and run: what `conan create` tests."""

from conan import ConanFile
from conan.tools.cmake import CMake, cmake_layout


class CrescentTest(ConanFile):
    settings = "os", "compiler", "build_type", "arch"
    generators = "CMakeDeps", "CMakeToolchain"

    def requirements(self):
        self.requires(self.tested_reference_str)

    def layout(self):
        cmake_layout(self)

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def test(self):
        self.run(f"{self.cpp.build.bindir}/my_sampler", env="conanrun")
