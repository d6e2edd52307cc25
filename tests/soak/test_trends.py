"""Tests that leaks and slow-downs are detected, and noise is not."""

from __future__ import annotations

import random

import pytest
from trends import grows, leaks, slows_down


def noisy(count: int, value: float, spread: float, slope: float = 0.0) -> list[float]:
    source = random.Random(count)
    return [value + slope * i + source.uniform(-spread, spread) for i in range(count)]


@pytest.mark.parametrize("count", [8, 50, 600])
def test_constant_samples_are_no_problem(count: int) -> None:
    assert grows("memory", noisy(count, 200, 10), 30).problem == ""
    assert slows_down("time", noisy(count, 2, 0.2), 0.15).problem == ""
    assert leaks("descriptors", [20, 22] * (count // 2)).problem == ""


def test_growth_at_the_beginning_is_no_problem() -> None:
    assert grows("memory", [float(min(i, 15)) * 10 for i in range(100)], 10).problem == ""


@pytest.mark.parametrize("count", [50, 600])
def test_steady_growth_is_detected(count: int) -> None:
    assert grows("memory", noisy(count, 200, 10, slope=100 / count), 30).problem != ""


def test_a_descriptor_leaked_per_round_is_detected() -> None:
    assert leaks("descriptors", [float(20 + i) for i in range(20)]).problem != ""


def test_a_slow_down_is_detected() -> None:
    assert slows_down("time", noisy(200, 2, 0.2, slope=0.005), 0.15).problem != ""


def test_no_samples_are_no_problem() -> None:
    assert grows("memory", [], 1).problem == ""
    assert leaks("descriptors", []).problem == ""
    assert slows_down("time", [], 1).problem == ""
