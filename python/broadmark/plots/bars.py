"""Bars: the mean time per frame by scene, number of bodies and algorithm."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from broadmark.drawing import log_scale
from broadmark.palette import light
from broadmark.plots.cases import Cases
from broadmark.plots.panels import label_rows, with_rows


def bars(cases: Cases) -> Figure:
    """mean time per frame, by scene and number of bodies, with 95 % confidence intervals"""
    styles = cases.styles

    def paint(axes: Any, panel_cases: pd.DataFrame) -> None:
        rows = cases.rows_of(panel_cases["panel"].iloc[0])
        y = panel_cases["label"].map(rows)
        milliseconds = panel_cases["seconds_per_frame"] * 1e3
        colours = [styles[label].colour for label in panel_cases["label"]]
        axes.barh(y, milliseconds, height=0.75, color=colours)
        has_interval = panel_cases["ci95_low_seconds"].notna()
        if has_interval.any():
            low, high = (
                panel_cases.loc[has_interval, f"ci95_{end}_seconds"].astype(float) * 1e3
                for end in ("low", "high")
            )
            axes.hlines(
                y[has_interval], low.clip(lower=0), high, color=light("text"), linewidth=0.8
            )
        if cases.log:
            log_scale(axes, "x")
            axes.set_xlim(milliseconds.min() / 2, milliseconds.max() * 1.5)
        else:
            # Clips the wide intervals of few repetitions.
            axes.set_xlim(0, milliseconds.max() * 1.25)
        for row, value in zip(y, milliseconds):
            axes.annotate(
                f"{value:.3g}",
                (1.0, row),
                xycoords=("axes fraction", "data"),
                ha="right",
                va="center",
                fontsize=5.5,
                bbox={"facecolor": light("page"), "edgecolor": "none", "pad": 0.6},
            )
        label_rows(axes, list(rows))

    return with_rows(cases, paint, x="milliseconds")
