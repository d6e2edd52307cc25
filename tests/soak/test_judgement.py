"""That a leak and a slow-down are seen, and noise is not taken for one."""

from __future__ import annotations

import random

import pytest
from judgement import grows, leaks, slows_down


def noisy(count: int, value: float, spread: float, slope: float = 0.0) -> list[float]:
    source = random.Random(count)
    return [value + slope * i + source.uniform(-spread, spread) for i in range(count)]


@pytest.mark.parametrize("count", [8, 50, 600])
def test_what_stays_is_right(count: int) -> None:
    assert grows("memory", noisy(count, 200, 10), 30).wrong == ""
    assert slows_down("time", noisy(count, 2, 0.2), 0.15).wrong == ""
    assert leaks("descriptors", [20, 22] * (count // 2)).wrong == ""


def test_what_grows_in_the_beginning_only_is_right() -> None:
    assert grows("memory", [float(min(i, 15)) * 10 for i in range(100)], 10).wrong == ""


@pytest.mark.parametrize("count", [50, 600])
def test_steady_growth_is_seen(count: int) -> None:
    assert grows("memory", noisy(count, 200, 10, slope=100 / count), 30).wrong != ""


def test_a_descriptor_for_each_round_is_seen() -> None:
    assert leaks("descriptors", [float(20 + i) for i in range(20)]).wrong != ""


def test_a_slow_down_is_seen() -> None:
    assert slows_down("time", noisy(200, 2, 0.2, slope=0.005), 0.15).wrong != ""


def test_nothing_is_judged_of_nothing() -> None:
    assert grows("memory", [], 1).wrong == ""
    assert leaks("descriptors", []).wrong == ""
    assert slows_down("time", [], 1).wrong == ""
