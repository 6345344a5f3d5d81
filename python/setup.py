# SPDX-License-Identifier: Apache-2.0
"""Puts the golden core's library into the package, where the source tree around it has been built. The wheel is for this
machine then."""

import os
import pathlib
import shutil

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

TREE = pathlib.Path(__file__).resolve().parent.parent


LIBRARY = pathlib.Path(os.environ.get("KAGE_BUILD", TREE / "build/release")) / "lib/libkage_golden.so"


class BuildWithLibrary(build_py):
    def run(self):
        super().run()
        copy = pathlib.Path(self.build_lib) / "kage/libkage_golden.so"
        copy.unlink(missing_ok=True)  # an older build's
        # Where it will be once it is built: kage.golden looks there too, and names the place where it is missing.
        (copy.parent / "built_library.txt").write_text(f"{LIBRARY}\n")
        if LIBRARY.exists():
            shutil.copyfile(LIBRARY.resolve(), copy)
        else:
            print(f"{LIBRARY}: missing: the package takes it from there once kage is built (tools/demo)")


class ForThisMachine(Distribution):
    def has_ext_modules(self):
        return LIBRARY.exists()


setup(cmdclass={"build_py": BuildWithLibrary}, distclass=ForThisMachine)
