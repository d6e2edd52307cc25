"""Change points of a series: where its level changes for good, or for several runs.

The series, logarithms of times or counts in the order of the commits, is divided into segments of
constant level:

1. Values far from the running median are pulled towards it: a single disturbed run is no change.
2. Optimal partitioning (Jackson et al., 2005) finds the segments with the least squared error plus a
   penalty of 2 log n variances per change. The penalty is weak: it proposes more than there is.
3. Backward elimination removes the least significant change until all are significant by a t test of
   the two segments, its level divided by the number of tests (Bonferroni); then changes of which a
   segment is not mostly on its own side, as where disturbed runs are frequent; then the smallest
   change below the margin. What is left is tested again after each removal.

The error rate is that of a whole history: of histories without a change at most `LEVEL` show any.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from broadmark.history import student_t

Array = npt.NDArray[np.float64]

#: The share of histories without a change that may show one.
LEVEL = 0.05

#: The t tests per possible place of a change: its segments' other ends are chosen, too, and the
#: noise is estimated after the choice. By simulation: tests/test_change_points.py.
CHOICES = 5

#: Relative differences that are rounding.
_ROUNDING = 1e-7

#: Values are limited to this many standard deviations from the running median.
_LIMIT = 3.0


#: More than this share of a segment's values is nearer to its own level than to its neighbour's.
_OWN_SIDE = 0.75


@dataclass(frozen=True)
class Change:
    """A change of the level. Ratios are of the levels after and before."""

    index: int  #: of the first value after it
    ratio: float
    low: float  #: the 95 % interval of the ratio
    high: float


@dataclass(frozen=True)
class Segments:
    """A series in segments of constant level."""

    changes: list[Change]
    fitted: Array  #: the level at each value


@dataclass(frozen=True)
class Detection:
    """How changes are detected."""

    min_runs: int  #: the least number of values in the first and the last segment
    margin: float  #: smaller relative changes are ignored
    tests: int = 1  #: the number of series in which a change may be claimed

    @property
    def min_passing(self) -> int:
        """The least number of values in the other segments: disturbed runs that happen to follow each
        other are no change."""
        return self.min_runs + 2 if self.min_runs > 1 else 1

    def segments(self, values: Array, groups: npt.NDArray[np.int64]) -> Segments:
        """The segments of `values`. A change is possible only where `groups` changes."""
        places = np.flatnonzero(np.diff(groups)) + 1
        places = places[(places >= self.min_runs) & (places <= len(values) - self.min_runs)]
        if not len(places):
            level = values.mean() if len(values) else 0.0
            return Segments([], np.full(len(values), level))
        sigma = max(noise_of(values), _ROUNDING)
        limited = values
        if self.min_runs > 1:
            limited = _limited(values, self.min_runs, sigma)
        sums = _Sums(limited)
        starts = self._partition(sums, places, sigma)
        while True:
            starts = self._eliminated(sums, values, starts, CHOICES * len(places) * self.tests)
            moved = self._moved(sums, starts, places)
            if moved == starts:
                return _described(sums, starts)
            starts = moved  # which lowers the squared error, so that this ends

    def _partition(self, sums: _Sums, places: npt.NDArray[np.int64], sigma: float) -> list[int]:
        """The starts of the segments after the first with the least cost."""
        penalty = 2 * math.log(sums.count) * sigma**2
        begins = np.concatenate([[0], places])
        best = np.full(len(begins), np.inf)  # least cost of everything before each begin
        best[0] = -penalty
        previous = np.zeros(len(begins), int)
        for number, end in enumerate([*begins[1:], sums.count], 1):
            least = self.min_runs if end == sums.count else self.min_passing
            usable = max(int(np.searchsorted(begins, end - least, side="right")), 1)
            costs = best[:usable] + penalty + sums.costs(begins[:usable], int(end))
            last = int(np.argmin(costs))
            if number < len(begins):
                best[number], previous[number] = costs[last], last
        starts: list[int] = []
        while last:
            starts.append(int(begins[last]))
            last = int(previous[last])
        return starts[::-1]

    def _moved(self, sums: _Sums, starts: list[int], places: npt.NDArray[np.int64]) -> list[int]:
        """The starts, each at the best place between its neighbours."""
        starts = list(starts)
        for i in range(len(starts)):
            low = starts[i - 1] + self.min_passing if i else self.min_runs
            is_last = i + 1 == len(starts)
            high = sums.count - self.min_runs if is_last else starts[i + 1] - self.min_passing
            between = places[(places >= low) & (places <= high)]
            errors = [sums.error([*starts[:i], int(k), *starts[i + 1 :]]) for k in between]
            starts[i] = int(between[int(np.argmin(errors))])
        return starts

    def _eliminated(self, sums: _Sums, values: Array, starts: list[int], tests: int) -> list[int]:
        """The changes, of those at `starts`, that are significant, clear, and not below the margin."""
        while starts:
            weakest = self._weakest(sums, values, starts, tests)
            if weakest is None:
                break
            starts = starts[:weakest] + starts[weakest + 1 :]
        return starts

    def _weakest(self, sums: _Sums, values: Array, starts: list[int], tests: int) -> int | None:
        """The change to be removed; None if all are to be kept."""
        steps, errors, degrees = _steps(sums, starts)
        scores = np.abs(steps) / errors
        weakest = int(np.argmin(scores))
        p = student_t.two_sided_p(float(scores[weakest]), degrees) if degrees else 1
        if p * tests > LEVEL:
            return weakest
        shares = _own_side(sums, values, starts)
        if min(shares) <= _OWN_SIDE:
            return int(np.argmin(shares))
        weakest = int(np.argmin(np.abs(steps)))
        return weakest if abs(steps[weakest]) < math.log1p(self.margin) else None


class _Sums:
    """The sums over ranges of a series."""

    def __init__(self, values: Array) -> None:
        self.count = len(values)
        centred = values - values.mean()  # loses fewer digits
        self.mean = float(values.mean())
        self._sums = np.concatenate([[0.0], np.cumsum(centred)])
        self._squares = np.concatenate([[0.0], np.cumsum(centred**2)])

    def levels(self, starts: list[int]) -> tuple[Array, npt.NDArray[np.int64]]:
        """The centred means, and the lengths, of the segments that begin at 0 and at `starts`."""
        ends = np.array([0, *starts, self.count])
        lengths = np.diff(ends)
        return np.diff(self._sums[ends]) / lengths, lengths

    def error(self, starts: list[int]) -> float:
        """The squared error of the segments that begin at 0 and at `starts`."""
        levels, lengths = self.levels(starts)
        return max(float(self._squares[-1] - (levels**2 * lengths).sum()), 0.0)

    def costs(self, begins: npt.NDArray[np.int64], end: int) -> Array:
        """The squared error of each range from `begins` to `end`."""
        sums = self._sums[end] - self._sums[begins]
        squares = self._squares[end] - self._squares[begins]
        return np.asarray(squares - sums**2 / (end - begins))


def noise_of(values: Array) -> float:
    """The standard deviation of the noise: by the median of the differences, most of which contain
    no change."""
    return 1.4826 * float(np.median(np.abs(np.diff(values)))) / math.sqrt(2)


def _limited(values: Array, min_runs: int, sigma: float) -> Array:
    """The values, limited to a range about a running median that levels of `min_runs` values pass."""
    reach = min_runs - 1
    padded = np.concatenate([np.full(reach, np.nan), values, np.full(reach, np.nan)])
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    medians = np.nanmedian(windows, axis=1)
    return np.clip(values, medians - _LIMIT * sigma, medians + _LIMIT * sigma)


def _steps(sums: _Sums, starts: list[int]) -> tuple[Array, Array, int]:
    """The differences of neighbouring levels, their standard errors, and the degrees of freedom."""
    levels, lengths = sums.levels(starts)
    degrees = sums.count - len(lengths)
    variance = max(sums.error(starts) / max(degrees, 1), _ROUNDING**2)
    return np.diff(levels), np.sqrt(variance * (1 / lengths[:-1] + 1 / lengths[1:])), degrees


def _own_side(sums: _Sums, values: Array, starts: list[int]) -> list[float]:
    """For each change, the share of values on the side of their own level, of the segment before or
    after it in which it is smaller."""
    levels = sums.levels(starts)[0] + sums.mean
    segments = np.split(values, starts)
    shares = []
    for i in range(len(starts)):
        middle = (levels[i] + levels[i + 1]) / 2
        rises = levels[i + 1] > levels[i]
        before, after = ((segments[k] > middle).mean() for k in (i, i + 1))
        shares.append(float(min(1 - before, after) if rises else min(before, 1 - after)))
    return shares


def _described(sums: _Sums, starts: list[int]) -> Segments:
    levels, lengths = sums.levels(starts)
    fitted = np.repeat(levels + sums.mean, lengths)
    if not starts:
        return Segments([], fitted)
    steps, errors, degrees = _steps(sums, starts)
    half = student_t.quantile(0.05, degrees) * errors
    ratios = zip(np.exp(steps), np.exp(steps - half), np.exp(steps + half))
    return Segments([Change(k, *map(float, ratio)) for k, ratio in zip(starts, ratios)], fitted)
