"""The history of cases: a line per case and machine, the drift of the machines, and the changes."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from broadmark.errors import InputError
from broadmark.history.change_points import Change, Detection, Segments, noise_of
from broadmark.history.commits import Commit, Order
from broadmark.history.drift import MIN_OTHERS, common_drift, drifts_of_others, first_levels
from broadmark.history.machines import Machine, conditions_of, machine_labels, machine_of
from broadmark.history.measures import Measure, logarithms, values_of
from broadmark.results import Results

Array = npt.NDArray[np.float64]

#: The fewest runs that show the latest level, and two more than that a passing one: a shorter deviation
#: is a disturbance. A single run shows the level of a count without noise.
MIN_RUNS = 3
_NO_NOISE = 1e-3

#: Rounds in which steps and drift are estimated from each other.
_ROUNDS = 5


@dataclass(frozen=True)
class Step:
    """A change between two measured commits. Levels are in the unit of the measure."""

    commit: int  #: the first after the change
    previous: int  #: the last before it
    before: float  #: the level as measured
    after: float
    ratio: float  #: relative to the other cases of the runs
    low: float  #: of the 95 % interval
    high: float


@dataclass
class Line:
    """A case on a machine, in the order of the commits. Values are natural logarithms."""

    case: str  #: the id
    machine: int
    conditions: tuple[tuple[str, str], ...]
    numbers: list[int]  #: of the cases in the results
    commits: npt.NDArray[np.int64]
    runs: npt.NDArray[np.int64]  #: of the machine
    values: Array
    halves: Array  #: half-widths of the 95 % intervals; missing if unknown
    drift: Array  #: missing if the other cases of the run are too few
    fitted: Array = field(default_factory=lambda: np.empty(0))  #: the level, without drift
    steps: list[Step] = field(default_factory=list)

    @property
    def judged(self) -> npt.NDArray[np.bool_]:
        """The runs that are searched for changes."""
        return ~np.isnan(self.drift)


@dataclass
class MachineHistory:
    """A machine's runs, and the changes that all cases share."""

    label: str
    runs: int
    has_drift: bool  #: whether there are enough cases to tell the drift
    steps: list[Step] = field(default_factory=list)


@dataclass
class History:
    """All lines of a measure."""

    measure: Measure
    commits: list[Commit]
    step_word: str  #: what a step is: "commit" or "run"
    machines: list[MachineHistory]
    lines: list[Line]
    cases: pd.DataFrame  #: a row per case, by its id: scene, object_type, objects, algorithm
    margin: float
    notes: list[str]


def history(
    results: Results,
    order: Order,
    measure: Measure,
    *,
    margin: float,
    by_host: bool = False,
    machine: str | None = None,
) -> History:
    """The history of the complete cases that are ok and have a value, of the machines with `machine` in
    their label."""
    notes: list[str] = []
    used = _used(results, measure, notes)
    environments = results.environments.to_dict("records")
    machine_of_row = {
        i: machine_of(environments[results.cases.at[i, "environment"]], by_host) for i in used
    }
    machines = list(dict.fromkeys(machine_of_row[i] for i in used))
    if machine is not None:
        machines = _matching(machines, machine)
        used = [i for i in used if machine_of_row[i] in machines]
    used.sort(key=lambda i: (order.indices[i], results.cases.at[i, "started"], i))
    runs: list[dict[Any, int]] = [{} for _ in machines]
    groups: dict[Any, list[tuple[int, int]]] = defaultdict(list)
    for i in used:
        number = machines.index(machine_of_row[i])
        key = (order.indices[i], results.cases.at[i, "started"])
        run = runs[number].setdefault(key, len(runs[number]))
        case = results.details[i]
        groups[case["id"], number, conditions_of(case)].append((i, run))
    lines = []
    for (case_id, number, conditions), members in groups.items():
        numbers = [i for i, _ in members]
        line_runs = np.array([run for _, run in members], np.int64)
        _require_order(results, numbers, line_runs)
        values, halves = logarithms(results, measure, numbers)
        lines.append(
            Line(
                *(case_id, number, conditions, numbers, order.indices[numbers], line_runs),
                *(values, halves, np.zeros(len(values))),
            )
        )
    labels = machine_labels(machines)
    found = History(
        measure,
        order.commits,
        order.word,
        [MachineHistory(label, len(own), False) for label, own in zip(labels, runs)],
        lines,
        results.cases.loc[used].drop_duplicates("id").set_index("id", drop=False),
        margin,
        notes,
    )
    for number in range(len(machines)):
        find_steps(found, number)
    return found


