"""Figures of several panels with a common legend below."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from broadmark.palette import light
from broadmark.plots.cases import Cases

#: Draws the cases of a panel.
Painter = Callable[[Any, pd.DataFrame], None]

MAX_COLUMNS = 3

#: The size of a panel with rows: its width, and the height of a title and of a row, in inches.
PANEL_WIDTH, TITLE_HEIGHT, ROW_HEIGHT = 2.4, 0.6, 0.15

#: The height in inches up to which panels are on one page, A4 less its legend.
PAGE_HEIGHT = 11.2

NOTE = {"fontsize": 6.5, "color": light("faint")}


def _height(cases: Cases, scene: str) -> float:
    return TITLE_HEIGHT + ROW_HEIGHT * len(cases.rows_of(scene))


def by_scene_and_size(cases: Cases, paint: Painter, **options: Any) -> Figure:
    """Rows of panels per scene with a panel per number of bodies that it has."""
    rows = []
    for scene, own in cases.table.groupby("panel", sort=False):
        sizes = sorted(own["objects"].unique())
        panels = [(f"{scene}, {n:,} bodies", own[own["objects"] == n]) for n in sizes]
        rows += [panels[i : i + MAX_COLUMNS] for i in range(0, len(panels), MAX_COLUMNS)]
    return _panels(cases, rows, paint, **options)


def with_rows(cases: Cases, paint: Painter, x: str) -> Figure:
    """`by_scene_and_size` with a row per algorithm."""
    size = (PANEL_WIDTH, partial(_height, cases))
    return by_scene_and_size(cases, paint, size=size, x=x, y="", legend=False, sharey="row")


def pages_of(cases: Cases) -> list[tuple[str, Cases]]:
    """The pages of `with_rows`, with names: one, or some for each scene."""
    pages = []
    height = 0.0
    for scene, own in cases.table.groupby("panel", sort=False):
        sizes = sorted(own["objects"].unique())
        rows = max(1, int(PAGE_HEIGHT // _height(cases, scene)))
        height += _height(cases, scene) * math.ceil(len(sizes) / MAX_COLUMNS)
        for first in range(0, len(sizes), rows * MAX_COLUMNS):
            page_sizes = sizes[first : first + rows * MAX_COLUMNS]
            table = own[own["objects"].isin(page_sizes)]
            name = scene if len(page_sizes) == len(sizes) else f"{scene} from {page_sizes[0]}"
            pages.append((name, replace(cases, table=table)))
    return pages if height > PAGE_HEIGHT else [("", cases)]


def by_scene(cases: Cases, paint: Painter, *, stacked: bool = False, **options: Any) -> Figure:
    """A panel per scene, in a row or stacked."""
    scenes = cases.table["panel"].unique()
    row = [(scene, cases.table[cases.table["panel"] == scene]) for scene in scenes]
    return _panels(cases, [[panel] for panel in row] if stacked else [row], paint, **options)


def label_rows(axes: Any, labels: list[str]) -> None:
    """Labels rows at 0, 1, …, from the top, instead of a y axis."""
    axes.grid(False, axis="y")
    axes.set_yticks(range(len(labels)), labels, fontsize=7)
    axes.set_ylim(len(labels) - 0.4, -0.6)


def _panels(
    cases: Cases,
    rows: list[list[tuple[str, pd.DataFrame]]],
    paint: Painter,
    *,
    size: tuple[float, float | Callable[[str], float]],
    x: str,
    y: str,
    legend: bool,
    **sharing: Any,
) -> Figure:
    """`size` is a panel's size in inches, its height perhaps by scene; `x` and `y` are axis labels;
    subplots() gets `sharing`."""
    count = max(map(len, rows))
    width = max(size[0] * count + 0.4, 4)
    heights = [size[1](r[0][1]["panel"].iloc[0]) if callable(size[1]) else size[1] for r in rows]
    height = sum(heights) + 0.3
    labels = list(cases.styles) if legend else []
    columns = max(1, min(int(width / 1.45), len(labels)))
    legend_height = 0.32 + 0.17 * math.ceil(len(labels) / columns)
    figure = Figure(figsize=(width, height + legend_height), layout="constrained")
    upper, lower = figure.subfigures(2, 1, height_ratios=[height, legend_height])
    grid = upper.subplots(len(rows), count, squeeze=False, height_ratios=heights, **sharing)
    handles: dict[str, Any] = {}
    for row, axes_of_row in zip(rows, grid):
        for axes in axes_of_row[len(row) :]:
            axes.remove()
        for (title, panel_cases), axes in zip(row, axes_of_row):
            axes.set_title(title, loc="left")
            paint(axes, panel_cases)
            handles |= {line.get_label(): line for line in axes.get_lines()}
    for column in range(count):  # below its last panel
        last = max(number for number, row in enumerate(rows) if len(row) > column)
        grid[last, column].set_xlabel(x)
    for axes in grid[:, 0]:
        axes.set_ylabel(y)
    if legend:
        shown = [label for label in labels if label in handles]
        lower.legend([handles[label] for label in shown], shown, loc="upper center", ncol=columns)
    lower.text(0.5, 0.06 / legend_height, cases.note, ha="center", va="bottom", **NOTE)
    return figure
