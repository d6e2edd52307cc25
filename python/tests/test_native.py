"""Tests of the algorithms as functions."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from conftest import SOURCE_FOLDER, library_of_tests

import broadmark
from broadmark.arguments import as_boxes
from broadmark.native import native


def boxes_in(side: float, count: int) -> Any:
    """Boxes of all sizes, including touching, flat and equal boxes."""
    generator = np.random.default_rng(3)
    low = np.round(generator.uniform(0, side, (count, 3)))
    return np.stack([low, low + generator.integers(0, 3, (count, 3))], axis=1).astype(np.float32)


def brute_force(boxes: Any) -> set[tuple[int, int]]:
    low, high = boxes[:, None, 0], boxes[None, :, 1]
    overlap = (low <= high).all(2)
    return {(a, b) for a, b in np.argwhere(overlap & overlap.T).tolist() if a < b}


@pytest.mark.parametrize("algorithm", native().algorithms())
@pytest.mark.parametrize("count", [0, 1, 2, 300])
def test_every_algorithm_finds_the_pairs(algorithm: str, count: int) -> None:
    boxes = boxes_in(12, count)
    try:
        pairs = broadmark.overlaps(boxes, algorithm, threads=2)
    except broadmark.InputError as error:
        if algorithm.startswith(("gpu-", "b3-")):  # no device, or an unsuitable device
            pytest.skip(str(error))
        raise
    assert pairs.dtype == np.uint32 and pairs.shape == (len(pairs), 2)
    assert len(pairs) == len(set(map(tuple, pairs.tolist())))
    assert set(map(tuple, pairs.tolist())) == brute_force(boxes)


def test_boxes_can_be_flat_doubles_or_views() -> None:
    boxes = boxes_in(12, 300)
    expected = brute_force(boxes)
    padded = np.zeros((300, 2, 4), np.float32)
    padded[..., :3] = boxes
    for array in (boxes.reshape(-1, 6), boxes.astype(float), padded[..., :3], boxes.tolist()):
        assert set(map(tuple, broadmark.overlaps(array).tolist())) == expected


def test_an_empty_list_is_no_boxes() -> None:
    assert broadmark.overlaps([]).shape == (0, 2)


@pytest.mark.parametrize("dtype", [np.float64, np.int64, np.int32, np.float16, np.longdouble])
def test_other_numbers_are_rounded_outward(dtype: Any) -> None:
    generator = np.random.default_rng(5)
    size = 60_000 if dtype == np.float16 else 2.0**31 - 1
    low = generator.uniform(-size, size, (1000, 3)).astype(dtype)
    if dtype == np.int64:
        low *= 2**31  # beyond the integers that doubles hold
    boxes = np.stack([low, low], axis=1)
    rounded = as_boxes(boxes)
    exact, bounds = boxes.astype(np.longdouble), rounded.astype(np.longdouble)
    assert rounded.dtype == np.float32
    assert (bounds[:, 0] <= exact[:, 0]).all() and (bounds[:, 1] >= exact[:, 1]).all()
    # By no more than to the next float.
    assert (np.nextafter(rounded[:, 0], np.float32(np.inf)) > exact[:, 0]).all()
    assert (np.nextafter(rounded[:, 1], np.float32(-np.inf)) < exact[:, 1]).all()
    assert (rounded[:, 0] < rounded[:, 1]).any() == (dtype != np.float16)


def test_doubles_that_touch_in_between_floats_overlap() -> None:
    boxes = [[0, 0, 0, 1 + 2**-30, 1, 1], [1 + 2**-30, 0, 0, 2, 1, 1]]
    assert broadmark.overlaps(boxes).tolist() == [[0, 1]]


def test_parameters_and_instruction_sets() -> None:
    boxes = boxes_in(12, 300)
    for isa in ("scalar", "auto"):
        pairs = broadmark.overlaps(boxes, "kd", isa=isa, parameters={"objects_per_leaf": 8})
        assert set(map(tuple, pairs.tolist())) == brute_force(boxes)


# The call takes an hour, so the test would time out if the call held the GIL.
OTHER_THREADS = """
import os, sys, threading, time
sys.path.insert(0, {package!r})
import numpy, broadmark
begun = threading.Event()
def work():
    begun.set()
    broadmark.overlaps(boxes, "bf")
boxes = numpy.zeros((4_000_000, 2, 3), numpy.float32)
boxes += numpy.arange(len(boxes), dtype=numpy.float32)[:, None, None]
broadmark.overlaps(boxes[:2], "bf")
threading.Thread(target=work, daemon=True).start()
begun.wait()
for _ in range(1000):
    time.sleep(0)  # yields to the other thread
os._exit(0)
"""


def test_former_parameter_names_are_accepted_with_a_warning() -> None:
    boxes = np.zeros((2, 6), dtype=np.float32)
    with pytest.warns(FutureWarning, match="'crowded' is now called 'split_threshold'"):
        pairs = broadmark.overlaps(boxes, "columns", parameters={"crowded": 7})
    assert pairs.tolist() == [[0, 1]]


# The pairs of all these boxes would take gigabytes.
MEMORY_ENDS = """
import re, resource, sys
sys.path.insert(0, {package!r})
import numpy, broadmark
boxes = numpy.zeros((20_000, 2, 3), numpy.float32)
broadmark.overlaps(boxes[:9], {algorithm!r}, threads=1)
used = int(re.search(r"VmData:\\s*(\\d+)", open("/proc/self/status").read())[1]) * 1024
hard = resource.getrlimit(resource.RLIMIT_DATA)[1]
resource.setrlimit(resource.RLIMIT_DATA, (used + (512 << 20), hard))
try:
    broadmark.overlaps(boxes, {algorithm!r}, threads=1)
