"""Tests of change points: error rates on simulated series, detection, and the t distribution."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from broadmark.history.change_points import LEVEL, Detection
from broadmark.history.student_t import quantile, two_sided_p


def changes(values: Any, *, min_runs: int = 3, margin: float = 0.0, tests: int = 1) -> list[int]:
    detection = Detection(min_runs, margin, tests)
    found = detection.segments(np.asarray(values, float), np.arange(len(values)))
    return [change.index for change in found.changes]


def noise(random: np.random.Generator, kind: str, count: int) -> Any:
    if kind == "heavy":  # Student's t with 3 degrees of freedom, of variance 1
        return random.standard_t(3, count) / math.sqrt(3)
    values = random.normal(size=count)
    if kind == "disturbed":  # one run in twenty takes a third longer
        values[random.random(count) < 0.05] += 15
    if kind == "lasting":  # each run inherits a part of the last one's error
        for i in range(1, count):
            values[i] += 0.3 * values[i - 1]
    return values


@pytest.mark.parametrize("count", [8, 20, 60])
@pytest.mark.parametrize("min_runs", [1, 3])
def test_histories_without_a_change_show_none(count: int, min_runs: int) -> None:
    """Any number of cases: the rate is that of the whole history."""
    random = np.random.default_rng(1)
    for cases, histories in ((1, 300), (20, 20)):
        false = sum(
            any(
                changes(0.02 * random.normal(size=count), min_runs=min_runs, tests=cases)
                for _ in range(cases)
            )
            for _ in range(histories)
        )
        # Of as many histories, 5 % and two standard deviations.
        assert false <= LEVEL * histories + 2 * math.sqrt(LEVEL * histories)
        assert histories < 300 or false <= LEVEL * histories


@pytest.mark.parametrize("kind", ["heavy", "disturbed", "lasting"])
@pytest.mark.parametrize("count", [20, 100])
def test_other_kinds_of_noise_show_no_change_beyond_the_margin(kind: str, count: int) -> None:
    random = np.random.default_rng(2)
    false = sum(bool(changes(0.02 * noise(random, kind, count), margin=0.05)) for _ in range(300))
    assert false <= LEVEL * 300


@pytest.mark.parametrize(("count", "place"), [(60, 30), (60, 57), (60, 3), (20, 10)])
def test_a_step_of_ten_percent_is_found_at_its_commit(count: int, place: int) -> None:
    random = np.random.default_rng(3)
    exact = near = 0
    for _ in range(100):
        values = 0.02 * random.normal(size=count)
        values[place:] += math.log(1.1)
        found = changes(values, margin=0.05, tests=120)
        exact += found == [place]
        near += len(found) == 1 and abs(found[0] - place) <= 1
    assert exact >= 90 and near >= 97


def test_a_passing_slowdown_is_two_changes() -> None:
    random = np.random.default_rng(4)
    values = 0.02 * random.normal(size=60)
    values[20:28] += math.log(1.12)
    assert changes(values, margin=0.05, tests=40) == [20, 28]


def test_three_runs_are_a_change_at_the_end_only() -> None:
    random = np.random.default_rng(8)
    values = 0.01 * random.normal(size=40)
    values[20:23] += 0.2
    assert changes(values, margin=0.05) == []
    assert changes(values[:23], margin=0.05) == [20]
    values[23:25] += 0.2
    assert changes(values, margin=0.05) == [20, 25]


def test_disturbed_runs_are_no_change() -> None:
    random = np.random.default_rng(5)
    values = 0.01 * random.normal(size=40)
    values[[10, 11, 30]] += 0.5
    assert changes(values) == []
    values[20:] += 0.1
    assert changes(values) == [20]


def test_a_slow_increase_is_a_change_once_it_exceeds_the_margin() -> None:
    values = np.repeat([0, 0.03, 0.06, 0.09], 15) + 0.005 * np.random.default_rng(6).normal(size=60)
    assert len(changes(values)) == 3
    assert 1 <= len(changes(values, margin=0.05)) < 3
    assert changes(values / 3, margin=0.05) == []


def test_counts_without_noise_change_at_once() -> None:
    values = np.log([1000.0] * 9 + [1030.0])
    assert changes(values, min_runs=1, margin=0.01, tests=100) == [9]
    assert changes(values, min_runs=1, margin=0.05) == []
    assert changes(np.log([1000.0] * 10), min_runs=1) == []


def test_changes_are_between_commits_only() -> None:
    values = np.array([0.0, 0.001, -0.001, 0.1, 0.101, 0.099, 0.1, 0.1, 0.099])
    groups = np.array([0, 0, 0, 0, 1, 1, 1, 2, 2])  # the step is within commit 0
    found = Detection(3, 0, 1).segments(values, groups)
    assert all(change.index in (4,) for change in found.changes)
    assert not Detection(3, 0, 1).segments(values, np.zeros(9, int)).changes


@pytest.mark.parametrize("count", range(6))
def test_short_series_show_no_change(count: int) -> None:
    assert changes(np.arange(count)) == []


def test_a_ratio_and_its_interval() -> None:
    random = np.random.default_rng(7)
    inside = 0
    for _ in range(200):
        values = 0.02 * random.normal(size=40)
        values[20:] += math.log(1.2)
        (change,) = Detection(3, 0.05, 1).segments(values, np.arange(40)).changes
        assert change.low < change.ratio < change.high
        assert change.high / change.low == pytest.approx(1.025, abs=0.012)
        inside += change.low <= 1.2 <= change.high
    assert inside >= 180


def test_the_t_distribution() -> None:
    # Values of tables.
    for p, degrees, t in ((0.05, 1, 12.706), (0.05, 10, 2.228), (0.01, 30, 2.750), (0.1, 4, 2.132)):
        assert quantile(p, degrees) == pytest.approx(t, abs=5e-4)
        assert two_sided_p(t, degrees) == pytest.approx(p, rel=2e-3)
    assert two_sided_p(1, 1) == pytest.approx(0.5)
    assert two_sided_p(10, 2) == pytest.approx(1 - 10 / math.sqrt(102))  # closed form
    assert two_sided_p(0, 5) == 1 and two_sided_p(math.inf, 5) == 0
