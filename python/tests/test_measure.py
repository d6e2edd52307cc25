"""Tests of functions of Python as cases."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np
import pandas as pd
import pytest
from test_native import boxes_in, brute_force

import broadmark
from broadmark.program import call

FRAMES = [boxes_in(8 + i, 40) for i in range(4)]


def all_pairs(boxes: Any) -> Any:
    low, high = boxes[:, None, 0], boxes[None, :, 1]
    overlap = (low <= high).all(2)
    return np.argwhere(np.triu(overlap & overlap.T, 1))


class Repeated:
    """Answers with the pairs of its first frame, and knows how often it was called."""

    instances = 0

    def __init__(self) -> None:
        Repeated.instances += 1
        self.pairs: Any = None
        self.calls = 0

    def __call__(self, boxes: Any) -> Any:
        self.calls += 1
        self.pairs = all_pairs(boxes) if self.pairs is None else self.pairs
        return self.pairs


def test_a_function_is_a_case_beside_those_of_the_program(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "boxes.aabbs"
    broadmark.write_recording(path, FRAMES)
    own = broadmark.measure(all_pairs, path, repetitions=3, warmup=1)
    case = own.cases.iloc[0]
    assert (case["algorithm"], case["family"], case["status"]) == ("all_pairs", "Python", "ok")
    assert (case["repetitions"], case["missed"], case["false"]) == (3, 0, 0)
    assert list(own.frames["pairs"]) == [len(brute_force(boxes)) for boxes in FRAMES[1:]] * 3
    times = own.frames["total_ns"]
    assert (times > 0).all() and (own.frames["search_overlaps_ns"] == times).all()
    assert case["seconds_per_frame"] == pytest.approx(times.mean() * 1e-9)
    assert case["ci95_low_seconds"] < case["seconds_per_frame"] < case["ci95_high_seconds"]

    both = own + broadmark.run(path, algorithm="bf,kd", threads=1)
    assert list(both.cases["algorithm"]) == ["all_pairs", "bf", "kd"]
    assert both.cases["recording_hash"].nunique() == both.cases["machine"].nunique() == 1
    both.save(tmp_path / "both.json")
    pd.testing.assert_frame_equal(
        broadmark.read_results(tmp_path / "both.json").frames, both.frames
    )
    assert "all_pairs" in call("compare", str(tmp_path / "both.json"), "--by", "algorithm")


@pytest.mark.parametrize("kind", ["plot", "report"])
def test_functions_are_in_plots_and_reports(
    kind: str, tmp_path: pathlib.Path, command: Any
) -> None:
    both = broadmark.measure(all_pairs, FRAMES) + broadmark.run(FRAMES, algorithm="bf")
    both.save(tmp_path / "both.json")
    output = tmp_path / ("page.html" if kind == "report" else "plot.svg")
    options = ["--no-pictures"] if kind == "report" else []
    words = [kind, "bars"] if kind == "plot" else [kind]
    status, _, error = command(*words, tmp_path / "both.json", "-o", output, *options)
    assert (status, error) == (0, "") and "all_pairs" in output.read_text()


def test_a_scene_is_measured_as_by_run() -> None:
    options: dict[str, Any] = {"objects": 60, "frames": 3, "seed": 4}
    own = broadmark.measure(all_pairs, "brownian", **options)
    theirs = broadmark.run("brownian", algorithm="bf", **options)
    assert own.cases["id"][0].replace("all_pairs", "bf") == theirs.cases["id"][0]
    assert own.cases["recording_hash"][0] == theirs.cases["recording_hash"][0]
    assert list(own.frames["pairs"]) == list(theirs.frames["pairs"])


def test_recordings_and_imported_files_are_measured(tmp_path: pathlib.Path) -> None:
    boxes = np.array(FRAMES)
    np.save(tmp_path / "boxes.npy", boxes)
    rows = [
        f"{number},{body}," + ",".join(map(str, box.ravel()))
        for number, frame in enumerate(boxes)
        for body, box in enumerate(frame)
    ]
    header = "frame,id,min_x,min_y,min_z,max_x,max_y,max_z"
    (tmp_path / "boxes.csv").write_text("\n".join([header, *rows]))
    broadmark.write_recording(tmp_path / "boxes.aabbs", FRAMES)
    broadmark.write_recording(tmp_path / "boxes.broadmark", FRAMES)
    recordings = [broadmark.read_recording(tmp_path / f"boxes.{e}") for e in ("aabbs", "broadmark")]
    expected = [len(brute_force(frame)) for frame in FRAMES[1:]]
    for source in (tmp_path / "boxes.npy", str(tmp_path / "boxes.csv"), *recordings):
        results = broadmark.measure(all_pairs, source)
        assert list(results.cases["status"]) == ["ok"], source
        assert list(results.frames["pairs"]) == expected
        is_file = isinstance(source, (str, pathlib.Path))
        name = str(source) if is_file else "boxes from Python"
        assert results.cases["recording_file"][0] == name


def test_poses_are_measured(tmp_path: pathlib.Path) -> None:
    options: dict[str, Any] = {"objects": 20, "frames": 2, "record": tmp_path}
    theirs = broadmark.run("freefall", algorithm="bf", recorder="posrot", **options)
    (path,) = tmp_path.rglob("*.posrot")
    own = broadmark.measure(all_pairs, path)
    assert list(own.cases["status"]) == ["ok"]
    assert own.cases["pairs_mean"][0] == theirs.cases["pairs_mean"][0]


def test_sources_that_cannot_be_measured(tmp_path: pathlib.Path) -> None:
    with pytest.raises(broadmark.InputError, match="source: several, expected one"):
        broadmark.measure(all_pairs, ["brownian", "freefall"])
    with pytest.raises(broadmark.InputError, match="frames: for scenes, but the source is boxes"):
        broadmark.measure(all_pairs, FRAMES, frames=3)
    with pytest.raises(broadmark.InputError, match="no.npy"):
        broadmark.measure(all_pairs, tmp_path / "no.npy")
    number: Any = 3
    with pytest.raises(broadmark.InputError, match="name 3: expected a text"):
        broadmark.measure(all_pairs, FRAMES, name=number)
    message = "its pairs depend on layers, tags, worlds or a periodic box, which the function"
    tags = np.full((40, 3), 2**32 - 1, np.uint32)
    tags[:, 0] = 1
    ones = np.ones(40, np.uint32)
    everything: list[dict[str, Any]] = [{"tags": tags}, {"worlds": ones}, {"colliding_layers": ()}]
    for groups in everything:
        path = tmp_path / "filtered.broadmark"
        broadmark.write_recording(path, FRAMES, groups=broadmark.Groups(**groups))
        for source in (path, broadmark.read_recording(path)):
            with pytest.raises(broadmark.InputError, match=f"^Custom: {message}"):
                broadmark.measure(all_pairs, source)
    with pytest.raises(broadmark.InputError, match=f"^World: {message}"):
        broadmark.measure(all_pairs, "world", objects=300, frames=2)


def test_boxes_leave_no_path(tmp_path: pathlib.Path) -> None:
    results = broadmark.measure(all_pairs, FRAMES)
    assert list(results.cases["recording_file"]) == ["boxes from Python"]
    assert list(results.cases["file"]) == ["measure(all_pairs)"]
    results.save(tmp_path / "saved.json")
    assert "/broadmark-" not in (tmp_path / "saved.json").read_text()


def test_parameters_are_those_of_the_measurement() -> None:
    assert list(broadmark.measure(all_pairs, FRAMES).cases["params"]) == [""]
    with_margin = broadmark.measure(all_pairs, FRAMES, margin=0.5)
    assert list(with_margin.cases["params"]) == ["margin=0.5"]


def test_pairs_may_be_a_set() -> None:
    functions = [brute_force, lambda boxes: iter(brute_force(boxes))]
    for function in functions:
        results = broadmark.measure(function, FRAMES, name="own")
        assert list(results.cases["status"]) == ["ok"]


def test_wrong_answers_are_found() -> None:
    results = broadmark.measure(lambda boxes: all_pairs(boxes)[1:], FRAMES, name="one-less")
    assert list(results.cases["status"]) == ["mismatch"]
    assert list(results.frames["missed"]) == [1, 1, 1]
    doubled = broadmark.measure(lambda boxes: np.vstack([all_pairs(boxes)] * 2), FRAMES)
    assert doubled.cases["invalid"][0] == doubled.frames["invalid"].sum() > 0
    assert doubled.cases["status"][0] == "mismatch"


def test_every_repetition_is_checked() -> None:
    calls = []

    def wrong_at_the_end(boxes: Any) -> Any:
        calls.append(boxes)
        return all_pairs(boxes)[(len(calls) == 2 * len(FRAMES)) :]

    results = broadmark.measure(wrong_at_the_end, FRAMES, repetitions=2)
    assert list(results.cases["status"]) == ["mismatch"] and results.cases["missed"][0] == 1
    assert len(calls) == 8


def test_a_class_is_instantiated_for_every_pass() -> None:
    before = Repeated.instances
    results = broadmark.measure(Repeated, [FRAMES[0]] * 3, repetitions=2, warmup=1)
    assert list(results.cases["status"]) == ["ok"] and Repeated.instances - before == 4
    assert broadmark.measure(Repeated(), FRAMES).cases["status"][0] == "mismatch"


def test_margins_and_absent_bodies() -> None:
    near = np.array([[[0, 0, 0], [1, 1, 1]], [[1.5, 0, 0], [2, 1, 1]]], np.float32)
    gone = np.stack([near[0], broadmark.EMPTY_BOX])

    def nearby(boxes: Any) -> Any:
        return [(1, 0)] if np.isfinite(boxes).all() else []

    assert broadmark.measure(nearby, [near, near]).cases["false"][0] == 1
    results = broadmark.measure(nearby, [near, gone, near], margin=0.3)
    assert results.cases["status"][0] == "ok" and results.cases["allowed_extra"][0] == 1


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (5, "frame 1: the answer is not an array of pairs"),
        ([1, 2, 3], r"frame 1: the answer has the shape \(3,\)"),
        ([[0, 1.5]], "frame 1: .* type float64, expected indices"),
        ([[0, -1]], "frame 1: .* expected indices"),
    ],
)
def test_answers_of_other_shapes_are_rejected(answer: Any, message: str) -> None:
    with pytest.raises(broadmark.InputError, match=message):
        broadmark.measure(lambda _: answer, FRAMES)


def test_exceptions_are_passed_on() -> None:
    def broken(_: Any) -> Any:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        broadmark.measure(broken, FRAMES)
    with pytest.raises(broadmark.InputError, match="expands to 2 recordings"):
        broadmark.measure(all_pairs, "brownian", frames=2, param={"initial_speed": [1, 2]})
