"""Whether what a process takes grows, and whether it becomes slower, from samples over time.

Each judgement is a line of the table: what was looked at, its value at the beginning and at the end,
and what is wrong with that, if anything is.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

#: Caches fill in the beginning: that share of the samples says nothing.
WARM_UP = 0.2


@dataclass(frozen=True)
class Judgement:
    what: str
    first: float
    last: float
    wrong: str  #: "": nothing


def _settled(samples: Sequence[float]) -> Sequence[float]:
    return samples[math.ceil(WARM_UP * len(samples)) :]


def _tenths(samples: Sequence[float]) -> tuple[Sequence[float], Sequence[float]]:
    """The first and the last tenth."""
    some = max(1, len(samples) // 10)
    return samples[:some], samples[-some:]


def grows(what: str, samples: Sequence[float], allowed: float) -> Judgement:
    """Whether it grows from quarter to quarter, by more than `allowed` in all."""
    settled = _settled(samples)
    ends = [len(settled) * part // 4 for part in range(5)]
    quarters = [settled[a:b] for a, b in zip(ends, ends[1:]) if a < b]
    medians = [statistics.median(quarter) for quarter in quarters] or [0.0]
    steadily = all(a < b for a, b in zip(medians, medians[1:])) and len(medians) == 4
    wrong = steadily and medians[-1] - medians[0] > allowed
    return Judgement(what, medians[0], medians[-1], "grows steadily" if wrong else "")


def leaks(what: str, samples: Sequence[float]) -> Judgement:
    """Of what is counted in the same state: whether more of it is left in the end."""
    settled = _settled(samples) or [0.0]
    some = max(2, len(settled) // 4)
    first, last = settled[:some], settled[-some:]
    wrong = min(last) > max(first)
    return Judgement(what, max(first), min(last), "is left behind" if wrong else "")


def slows_down(what: str, seconds: Sequence[float], allowed: float) -> Judgement:
    """Whether the last tenth takes longer by more than this share, beyond the noise of both."""
    first, last = _tenths(_settled(seconds) or [1.0])
    noise = 3 * math.hypot(_uncertainty(first), _uncertainty(last))
    slower = statistics.median(last) / statistics.median(first) - 1
    wrong = "is slower in the end" if slower > allowed + noise else ""
    return Judgement(what, statistics.median(first), statistics.median(last), wrong)


def _uncertainty(samples: Sequence[float]) -> float:
    """The standard error of their median, as a share of it; of a few not known, so large."""
    few = 5
    if len(samples) < few:
        return 0.3
    median = statistics.median(samples)
    spread = 1.4826 * statistics.median(abs(one - median) for one in samples)
    return 1.2533 * spread / math.sqrt(len(samples)) / median
