"""Measures a function of Python as a case: the same frames, checks and statistics as the program's."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import re
import tempfile
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from broadmark.arguments import Floats, as_integer
from broadmark.errors import InputError
from broadmark.program import BOXES, Names, Path, as_source, call, run
from broadmark.recording2 import ChangingRecording
from broadmark.recordings import PoseRecording, Recording, read_recording
from broadmark.results import PHASES, Results, read_results

Answers = list[npt.NDArray[np.uint32]]


@dataclasses.dataclass
class _Pass:
    initialize_ns: int
    times_ns: list[int]
    answers: Answers


def measure(
    function: Callable[[Floats], Any] | type[Any],
    source: Any,
    *,
    name: str | None = None,
    repetitions: int = 1,
    warmup: int = 0,
    margin: float = 0,
    objects: int | None = None,
    object_type: Names | None = None,
    frames: int | None = None,
    seed: int | None = None,
    param: dict[str, Any] | None = None,
) -> Results:
    """Times a function frame by frame, and checks every answer against the program's oracle.

    `function` takes the boxes of a frame, an array (n, 2, 3) of 32-bit floats (absent bodies have
    EMPTY_BOX), and returns the overlapping pairs, an array (m, 2) of indices in any order. In every
    pass it gets the initial pose first, whose time is that of the initialisation, and whose answer is
    not checked. A class is instantiated for every pass, so that it can keep its state.

    `source` is a recording, an imported file, boxes as in `run`, or a scene with `objects` to `param` as
    in `run`. A function gets no layers, tags, worlds or periodic box: recordings with these are refused.
    `warmup` passes precede each measured one. `margin`: pairs count as right if the boxes overlap
    once each is enlarged by it. `name`: of the algorithm; by default the function's. All work counts as
    `search_overlaps`.

    The results are like those of `run`: they can be added to them and saved, and a wrong answer is the
    status `mismatch`. An exception of the function is passed on.
    """
    as_integer("repetitions", repetitions, 1, 1_000_000)
    as_integer("warmup", warmup, 0, 1_000_000)
    if not isinstance(name, str | None):
        raise InputError(f"name {name!r}: expected a text")
    label = name or _name_of(function)
    scene: dict[str, Any] = {"objects": objects, "object_type": object_type, "frames": frames}
    scene |= {"seed": seed, "param": param}
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        opened = as_source(source, folder, **scene)
        recording = read_recording(_recording_of(opened, scene, folder))
        assert not isinstance(recording, PoseRecording)
        _require_boxes_only(recording)
        passes = []
        for number in range(repetitions * (1 + warmup)):
            measured = _run_pass(function, recording)
            if number % (1 + warmup) == warmup:
                passes.append(measured)
        checked: list[Results] = []
        for number, one in enumerate(passes):
            if number == 0 or not _are_equal(one.answers, passes[0].answers):
                checked.append(_check(one, opened, scene, margin, folder))
        failed = [results for results in checked if results.details[0]["status"] != "ok"]
        results = (failed or checked)[0]
        details = results.details[0]
        others: dict[str, Any] = {
            "id": details["id"].replace("/logged", f"/{label}", 1),
            "algorithm": label,
            "family": "Python",
            "plugin": "",
            "params": details["params"] if margin else {},
            "initialize_ns": [one.initialize_ns for one in passes],
            "peak_bytes": None,
            "processor": {key: [None] * repetitions for key in details["processor"]},
            "frames": {phase: [[0] * len(one.times_ns) for one in passes] for phase in PHASES},
            "counters": {},
            "setup": {},
        }
        for phase in ("search_overlaps", "total"):
            others["frames"][phase] = [one.times_ns for one in passes]
        details |= others
        details["conditions"] |= {
            "warmup": warmup,
            "repetitions": repetitions,
            "in_process": True,
            "pinned": False,
            "frame_limit_seconds": None,
            "initialize_limit_seconds": None,
            "call_limit_seconds": None,
            "plugin": {"hash": "", "flags": ""},
        }
        # The program computes the summary.
        cases, summed = os.path.join(folder, "cases.json"), os.path.join(folder, "summed.json")
        results.save(cases)
        call("merge", cases, "--json", summed)
        passed = None if opened is source else BOXES
        return read_results(summed).renamed(f"measure({label})", ["measure", label], passed)


def _name_of(function: Any) -> str:
    name = getattr(function, "__name__", type(function).__name__)
    return re.sub(r"[^\w.-]+", "", name) or "function"


def _recording_of(source: Path | list[Path], scene: dict[str, Any], folder: str) -> pathlib.Path:
    """The source if it is a recording of boxes, else a recording of it."""
    if not isinstance(source, (str, os.PathLike)):
        raise InputError("source: several, expected one")
    path = pathlib.Path(source)
    if path.suffix in (".aabbs", ".broadmark"):
        return path
    boxes = pathlib.Path(folder, "recorded.aabbs")
    if path.suffix == ".posrot":
        call("convert", os.fspath(path), os.fspath(boxes), "--quiet")
        return boxes
    recorded = pathlib.Path(folder, "recorded")
    options: dict[str, Any] = {**scene, "record": recorded, "recorder": "broadmark"}
    run(source, algorithm="none", check="off", **options)
    found = list(recorded.rglob("*.broadmark"))
    if not found:  # not a simulation
        call("import", os.fspath(path), "--output", os.fspath(recorded), "--quiet")
        found = list(recorded.parent.glob("recorded.*"))
    if len(found) != 1:
        raise InputError(f"{source}: expands to {len(found)} recordings, expected one")
    return found[0]


def _require_boxes_only(recording: Recording | ChangingRecording) -> None:
    """Raises InputError if the pairs do not depend on the boxes alone."""
    if not isinstance(recording, ChangingRecording):
        return
    groups = recording.groups
    has_filter = recording.filter_changes or (0, 0) not in groups.colliding_layers
    has_filter |= any(part is not None for part in (groups.layers, groups.worlds, groups.tags))
    if has_filter or recording.periodic is not None:
        raise InputError(
            f"{recording.name}: its pairs depend on layers, tags, worlds or a periodic box, which the "
            "function does not get"
        )


def _frames_of(recording: Recording | ChangingRecording) -> Iterator[Floats]:
    """An own array for each frame."""
    if isinstance(recording, Recording):
        yield from (np.array(boxes, np.float32, order="C") for boxes in recording.boxes)
    else:
        yield from (boxes.copy() for boxes, _ in recording.frames())


def _run_pass(function: Any, recording: Recording | ChangingRecording) -> _Pass:
    frames = _frames_of(recording)
    clock = time.perf_counter_ns
    first = next(frames)
    start = clock()
    if isinstance(function, type):
        function = function()
    function(first)
    one = _Pass(clock() - start, [], [])
    for number, boxes in enumerate(frames, 1):
        start = clock()
        answer = function(boxes)
        one.times_ns.append(clock() - start)
        one.answers.append(_as_pairs(answer, number))
    return one


def _as_pairs(answer: Any, frame: int) -> npt.NDArray[np.uint32]:
    """The answer with the smaller body first, sorted."""
    try:
        pairs = np.asarray(answer if hasattr(answer, "__getitem__") else list(answer))
    except (TypeError, ValueError) as error:
        raise InputError(f"frame {frame}: the answer is not an array of pairs: {error}") from None
    if pairs.size == 0:
        return np.empty((0, 2), np.uint32)
    is_valid = pairs.ndim == 2 and pairs.shape[1] == 2 and pairs.dtype.kind in "iu"
    if not is_valid or pairs.min() < 0 or pairs.max() > 0xFFFFFFFF:
        raise InputError(
            f"frame {frame}: the answer has the shape {pairs.shape} and type {pairs.dtype}, expected "
            "indices (m, 2)"
        )
    sorted_pairs: npt.NDArray[np.uint32] = np.sort(pairs.astype(np.uint32), axis=1)
    order = np.lexsort((sorted_pairs[:, 1], sorted_pairs[:, 0]))
    answer_pairs: npt.NDArray[np.uint32] = sorted_pairs[order]
    return answer_pairs


def _are_equal(a: Answers, b: Answers) -> bool:
    return all(np.array_equal(x, y) for x, y in zip(a, b))


def _check(one: _Pass, source: Any, scene: dict[str, Any], margin: float, folder: str) -> Results:
    """The results of the program's algorithm that reads a log of these answers."""
    log = os.path.join(folder, "pairs.jsonl")
    with open(log, "w", encoding="utf-8") as file:
        for number, pairs in enumerate(one.answers, 1):
            file.write(json.dumps({"frame": number, "pairs": pairs.tolist()}) + "\n")
    param = dict(scene["param"] or {}, **({"logged:margin": margin} if margin else {}))
    limits = {"time_limit": 1e9, "hard_limit": 1e9}
    options: dict[str, Any] = {**scene, **limits, "param": param, "plugin": f"pairs:{log}"}
    return run(source, algorithm="logged", **options)
