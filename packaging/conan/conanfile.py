# A recipe for Conan 2 and the sources that it lies in: conan create LIGHTBIN/packaging/conan -s compiler.cppstd=20
# For CMake the package is called lightbin and its target lightbin::lightbin.
import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.files import copy, load


class Lightbin(ConanFile):
    name = "lightbin"
    description = "Bins thousands of lights into screen tiles or clusters, for forward, deferred and compute renderers"
    license = "MIT"
    topics = ("graphics", "rendering", "lighting", "clustered-shading", "header-only")
    package_type = "header-library"
    settings = "os", "arch", "compiler", "build_type"
    no_copy_source = True

    @property
    def _root(self):
        return os.path.join(self.recipe_folder, "..", "..")

    def set_version(self):
        header = load(self, os.path.join(self._root, "include", "lightbin", "version.hpp"))
        self.version = ".".join(re.findall(r"define LIGHTBIN_VERSION_\w+ (\d+)", header))

    def export_sources(self):
        copy(self, "include/*", self._root, self.export_sources_folder)
        copy(self, "LICENSE", self._root, self.export_sources_folder)

    def validate(self):
        check_min_cppstd(self, 20)

    def package(self):
        copy(self, "include/*", self.source_folder, self.package_folder)
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_id(self):
        self.info.clear()

    def package_info(self):
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
