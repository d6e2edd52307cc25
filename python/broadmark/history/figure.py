"""Histories as figures: a page per scene, a panel per case, a line per machine.

Points are the values without the machine's drift, the faint line is as measured. A vertical line marks
a change, with its ratio and commit above.
"""

from __future__ import annotations

import math
import textwrap
from collections import defaultdict
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator

from broadmark.history.history import History, Line
from broadmark.history.tables import percent, quantity
from broadmark.palette import LIGHT, light
from broadmark.plots.panels import NOTE

Array = npt.NDArray[np.float64]

MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]

#: The least ratio of the ends of a y axis, of times and of others, so that noise does not fill it.
_MIN_RANGE, _MIN_COUNT_RANGE = 1.3, 1.06

#: Space for a row of labels above the points, as a share of a panel's height in points.
_LABEL_POINTS = 8.5

#: The size of a panel in inches, by the most panels of a page.
PANEL_SIZES = [(1, (7.6, 3.6)), (2, (6.4, 2.6)), (6, (4.2, 2.3)), (math.inf, (2.9, 1.75))]


def pages(history: History) -> list[tuple[str, list[str]]]:
    """The scenes with the ids of their cases: by number of bodies, then as in the results."""
    groups: dict[str, list[str]] = defaultdict(list)
    for case in history.cases.sort_values("objects", kind="stable").itertuples():
        groups[f"{case.scene} {case.object_type}"].append(case.id)
    return sorted(groups.items())


def page(history: History, title: str, ids: list[str]) -> Figure:
    """The panels of a scene."""
    columns = _columns(len(ids))
    rows = math.ceil(len(ids) / columns)
    size = next(size for max_ids, size in PANEL_SIZES if len(ids) <= max_ids)
    width = max(size[0] * columns, 4) + 0.3
    entries = _legend_entries(history)
    legend_columns = max(1, min(len(entries), int(width / 2.9)))
    note = textwrap.fill(_note(history), int(width * 21))
    below = 0.2 + 0.1 * len(note.splitlines()) + 0.17 * math.ceil(len(entries) / legend_columns)
    height = size[1] * rows + 0.55
    figure = Figure(figsize=(width, height + below), layout="constrained")
    # Without frames: their corners at -0 or 0 would make output irreproducible.
    upper, lower = figure.subfigures(2, 1, height_ratios=[height, below], frameon=False)
    grid = upper.subplots(rows, columns, squeeze=False, sharex=True)
    names = panel_titles(history, ids)
    steps = f"{len(history.commits)} {history.step_word}s"
    upper.suptitle(f"{title}: {history.measure.title} over {steps}", fontsize=11)
    for number, axes in enumerate(grid.flat):
        if number >= len(ids):
            axes.set_axis_off()
            continue
        lines = [line for line in history.lines if line.case == ids[number]]
        axes.set_title(names[number], loc="left")
        _draw(history, axes, lines, size)
        # The lowest panel of each column has the labels, even above an empty place.
        axes.tick_params(labelbottom=number + columns >= len(ids))
        _label_commits(history, axes, size[0])
    lower.legend(
        *zip(*entries), loc="upper center", ncol=legend_columns, fontsize=7.5, handlelength=2.4
    )
    lower.text(0.5, 0.06 / below, note, ha="center", va="bottom", **NOTE)
    return figure


def panel_titles(history: History, ids: list[str]) -> list[str]:
    """The number of bodies, and the parts of the ids that differ."""
    split = []
    for id_ in ids:
        case = history.cases.loc[id_]
        recording, _, variant = id_.rpartition(f"/{case['algorithm']}")
        parts = recording.split("/")[2:]
        parts = [part for part in parts if part != f"N{case['objects']}"]
        split.append((f"{case['objects']:,} bodies", parts, case["algorithm"] + variant))
    common = set.intersection(*(set(parts) for _, parts, _ in split))
    return [
        ", ".join([bodies, *(part for part in parts if part not in common), variant])
        for bodies, parts, variant in split
    ]


def _columns(count: int) -> int:
    if count <= 3:
        return 1 if count < 3 else 3
    return 2 if count == 4 else 3 if count <= 9 else 4 if count <= 24 else 5


def _style(machine: int) -> tuple[str, str]:
    colours = LIGHT["curve"]
    return colours[machine % len(colours)], MARKERS[machine % len(MARKERS)]


def _draw(history: History, axes: Any, lines: list[Line], size: tuple[float, float]) -> None:
    marker_size = min(4.0, max(2.2, 32 * size[0] / max(len(history.commits), 1)))
    shown = []
    for line in lines:
        colour, marker = _style(line.machine)
        drift = np.where(line.judged, line.drift, 0)
        values = np.exp(line.values - drift)
        known = ~np.isnan(line.halves)
        low, high = (values[known] * np.exp(sign * line.halves[known]) for sign in (-1, 1))
        axes.plot(line.commits, np.exp(line.values), color=colour, linewidth=0.6, alpha=0.3)
        axes.plot(
            *(line.commits, values),
            **{"color": colour, "marker": marker, "markersize": marker_size},
            **{"linestyle": "none", "markeredgewidth": 0},
        )
        axes.vlines(line.commits[known], low, high, color=colour, linewidth=0.6, alpha=0.55)
        for part in _parts(line):
            level = np.exp(line.fitted[part])
            axes.plot(line.commits[part], level, color=colour, linewidth=1.5, alpha=0.85)
        shown += [values, np.exp(line.fitted)]
    _scale(
        history, axes, np.concatenate(shown), _mark_changes(history, axes, lines, size[0]), size[1]
    )
    for number in sorted({line.machine for line in lines}):
        for step in history.machines[number].steps:
            axes.plot(
                *([step.commit - 0.5], [0]),
                **{"marker": "d", "color": _style(number)[0], "markersize": 4.5, "clip_on": False},
                **{"transform": axes.get_xaxis_transform(), "linestyle": "none", "zorder": 5},
            )


