"""Algorithms as functions: boxes in, overlapping pairs out."""

from __future__ import annotations

import functools
import importlib.util
import os
import pathlib
from collections.abc import Iterable, Iterator
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt

from broadmark.arguments import as_boxes, as_threads
from broadmark.errors import InputError
from broadmark.program import Path, find_program


def overlaps(
    boxes: Any,
    algorithm: str = "columns",
    *,
    threads: int | None = None,
    isa: str = "auto",
    parameters: dict[str, Any] | None = None,
    plugin: Path | Iterable[Path] | None = None,
) -> npt.NDArray[np.uint32]:
    """All pairs of overlapping boxes: an (m, 2) array of indices, the smaller index first.

    `boxes` is an array (n, 2, 3) or (n, 6): min x y z, max x y z. 32-bit floats are not converted;
    other numbers are rounded outward: min down, max up. Touching boxes overlap. The order of the
    pairs depends on the algorithm. Only parallel algorithms use `threads` (default: all cores). The
    call releases the GIL. `plugin`: libraries with more algorithms (docs/plugins.md). Plug-ins,
    and libraries that end the process when memory runs out (Bullet, ODE), run in a process of their
    own; all others in this one.

    Raises InputError for other shapes, NaN, inverted boxes and unknown names, or if memory runs out.
    """
    texts = {name: str(value) for name, value in (parameters or {}).items()}
    array = np.ascontiguousarray(as_boxes(boxes))
    try:
        program = find_program()
    except InputError:
        program = ""  # few algorithms need it
    plugins = [plugin] if isinstance(plugin, (str, os.PathLike)) else plugin or ()
    file, *others = [os.path.abspath(path) for path in plugins] or [""]
    try:
        pairs: npt.NDArray[np.uint32] = native().overlaps(
            array, str(algorithm), as_threads(threads), str(isa), texts, file, program
        )
        return pairs
    except InputError as error:
        if not others or "has no algorithm" not in str(error):
            raise
    return overlaps(
        array, algorithm, threads=threads, isa=isa, parameters=parameters, plugin=others
    )


def _folders() -> Iterator[pathlib.Path]:
    yield pathlib.Path(__file__).parent
    yield pathlib.Path(find_program()).parent / "python"


@functools.cache
def native() -> ModuleType:
    """The compiled module, installed with this package or built next to the program."""
    for folder in _folders():
        for file in folder.glob("_native*.so"):
            spec = importlib.util.spec_from_file_location("broadmark._native", file)
            if spec is not None and spec.loader is not None:
                module = importlib.util.module_from_spec(spec)
                spec.loader.exec_module(module)
                return module
    raise InputError(
        "the compiled module of the package was not found: build with BROADMARK_PYTHON=ON"
    )
