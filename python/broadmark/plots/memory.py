"""Memory: the mean time of a frame against the memory that it takes."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from broadmark.drawing import log_scale
from broadmark.errors import InputError
from broadmark.plots.cases import Cases
from broadmark.plots.panels import by_scene_and_size


def memory(cases: Cases) -> Figure:
    """mean time of a frame against peak memory, both logarithmic: the best are at the lower left"""
    looks = cases.looks
    if not (cases.table["peak_bytes"].fillna(0) > 0).any():
        raise InputError("no case with its memory is left: it is unknown of runs with --in-process")

    def paint(axes: Any, part: pd.DataFrame) -> None:
        known = part[part["peak_bytes"].fillna(0) > 0]
        for _, case in known.iterrows():
            style = looks[case["label"]].of_points()
            axes.plot(case["peak_bytes"], case["seconds_per_frame"], **style, label=case["label"])
        log_scale(axes, "x", "B")
        log_scale(axes, "y", "s")

    return by_scene_and_size(
        cases, paint, size=(2.8, 2.4), x="peak memory", y="time of a frame", legend=True
    )