def _parts(line: Line) -> list[slice]:
    """The segments of a line."""
    starts = np.flatnonzero(np.diff(line.fitted)) + 1
    ends = [0, *starts.tolist(), len(line.fitted)]
    return [slice(a, b) for a, b in zip(ends, ends[1:])]


def _mark_changes(history: History, axes: Any, lines: list[Line], width: float) -> int:
    """Draws the changes; returns the rows of labels above the points."""
    by_commit: dict[int, list[float]] = defaultdict(list)
    for line in lines:
        for step in line.steps:
            by_commit[step.commit].append(step.ratio)
    count = max(len(history.commits), 2)
    row_ends: list[float] = []
    labels = []
    for commit, ratios in sorted(by_commit.items()):
        text = f"{_range(ratios)} at {history.commits[commit].label}"
        share = len(text) * 6.5 * 0.56 / 72 / (width - 0.65)  # of the panel's width
        place = commit / (count - 1)
        begin = min(max(place - share / 2, 0), 1 - share)
        row = next((i for i, end in enumerate(row_ends) if end < begin), len(row_ends))
        row_ends[row : row + 1] = [begin + share + 0.01]
        labels.append((commit, begin + share / 2, row, text, ratios))
    for commit, place, row, text, ratios in labels:
        slower = np.mean(np.log(ratios)) > 0
        colour = light("bad" if slower else "good")
        axes.axvline(commit - 0.5, color=colour, linewidth=0.9, linestyle=(0, (3, 2)), zorder=1)
        axes.annotate(
            *(text, (place, 1)),
            **{"xycoords": "axes fraction", "xytext": (0, -_LABEL_POINTS * (row + 1) + 2)},
            **{"textcoords": "offset points", "ha": "center", "va": "bottom"},
            **{"color": colour, "fontsize": 6.5, "annotation_clip": False},
            bbox={"facecolor": light("page"), "edgecolor": "none", "pad": 0.4, "alpha": 1},
        )
    return len(row_ends)


def _range(ratios: list[float]) -> str:
    """The change, or the least and the greatest of several machines."""
    low, high = percent(min(ratios)), percent(max(ratios))
    text = high if low == high else f"{low.removesuffix(' %')}…{high}"
    return text.replace("-", "−")


def _scale(history: History, axes: Any, values: Array, rows: int, height: float) -> None:
    """A logarithmic axis with space for the labels."""
    low, high = float(values.min()), float(values.max())
    middle = math.sqrt(low * high)
    least = _MIN_RANGE if history.measure.is_time else _MIN_COUNT_RANGE
    spread = max(math.log(high / low) * 1.12, math.log(least))
    bottom, top = math.log(middle) - spread / 2, math.log(middle) + spread / 2
    reserved = rows * _LABEL_POINTS / (72 * (height - 0.45))
    top += (top - bottom) * reserved / (1 - min(reserved, 0.6))
    axes.set_yscale("log")
    axes.set_ylim(math.exp(bottom), math.exp(top))
    axes.set_xlim(-0.6, max(len(history.commits) - 0.4, 0.6))
    wide = top - bottom > math.log(6)
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)) if wide else MaxNLocator(4))
    measure = history.measure
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: _tick(y, measure)))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(axis="y", labelsize=7)


def _tick(value: float, measure: Any) -> str:
    number, _, unit = quantity(value, measure).partition(" ")
    return f"{float(number):g} {unit}".rstrip()


def _label_commits(history: History, axes: Any, width: float) -> None:
    count = len(history.commits)
    longest = max(len(commit.label) for commit in history.commits)
    room = max(2, int((width - 0.6) / (0.085 * longest)))
    places = sorted({round(place) for place in np.linspace(0, count - 1, min(room, count))})
    axes.set_xticks(places, [history.commits[i].label for i in places], fontsize=6.5)
    ticks = axes.get_xticklabels()
    if len(ticks) > 1:  # the outer labels end with the panel
        ticks[0].set_horizontalalignment("left")
        ticks[-1].set_horizontalalignment("right")
    axes.grid(False, axis="x")


def _legend_entries(history: History) -> list[tuple[Any, str]]:
    entries = []
    for number, machine in enumerate(history.machines):
        colour, marker = _style(number)
        entries.append(
            (
                Line2D([], [], color=colour, marker=marker, markersize=4, linewidth=1.5),
                machine.label,
            )
        )
    if any(line.steps for line in history.lines):
        dashes = {"color": light("faint"), "linewidth": 0.9, "linestyle": (0, (3, 2))}
        entries.append((Line2D([], [], **dashes), "change, with its ratio and commit"))
    if any(machine.steps for machine in history.machines):
        diamond = {"color": light("faint"), "marker": "d", "linestyle": "none", "markersize": 4.5}
        entries.append((Line2D([], [], **diamond), "the machine changed: all cases together"))
    return entries


def _note(history: History) -> str:
    first, last = history.commits[0], history.commits[-1]
    parts = [f"{first.label} to {last.label}"]
    if first.date and last.date:
        parts = [f"{first.label} ({first.date:%Y-%m-%d}) to {last.label} ({last.date:%Y-%m-%d})"]
    if any(machine.has_drift for machine in history.machines):
        parts.append("points are relative to the other cases of the run, faint lines as measured")
    if any(not np.isnan(line.halves).all() for line in history.lines):
        parts.append("bars: 95 % of repetitions")
    return "; ".join(parts)
