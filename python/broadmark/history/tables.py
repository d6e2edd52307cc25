"""The changes of a history as text, JSON and CSV."""

from __future__ import annotations

import csv
import io
import json
import math
from dataclasses import dataclass
from typing import Any

from broadmark.history.history import History, Line, Step
from broadmark.history.measures import Measure
from broadmark.text_tables import aligned

SCHEMA = "broadmark-history/1"


@dataclass(frozen=True)
class Row:
    """A change of a case, or of all cases of a machine."""

    case: str  #: "": all cases
    machine: str
    step: Step


def rows_of(history: History) -> list[Row]:
    """All changes by commit, the largest of a commit first; those of a machine first of all."""
    rows = [
        Row("", machine.label, step) for machine in history.machines for step in machine.steps
    ] + [
        Row(line.case, history.machines[line.machine].label, step)
        for line in history.lines
        for step in line.steps
    ]
    return sorted(
        rows, key=lambda row: (row.step.commit, row.case != "", -abs(math.log(row.step.ratio)))
    )


def text_table(history: History) -> str:
    """A table of the changes, and a summary."""
    titles = ["case", "machine", "commit", "before", "after", "ratio", "95 % interval"]
    table = [titles] + [_text_row(history, row) for row in rows_of(history)]
    if len(history.machines) == 1:
        table = [[cells[0], *cells[2:]] for cells in table]
    left = len(titles) - 4 if len(history.machines) > 1 else len(titles) - 5
    text = ""
    if len(table) > 1:
        text = "\n".join(aligned(table, left)) + "\n\n"
    for machine in history.machines:
        for step in machine.steps:
            text += (
                f"{machine.label}: from {history.commits[step.commit].label} the times of all cases "
                f"changed by {percent(step.ratio)} in the median: the machine changed, or something "
                "that they share; each case is judged relative to the others\n"
            )
    for reason, cases in broken_lines(history).items():
        shown = ", ".join(cases[:3]) + (f" and {len(cases) - 3} others" if len(cases) > 3 else "")
        text += f"{reason}: a new line begins: {shown}\n"
    return text + summary(history) + "\n"


def summary(history: History) -> str:
    """`60 commits, 40 cases, 3 machines: 5 changes of time per frame, 3 slower, 2 faster`"""
    steps = [step for line in history.lines for step in line.steps]
    above = sum(step.ratio > 1 for step in steps)
    words = ("slower", "faster") if history.measure.is_time else ("up", "down")
    shape = ", ".join(
        _counted(number, noun)
        for number, noun in (
            (len(history.commits), history.step_word),
            (len(history.cases), "case"),
            (len(history.machines), "machine"),
        )
    )
    if not steps:
        return (
            f"{shape}: {history.measure.title}: no certain change of more than "
            f"{100 * history.margin:g} %"
        )
    kinds = [
        f"{number} {word}" for number, word in zip((above, len(steps) - above), words) if number
    ]
    return f"{shape}: {history.measure.title}: {_counted(len(steps), 'change')}, {', '.join(kinds)}"


def broken_lines(history: History) -> dict[str, list[str]]:
    """The cases that continue under other conditions, by machine, commit and conditions in words."""
    known: dict[tuple[str, int], Line] = {}
    found: dict[str, list[str]] = {}
    for line in sorted(history.lines, key=lambda line: int(line.commits[0])):
        before = known.get((line.case, line.machine))
        if before is not None:
            changed = [
                (
                    "other recordings"
                    if name == "recording"
                    else f"{name} {old or 'none'} -> {new or 'none'}"
                )
                for (name, old), (_, new) in zip(before.conditions, line.conditions)
                if old != new
            ]
            machine, commit = history.machines[line.machine], history.commits[line.commits[0]]
            reason = f"{machine.label}: from {commit.label}: {', '.join(changed)}"
            found.setdefault(reason, []).append(line.case)
        known[line.case, line.machine] = line
    return found


