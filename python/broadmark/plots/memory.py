"""Memory: the mean time per frame against peak memory."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from broadmark.drawing import log_scale
from broadmark.errors import InputError
from broadmark.plots.cases import Cases
from broadmark.plots.panels import by_scene_and_size

#: The page size, the smallest memory shown: a small case may use less, down to 0.
PAGE_BYTES = 4096


def memory(cases: Cases) -> Figure:
    """mean time per frame against peak memory, with logarithmic axes; the lower left is best"""
    styles = cases.styles
    if not cases.table["peak_bytes"].notna().any():
        raise InputError(
            "no case with peak memory is left: runs with --in-process do not measure memory"
        )

    def paint(axes: Any, panel_cases: pd.DataFrame) -> None:
        for _, case in panel_cases[panel_cases["peak_bytes"].notna()].iterrows():
            style = styles[case["label"]].point_properties()
            axes.plot(
                max(case["peak_bytes"], PAGE_BYTES),
                case["seconds_per_frame"],
                **style,
                label=case["label"],
            )
        log_scale(axes, "x", "B")
        log_scale(axes, "y", "s")

    return by_scene_and_size(
        cases, paint, size=(2.8, 2.4), x="peak memory", y="time per frame", legend=True
    )
