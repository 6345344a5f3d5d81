# SPDX-License-Identifier: Apache-2.0
"""Puts the golden core's library into the package, where the source tree around it has been built."""

import os
import pathlib
import shutil

from setuptools import setup
from setuptools.command.build_py import build_py

TREE = pathlib.Path(__file__).resolve().parent.parent


class BuildWithLibrary(build_py):
    def run(self):
        super().run()
        build = pathlib.Path(os.environ.get("KAGE_BUILD", TREE / "build/release"))
        library = build / "lib/libkage_golden.so"
        if library.exists():
            shutil.copyfile(library.resolve(), pathlib.Path(self.build_lib) / "kage/libkage_golden.so")


setup(cmdclass={"build_py": BuildWithLibrary})