def csv_text(history: History) -> str:
    """A row per change. The case is empty where all cases of the machine changed together."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    key = history.measure.key
    writer.writerow(
        ["case", "machine", "commit", "previous_commit", f"{key}_before", f"{key}_after"]
        + ["ratio", "ratio_low", "ratio_high"]
    )
    for row in rows_of(history):
        step = row.step
        levels = (step.before, step.after) if row.case else ("", "")
        writer.writerow(
            [row.case, row.machine, history.commits[step.commit].name]
            + [history.commits[step.previous].name, *map(_rounded, levels)]
            + [_rounded(value) for value in (step.ratio, step.low, step.high)]
        )
    return file.getvalue()


def json_text(history: History) -> str:
    """Everything that is drawn and listed."""
    document = {
        "schema": SCHEMA,
        "column": history.measure.key,
        "unit": {"s": "seconds", "B": "bytes"}.get(history.measure.unit, ""),
        "margin": history.margin,
        "commits": [
            {"commit": commit.name, "date": commit.date.isoformat() if commit.date else None}
            for commit in history.commits
        ],
        "machines": [
            {
                "name": machine.label,
                "changes": [_json_step(history, step, levels=False) for step in machine.steps],
            }
            for machine in history.machines
        ],
        "lines": [_json_line(history, line) for line in history.lines],
        "notes": history.notes,
    }
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


def _json_line(history: History, line: Line) -> dict[str, Any]:
    return {
        "case": line.case,
        "machine": line.machine,
        "conditions": {name: value for name, value in line.conditions if value},
        "commits": line.commits.tolist(),
        "values": _exponentials(line.values),
        "low": _exponentials(line.values - line.halves),
        "high": _exponentials(line.values + line.halves),
        "drift": _exponentials(line.drift),
        "changes": [_json_step(history, step, levels=True) for step in line.steps],
    }


def _json_step(history: History, step: Step, *, levels: bool) -> dict[str, Any]:
    return {
        "commit": history.commits[step.commit].name,
        "previous_commit": history.commits[step.previous].name,
        **({"before": _rounded(step.before), "after": _rounded(step.after)} if levels else {}),
        "ratio": _rounded(step.ratio),
        "interval": [_rounded(step.low), _rounded(step.high)],
    }


def _exponentials(logs: Any) -> list[float | None]:
    return [None if math.isnan(value) else _rounded(math.exp(value)) for value in logs]


def _rounded(value: Any) -> Any:
    return float(f"{value:.6g}") if isinstance(value, float) else value


def _text_row(history: History, row: Row) -> list[str]:
    step, measure = row.step, history.measure
    levels = [quantity(value, measure) for value in (step.before, step.after)] if row.case else "  "
    digits = 3 if step.high - step.low < 0.1 else 2
    return [
        row.case or "all cases",
        row.machine,
        history.commits[step.commit].label,
        *levels,
        f"{step.ratio:.{digits}f}",
        f"{step.low:.{digits}f}…{step.high:.{digits}f}",
    ]


def percent(ratio: float) -> str:
    """`+12 %`, with a digit more below 10 %; of large ratios `×3.2`."""
    if ratio >= 2 or ratio <= 0.5:
        return f"×{ratio:.3g}"
    change = 100 * (ratio - 1)
    return f"{change:+.{0 if abs(change) >= 9.95 else 1}f} %"


def quantity(value: float, measure: Measure) -> str:
    """A value with three or four digits and its unit: `1.234 ms`, `98.55 M`."""
    if not measure.unit and value < 10_000:
        return f"{value:.4g}"
    exponent = max(-4, min(4, math.floor(math.log10(value) / 3))) if value > 0 else 0
    prefix = "pnµm kMGT"[exponent + 4].strip()
    number = value / 1000.0**exponent
    digits = 3 - max(0, math.floor(math.log10(number))) if number > 0 else 3
    return f"{number:.{max(0, digits)}f} {prefix}{measure.unit}".rstrip()


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" + ("" if number == 1 else "s")
