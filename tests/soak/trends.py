"""Detects growth, leaks and slow-downs of a process from samples over time.

A trend is a line of the table: the quantity, its values at the beginning and at the end, and the
problem, if any.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

#: The share of the samples at the beginning that is ignored because caches fill.
WARM_UP = 0.2


@dataclass(frozen=True)
class Trend:
    quantity: str
    first: float
    last: float
    problem: str  #: "": none


def _after_warm_up(samples: Sequence[float]) -> Sequence[float]:
    return samples[math.ceil(WARM_UP * len(samples)) :]


def _tenths(samples: Sequence[float]) -> tuple[Sequence[float], Sequence[float]]:
    """The first and the last tenth."""
    count = max(1, len(samples) // 10)
    return samples[:count], samples[-count:]


def grows(quantity: str, samples: Sequence[float], allowed: float) -> Trend:
    """Checks for growth in every quarter by more than `allowed` in total."""
    warm = _after_warm_up(samples)
    ends = [len(warm) * quarter // 4 for quarter in range(5)]
    quarters = [warm[a:b] for a, b in zip(ends, ends[1:]) if a < b]
    medians = [statistics.median(quarter) for quarter in quarters] or [0.0]
    steadily = all(a < b for a, b in zip(medians, medians[1:])) and len(medians) == 4
    grown = steadily and medians[-1] - medians[0] > allowed
    return Trend(quantity, medians[0], medians[-1], "grows steadily" if grown else "")


def leaks(quantity: str, samples: Sequence[float]) -> Trend:
    """Checks for a higher count at the end than at the beginning, in the same state."""
    warm = _after_warm_up(samples) or [0.0]
    count = max(2, len(warm) // 4)
    first, last = warm[:count], warm[-count:]
    leaked = min(last) > max(first)
    return Trend(quantity, max(first), min(last), "leaks" if leaked else "")


def slows_down(quantity: str, seconds: Sequence[float], allowed: float) -> Trend:
    """Checks whether the last tenth takes longer by more than this share plus the noise of both."""
    first, last = _tenths(_after_warm_up(seconds) or [1.0])
    noise = 3 * math.hypot(_uncertainty(first), _uncertainty(last))
    slower = statistics.median(last) / statistics.median(first) - 1
    problem = "slows down" if slower > allowed + noise else ""
    return Trend(quantity, statistics.median(first), statistics.median(last), problem)


def _uncertainty(samples: Sequence[float]) -> float:
    """The relative standard error of the median; a large value for few samples."""
    min_samples = 5
    if len(samples) < min_samples:
        return 0.3
    median = statistics.median(samples)
    spread = 1.4826 * statistics.median(abs(sample - median) for sample in samples)
    return 1.2533 * spread / math.sqrt(len(samples)) / median