except broadmark.InputError as error:
    print(error)
assert broadmark.overlaps(boxes[:3], {algorithm!r}, threads=1).shape == (3, 2)
"""


@pytest.mark.parametrize("algorithm", ["axis-sweep", "dbvt-f", "ode-hash", "kd"])
def test_the_interpreter_survives_the_end_of_memory(algorithm: str) -> None:
    if algorithm not in native().algorithms():
        pytest.skip(f"no {algorithm} in this build")
    code = MEMORY_ENDS.format(package=str(SOURCE_FOLDER / "python"), algorithm=algorithm)
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.startswith(f"{algorithm}: "), ended.stdout
    assert "memory" in ended.stdout


def test_the_gil_is_released() -> None:
    code = OTHER_THREADS.format(package=str(SOURCE_FOLDER / "python"))
    subprocess.run([sys.executable, "-c", code], check=True)


MASKED: Any = np.zeros((2, 6)).view(np.ma.MaskedArray)


@pytest.mark.parametrize(
    ("library", "algorithm"),
    [("libc_sweep.so", "c-sweep"), ("libquick_search.so", "repeated-search")],
)
def test_plugins_find_the_pairs(library: str, algorithm: str) -> None:
    boxes = boxes_in(12, 300)
    plugin = library_of_tests(library)
    pairs = broadmark.overlaps(boxes, algorithm, plugin=plugin)
    assert sorted(map(tuple, pairs.tolist())) == sorted(brute_force(boxes))
    with pytest.raises(broadmark.InputError, match="has no algorithm 'no-such'"):
        broadmark.overlaps(boxes, "no-such", plugin=plugin)
    with pytest.raises(broadmark.InputError, match="unknown parameter 'cells'"):
        broadmark.overlaps(boxes, algorithm, plugin=plugin, parameters={"cells": 3})
    with pytest.raises(broadmark.InputError, match="/no/such.so: .*No such file"):
        broadmark.overlaps(boxes, algorithm, plugin="/no/such.so")


def test_several_plugins_may_have_the_algorithm() -> None:
    boxes = boxes_in(12, 300)
    plugins = [library_of_tests(name) for name in ("libc_sweep.so", "libquick_search.so")]
    for algorithm in ("c-sweep", "repeated-search"):
        pairs = broadmark.overlaps(boxes, algorithm, plugin=plugins)
        assert sorted(map(tuple, pairs.tolist())) == sorted(brute_force(boxes))
    with pytest.raises(broadmark.InputError, match="has no algorithm 'no-such'"):
        broadmark.overlaps(boxes, "no-such", plugin=plugins)
    with pytest.raises(broadmark.InputError, match="unknown parameter 'cells'"):
        broadmark.overlaps(boxes, "c-sweep", plugin=plugins, parameters={"cells": 3})


INVALID_ARGUMENTS: list[tuple[dict[str, Any], str]] = [
    ({"boxes": np.zeros((2, 5))}, r"of shape \(2, 5\), expected \(n, 2, 3\) or \(n, 6\)"),
    ({"boxes": np.zeros((2, 3, 2))}, "of shape"),
    ({"boxes": [[0, 0, 0, 1, 1, np.nan]]}, "body 0 has a coordinate that is not a finite number"),
    ({"boxes": [[0, 0, 0, 1, np.inf, 1]]}, "body 0 has a coordinate"),
    ({"boxes": [[0] * 6, [0, 0, 2, 1, 1, 1]]}, "body 1 has a min"),
    ({"boxes": [["x"] * 6]}, "expected numbers"),
    ({"boxes": [[0] * 6, [0] * 5]}, "boxes: not an array: "),
    ({"boxes": MASKED}, "boxes: a masked array"),
    ({"boxes": [[0, 0, 0, 1, 1, 1e300]]}, "body 0 has a coordinate"),
    ({"boxes": [[1 + 1e-12, 0, 0, 1, 1, 1]]}, "body 0 has a min"),
    ({"algorithm": "quick"}, r"unknown algorithm 'quick' \(one of: bf, "),
    ({"algorithm": "colums"}, "unknown algorithm 'colums'; did you mean 'columns'?"),
    ({"algorithm": "none"}, "unknown algorithm 'none'"),
    ({"isa": "mmx"}, "isa 'mmx'"),
    ({"threads": 0}, "threads 0: expected an integer from 1 to"),
    ({"threads": 1.5}, "threads 1.5: expected an integer"),
    ({"parameters": {"cells": 3}}, "unknown parameter 'cells'"),
    ({"algorithm": "grid-sap", "parameters": {"objects_per_cell": "many"}}, "objects_per_cell"),
]


@pytest.mark.parametrize(("arguments", "message"), INVALID_ARGUMENTS)
def test_invalid_arguments_are_rejected(arguments: dict[str, Any], message: str) -> None:
    all_arguments: dict[str, Any] = {"boxes": np.zeros((1, 6))} | arguments
    with pytest.raises(broadmark.InputError, match=message):
        broadmark.overlaps(**all_arguments)


def test_few_algorithms_need_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    boxes = [[0, 0, 0, 1, 1, 1], [1, 1, 1, 2, 2, 2]]
    native()

    def not_found() -> str:
        raise broadmark.InputError("not found")

    monkeypatch.setattr("broadmark.native.find_program", not_found)
    assert broadmark.overlaps(boxes).tolist() == [[0, 1]]
    with pytest.raises(
        broadmark.InputError, match="dbvt-d: runs in a process of the program broadmark"
    ):
        broadmark.overlaps(boxes, "dbvt-d")
