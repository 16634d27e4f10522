# SPDX-License-Identifier: Apache-2.0
"""Build backend named in pyproject.toml: setuptools, with its setup.py in this folder instead of the root."""
from setuptools import build_meta


class _Backend(build_meta._BuildMetaBackend):
    def run_setup(self, setup_script="tools/python/setup.py"):
        super().run_setup(setup_script)


_backend = _Backend()
build_wheel = _backend.build_wheel
build_sdist = _backend.build_sdist
get_requires_for_build_wheel = _backend.get_requires_for_build_wheel
get_requires_for_build_sdist = _backend.get_requires_for_build_sdist
prepare_metadata_for_build_wheel = _backend.prepare_metadata_for_build_wheel
