"""The value of a case that is followed over the commits: its time, or a column of the table of cases.

The time is that of `broadmark compare`: each frame counts with its minimum over the repetitions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from broadmark.errors import InputError
from broadmark.history import student_t
from broadmark.results import COLUMNS, Results

TIME = "time"

#: Random halves of the repetitions that are drawn to estimate their noise, as by `compare`.
_HALVES = 50

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Measure:
    """What is followed over the commits."""

    key: str
    title: str  #: with which an axis is labelled
    unit: str  #: "s", "B" or, of counts, ""

    @property
    def is_time(self) -> bool:
        """Whether the values depend on the state of the machine, and vary from run to run."""
        return self.unit == "s"

    @property
    def margin(self) -> float:
        """The share below which changes are ignored, unless the user says otherwise."""
        return 0.05 if self.is_time else 0.01


def measure_of(key: str) -> Measure:
    """The measure of a value of --column. Raises InputError for a column without numbers."""
    if key == TIME:
        return Measure(TIME, "time per frame", "s")
    columns = {column["key"]: column for column in COLUMNS if column["kind"] == "number"}
    if key not in columns:
        known = ", ".join([TIME, *columns])
        raise InputError(f"--column '{key}': expected one of {known}")
    units = {"seconds": "s", "bytes": "B"}
    column = columns[key]
    return Measure(key, column["title"], units.get(column["unit"], ""))


def values_of(results: Results, measure: Measure) -> pd.Series:
    """The value of each case; missing if it has none. For the time see `minimum_times`."""
    if measure.key == TIME:
        return results.cases["seconds_per_frame"].astype(float)
    return results.cases[measure.key].astype(float)


def logarithms(results: Results, measure: Measure, numbers: list[int]) -> tuple[Array, Array]:
    """The logarithms of the values of cases that differ only in their run, and the half-widths of
    their 95 % intervals; missing if unknown."""
    if measure.key == TIME:
        return minimum_times([results.details[i]["frames"]["total"] for i in numbers])
    cases = results.cases.loc[numbers]
    logs = np.log(cases[measure.key].to_numpy(float))
    halves = np.full(len(logs), np.nan)
    if measure.key == "seconds_per_frame":
        low = cases["ci95_low_seconds"].astype(float).to_numpy()
        high = cases["ci95_high_seconds"].astype(float).to_numpy()
        known = (low > 0) & (high > 0)
        halves[known] = np.log(high[known] / low[known]) / 2
    return logs, halves


def minimum_times(runs: list[list[npt.NDArray[np.int64]]]) -> tuple[Array, Array]:
    """The logarithm of the mean over the frames of each frame's minimum time, for each run.

    A run with more repetitions would have a lower minimum by chance: the expected minimum is that of
    as many repetitions as the run with the fewest has. The noise of repetitions is pooled over the
    runs.
    """
    frames = min(len(times) for run in runs for times in run)
    # The logarithm is defined even below the clock's resolution.
    tables = [np.maximum([times[:frames] for times in run], 1) * 1e-9 for run in runs]
    drawn = min(len(table) for table in tables)
    logs = np.array([math.log(_expected_minimum(table, drawn).mean()) for table in tables])
    random = np.random.default_rng(0)
    variances, degrees = [], 0
    for table in tables:
        if len(table) > 1:
            variances += [_variance(table, random)] * (len(table) - 1)
            degrees += len(table) - 1
    half = math.nan
    if degrees:
        half = student_t.quantile(0.05, degrees) * math.sqrt(float(np.mean(variances)))
    return logs, np.array([half if len(table) > 1 else math.nan for table in tables])


def _expected_minimum(table: Array, drawn: int) -> Array:
    """The expected minimum of each frame over `drawn` random repetitions."""
    count = len(table)
    weights = [math.comb(count - 1 - i, drawn - 1) / math.comb(count, drawn) for i in range(count)]
    return np.asarray(np.array(weights) @ np.sort(table, axis=0))


def _variance(table: Array, random: Any) -> float:
    """The variance of the logarithm, from halves of the repetitions (McCarthy, 1969): the statistic
    of a half varies about its mean as that of all does about the truth."""
    count = len(table)
    half = count // 2
    chosen = np.argsort(random.random((_HALVES, count)), axis=1)[:, :half]
    logs = np.log(table[chosen].min(axis=1).mean(axis=1))
    return float(logs.var(ddof=1)) * half / (count - half)
