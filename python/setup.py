"""Builds the package's compiled module with CMake, from the checkout around this folder. Further CMake
options, such as those that leave out parts: the environment variable CMAKE_ARGS.
"""

import os
import pathlib
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent
OPTIONS = ["-DCMAKE_BUILD_TYPE=Release", "-DBROADMARK_TESTS=OFF", "-DBROADMARK_RENDER=OFF"]


class BuildWithCMake(build_ext):
    def build_extension(self, ext: Extension) -> None:
        module = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve()
        build = pathlib.Path(self.build_temp).resolve()
        options = [*OPTIONS, *shlex.split(os.environ.get("CMAKE_ARGS", ""))]
        for command in (
            [
                "cmake",
                "-S",
                CHECKOUT,
                "-B",
                build,
                "-G",
                "Ninja",
                f"-DPython_EXECUTABLE={sys.executable}",
                *options,
            ],
            ["cmake", "--build", build, "--target", "broadmark_python"],
        ):
            subprocess.run(command, check=True)
        module.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(build / "python" / module.name, module)
        shutil.copy(CHECKOUT / "assets/palette.txt", module.parent)


setup(
    ext_modules=[Extension("broadmark._native", sources=[])], cmdclass={"build_ext": BuildWithCMake}
)
