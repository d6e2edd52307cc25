"""Violins: the distribution of frame times."""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from broadmark.drawing import plain_numbers
from broadmark.palette import light
from broadmark.plots.cases import Cases
from broadmark.plots.panels import label_rows, with_rows

#: The argument of violinplot: since Matplotlib 3.10 `orientation`, before it `vert`.
HORIZONTAL: dict[str, Any] = (
    {"orientation": "horizontal"}
    if "orientation" in inspect.signature(Axes.violinplot).parameters
    else {"vert": False}
)


def violins(cases: Cases) -> Figure:
    """distribution of all frame times; a dash marks the median"""
    styles = cases.styles
    times = {
        case: frames["total_ns"].to_numpy() / 1e6
        for case, frames in cases.results.frames.groupby("case")
        if case in cases.table.index
    }

    def paint(axes: Any, panel_cases: pd.DataFrame) -> None:
        rows = cases.rows_of(panel_cases["panel"].iloc[0])
        for case, label in panel_cases["label"].items():
            values = np.log10(times[case]) if cases.log else times[case]
            violin = axes.violinplot(
                [values], [rows[label]], widths=0.9, showextrema=False, **HORIZONTAL
            )
            violin["bodies"][0].set(facecolor=styles[label].colour, alpha=0.75, linewidth=0)
            axes.plot(np.median(values), rows[label], "|", color=light("text"), markersize=5)
        if cases.log:
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
            numbers = plain_numbers()
            axes.xaxis.set_major_formatter(FuncFormatter(lambda power, _: numbers(10**power)))
        else:
            axes.set_xlim(left=0)
        label_rows(axes, list(rows))

    return with_rows(cases, paint, x="milliseconds per frame")