def _matching(machines: list[Machine], text: str) -> list[Machine]:
    labels = machine_labels(machines)
    found = [machine for machine, label in zip(machines, labels) if text in label]
    if not found:
        names = ", ".join(f"'{label}'" for label in labels)
        raise InputError(f"--machine '{text}': matches none of {names}")
    return found


def _used(results: Results, measure: Measure, notes: list[str]) -> list[int]:
    cases = results.cases
    values = values_of(results, measure)
    good = (cases["status"] == "ok") & cases["complete"]
    if not good.all():
        counts = cases["status"][~good].replace("ok", "incomplete").value_counts()
        summary = ", ".join(f"{count} {status}" for status, count in counts.items())
        notes.append(f"results that are left out: {summary}")
    positive = good & (values > 0)
    if not positive.any():
        raise InputError(
            f"no case has a {measure.title} above 0" if good.any() else "no case is ok and complete"
        )
    if (good & ~positive).any():
        notes.append(
            f"results that are left out: {(good & ~positive).sum()} without a {measure.title} above 0"
        )
    return [int(i) for i in cases.index[positive]]


def _require_order(results: Results, numbers: list[int], runs: npt.NDArray[np.int64]) -> None:
    for i in np.flatnonzero(np.diff(runs) == 0):
        first, second = (results.cases.loc[numbers[k]] for k in (i, i + 1))
        where = (
            first["file"]
            if first["file"] == second["file"]
            else f"{first['file']} and {second['file']}"
        )
        raise InputError(
            f"{where}: {first['id']} occurs twice, with different times and the same start "
            f"'{first['started']}', so the order is unknown: give only one of them"
        )


def _segments(found: History, values: Array, commits: npt.NDArray[np.int64]) -> Segments:
    is_exact = not found.measure.is_time and len(values) > 1 and noise_of(values) < _NO_NOISE
    tests = len(found.lines) + len(found.machines)
    return Detection(1 if is_exact else MIN_RUNS, found.margin, tests).segments(values, commits)


def find_steps(found: History, machine: int) -> None:
    """Finds the steps of the lines of a machine, and those of the machine."""
    own = found.machines[machine]
    lines = [line for line in found.lines if line.machine == machine]
    values = np.full((len(lines), own.runs), np.nan)
    commits = np.zeros(own.runs, np.int64)
    for row, line in enumerate(lines):
        values[row, line.runs] = line.values
        commits[line.runs] = line.commits
    recordings = [dict(line.conditions)["recording"] for line in lines]
    fitted = np.repeat(first_levels(values)[:, None], own.runs, axis=1)
    changes: list[list[Change]] = [[] for _ in lines]
    for _ in range(_ROUNDS):
        drifts = np.full(values.shape, np.nan)
        if found.measure.is_time:
            drifts = drifts_of_others(values - fitted, recordings)
        before, changes = changes, []
        for row, line in enumerate(lines):
            drift = drifts[row, line.runs]
            line.drift = np.zeros(len(drift)) if np.isnan(drift).all() else drift
            judged = line.judged
            segments = _segments(found, (line.values - line.drift)[judged], line.commits[judged])
            line.fitted = _filled(segments.fitted, judged)
            fitted[row, line.runs] = line.fitted
            changes.append(segments.changes)
        if [[c.index for c in row] for row in before] == [
            [c.index for c in row] for row in changes
        ]:
            break
    for line, line_changes in zip(lines, changes):
        judged = line.judged
        line.steps = _steps(line_changes, line.commits[judged], line.values[judged])
    drift = common_drift(values - fitted) if found.measure.is_time else np.full(own.runs, np.nan)
    known = ~np.isnan(drift)
    own.has_drift = bool(known.any())
    if own.has_drift:
        segments = _segments(found, drift[known], commits[known])
        own.steps = _steps(segments.changes, commits[known], drift[known])
    elif found.measure.is_time:
        found.notes.append(
            f"{own.label}: fewer than {MIN_OTHERS + 1} cases: a change of the machine looks like one "
            "of the code"
        )


def _filled(fitted: Array, judged: npt.NDArray[np.bool_]) -> Array:
    """The levels of all runs: those between two judged runs have that of the one before."""
    positions = np.maximum(np.cumsum(judged) - 1, 0)
    return np.asarray(fitted[positions])


def _steps(changes: list[Change], commits: npt.NDArray[np.int64], values: Array) -> list[Step]:
    ends = [0, *(change.index for change in changes), len(values)]
    levels = [math.exp(values[a:b].mean()) for a, b in zip(ends, ends[1:])]
    return [
        Step(
            *(int(commits[change.index]), int(commits[change.index - 1])),
            *(levels[i], levels[i + 1], change.ratio, change.low, change.high),
        )
        for i, change in enumerate(changes)
    ]
