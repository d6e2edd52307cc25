"""Algorithms as functions: boxes in, overlapping pairs out."""

from __future__ import annotations

import functools
import importlib.util
import os
import pathlib
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt

from broadmark.errors import InputError
from broadmark.program import find_program
from broadmark.recordings import as_boxes


def overlaps(
    boxes: Any,
    algorithm: str = "grid-sap",
    *,
    threads: int | None = None,
    isa: str = "auto",
    parameters: dict[str, Any] | None = None,
) -> npt.NDArray[np.uint32]:
    """All pairs of overlapping boxes: an (m, 2) array of indices, the smaller index first.

    `boxes` is an array (n, 2, 3) or (n, 6): min x y z, max x y z; 32-bit floats are not converted.
    Touching boxes overlap. The order of the pairs depends on the algorithm. Only parallel algorithms
    use `threads` (default: all cores). The call releases the GIL. Algorithms of libraries that end
    the process when memory ends (Bullet, ODE) run in a process of their own; all others in this one.

    Raises InputError for other shapes, NaN, inverted boxes and unknown names, and when memory ends.
    """
    native = _native()
    if algorithm not in native.algorithms():
        known = ", ".join(native.algorithms())
        raise InputError(f"algorithm '{algorithm}': unknown; expected one of {known}")
    if threads is None:
        threads = len(os.sched_getaffinity(0))
    if not 1 <= threads <= 1024:
        raise InputError(f"threads {threads}: expected a number from 1 to 1024")
    texts = {name: str(value) for name, value in (parameters or {}).items()}
    try:
        pairs: npt.NDArray[np.uint32] = native.overlaps(
            np.ascontiguousarray(as_boxes(boxes)), algorithm, threads, isa, texts, find_program()
        )
    except native.NativeInputError as error:
        raise InputError(str(error)) from None
    return pairs


@functools.cache
def _native() -> ModuleType:
    """The compiled module, installed with this package or built next to the program."""
    folders = [pathlib.Path(__file__).parent, pathlib.Path(find_program()).parent / "python"]
    for folder in folders:
        for file in folder.glob("_native*.so"):
            spec = importlib.util.spec_from_file_location("broadmark._native", file)
            if spec is not None and spec.loader is not None:
                module = importlib.util.module_from_spec(spec)
                spec.loader.exec_module(module)
                return module
    raise InputError(
        "the compiled module of the package was not found: build with BROADMARK_PYTHON=ON"
    )
