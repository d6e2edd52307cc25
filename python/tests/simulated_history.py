"""Simulated histories, and the rates of false and of found changes.

    python3 python/tests/simulated_history.py [HISTORIES]

prints the rates as a Markdown table.
"""

from __future__ import annotations

import math
import pathlib
import sys
from typing import Any

import numpy as np
import pandas as pd

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from broadmark.history.commits import Commit  # noqa: E402
from broadmark.history.history import History, Line, MachineHistory, find_steps  # noqa: E402
from broadmark.history.measures import measure_of  # noqa: E402


def simulated(
    random: np.random.Generator,
    *,
    cases: int,
    commits: int,
    machines: int = 1,
    noise: float = 0.02,
    walk: float = 0.02,
    disturbed: float = 0.0,
    margin: float = 0.05,
    step: tuple[int, int, float] | None = None,
) -> History:
    """A history in which each machine's speed is a random walk by `walk` per commit, and a share
    `disturbed` of the values is a third too large. `step`: case, commit and ratio of a change."""
    measure = measure_of("time")
    lines = []
    numbers = np.arange(commits)
    for machine in range(machines):
        drift = np.cumsum(walk * random.normal(size=commits))
        for case in range(cases):
            values = drift + noise * random.normal(size=commits)
            values[random.random(commits) < disturbed] += math.log(4 / 3)
            if step and step[0] == case:
                values[step[1] :] += math.log(step[2])
            conditions = (("recording", str(case // 8)),)
            lines.append(
                Line(
                    case=f"case {case}",
                    machine=machine,
                    conditions=conditions,
                    numbers=[],
                    commits=numbers,
                    runs=numbers,
                    values=values,
                    halves=np.full(commits, np.nan),
                    drift=np.zeros(commits),
                )
            )
    history = History(
        measure,
        [Commit(f"{i:07x}", f"{i:07x}", None) for i in range(commits)],
        "commit",
        [MachineHistory(f"machine {i}", commits, False) for i in range(machines)],
        lines,
        pd.DataFrame(),
        margin,
        [],
    )
    for machine in range(machines):
        find_steps(history, machine)
    return history


def claimed(history: History) -> list[tuple[int, int]]:
    """Case and commit of each change of a case."""
    return [
        (int(line.case.split()[1]), step.commit) for line in history.lines for step in line.steps
    ]


def false_rate(histories: int, seed: int, **shape: Any) -> float:
    """The share of histories without a change that show one."""
    random = np.random.default_rng(seed)
    return sum(bool(claimed(simulated(random, **shape))) for _ in range(histories)) / histories


def found_rates(histories: int, seed: int, ratio: float, **shape: Any) -> tuple[float, float]:
    """The shares of histories in which a change is found at its commit, or next to it, and no other is
    shown."""
    random = np.random.default_rng(seed)
    exact = near = 0
    for _ in range(histories):
        place = int(random.integers(3, shape["commits"] - 2))  # three runs at least on each side
        found = claimed(simulated(random, step=(0, place, ratio), **shape))
        machines = shape.get("machines", 1)
        exact += found == [(0, place)] * machines
        near += len(found) == machines and all(abs(at - place) <= 1 for _, at in found)
    return exact / histories, near / histories


#: The simulated histories: cases, commits and machines.
SHAPES = [(1, 20, 1), (4, 20, 1), (10, 20, 1), (10, 60, 1), (10, 30, 3)]


def main() -> None:
    histories = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    print(f"{histories} histories each; noise 2 % per run; machines drift by 2 % per run\n")
    print(
        "| cases | commits | machines | false, margin 5 % | false, margin 0 | false, 5 % of runs disturbed",
        end="",
    )
    print(" | +10 % found at its commit | at it or next to it |\n" + "|---" * 8 + "|")
    for cases, commits, machines in SHAPES:
        shape = {"cases": cases, "commits": commits, "machines": machines}
        if cases < 4:  # there the drift cannot be told from a change
            shape["walk"] = 0
        rates = [
            false_rate(histories, 1, **shape),
            false_rate(histories, 2, margin=0.0, **shape),
            false_rate(histories, 3, disturbed=0.05, **shape),
            *found_rates(histories, 4, 1.1, **shape),
        ]
        cells = [cases, commits, machines, *(f"{100 * rate:.1f} %" for rate in rates)]
        print("| " + " | ".join(map(str, cells)) + " |", flush=True)


if __name__ == "__main__":
    main()
