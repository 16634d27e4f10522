# SPDX-License-Identifier: Apache-2.0
"""Builds the compiled module of the Python package with CMake, in the folder given by TETWRIGHT_BUILD or in
build/python. pip runs this from the root of the repository, through backend.py."""
import os
import pathlib
import shutil
import subprocess
import sys

import setuptools
from setuptools.command.build_ext import build_ext


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        build = pathlib.Path(os.environ.get("TETWRIGHT_BUILD", "build/python")).resolve()
        if not (build / "build.ninja").exists():
            subprocess.run(["cmake", "-S", ".", "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            "-DTETWRIGHT_PYTHON=ON", "-DTETWRIGHT_TESTS=OFF", "-DTETWRIGHT_BENCHMARKS=OFF",
                            f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", str(build), "--target", "tetwright_python"], check=True)
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(build / "python" / "tetwright" / target.name, target)


setuptools.setup(packages=["tetwright"], package_dir={"tetwright": "tools/python/tetwright"},
                 package_data={"tetwright": ["py.typed", "*.pyi"]},
                 ext_modules=[setuptools.Extension("tetwright._core", [])], cmdclass={"build_ext": CMakeBuild})
