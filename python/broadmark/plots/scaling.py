"""Scaling: time over numbers of bodies with logarithmic axes, and the exponent of each algorithm.

The exponent is the slope of a least-squares line through the logarithms, its error the standard error
of the slope. Two sizes give no error.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, NullLocator

from broadmark.drawing import log_scale
from broadmark.errors import InputError
from broadmark.plots.cases import Cases
from broadmark.plots.panels import by_scene


def fit(objects: Any, seconds: Any) -> tuple[float, float, float]:
    """Fits seconds = factor · objects^exponent: factor, exponent, standard error of the exponent."""
    x, y = np.log(np.asarray(objects, float)), np.log(np.asarray(seconds, float))
    spread = ((x - x.mean()) ** 2).sum()
    exponent = ((x - x.mean()) * (y - y.mean())).sum() / spread
    residuals = y - y.mean() - exponent * (x - x.mean())
    error = math.sqrt((residuals**2).sum() / (len(x) - 2) / spread) if len(x) > 2 else math.nan
    return math.exp(y.mean() - exponent * x.mean()), exponent, error


def scaling(cases: Cases) -> Figure:
    """mean time over numbers of bodies, with logarithmic axes and fitted exponents"""
    styles = cases.styles
    if cases.table.groupby(["panel", "label"])["objects"].nunique().max() < 2:
        raise InputError("scaling requires results of at least two numbers of bodies")

    def paint(axes: Any, panel_cases: pd.DataFrame) -> None:
        has_error = False
        for label, series in panel_cases.groupby("label", sort=False):
            x, y = series["objects"].to_numpy(), series["seconds_per_frame"].to_numpy(float)
            name = label
            if len(x) > 1:
                factor, exponent, error = fit(x, y)
                ends = np.array([x.min(), x.max()])
                colour = styles[label].colour
                axes.plot(ends, factor * ends**exponent, color=colour, linewidth=0.7, alpha=0.6)
                has_error |= not math.isnan(error)
                name += f"  {exponent:.2f}" + ("" if math.isnan(error) else f" ± {error:.2f}")
            axes.plot(x, y, **styles[label].point_properties(), label=name)
        log_scale(axes, "x")
        log_scale(axes, "y", "s")
        axes.set_xticks(sorted(panel_cases["objects"].unique()))
        axes.xaxis.set_major_formatter(EngFormatter(sep=""))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.legend(
            title="exponent ± standard error" if has_error else "exponent",
            loc="upper left",
            bbox_to_anchor=(1.01, 1.02),
            ncol=1 + len(panel_cases["label"].unique()) // 18,
            fontsize=6.5,
            title_fontsize=6.5,
        )

    return by_scene(
        cases, paint, size=(7.6, 3.7), stacked=True, x="bodies", y="time per frame", legend=False
    )
